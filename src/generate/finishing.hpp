/// Poured scenes are judged, rendered and encoded by other threads while the next ones are poured. The pouring thread
/// hands them to the caller in order.
#pragma once

#include "bin_scenes/generate/generator.hpp"

#include <tbb/task_group.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace bin_scenes {

/// Largest number of parts in scenes that wait to be finished. Above it, the pouring thread finishes scenes itself. On
/// one core, no other thread would do it.
constexpr std::size_t most_parts_waiting = 100'000;

/// Returns how many poured scenes may wait, if the images of `at_once` scenes fit into memory: enough for all cores,
/// and no more.
std::size_t scenes_waiting(std::size_t at_once);

class Finishing {
 public:
  using Result = Generator::Result;
  /// `finish` is called in any thread, for up to `at_once` scenes at the same time; the images of so many scenes must
  /// fit into memory. `hand_on` is called in the thread that uses this class, in the order of scenes.
  Finishing(std::function<void(Result&)> finish, std::function<void(Result&&)> hand_on, std::size_t at_once)
      : finish_(std::move(finish)),
        hand_on_(std::move(hand_on)),
        free_(at_once),
        most_waiting_(scenes_waiting(at_once)) {}
  ~Finishing();  ///< waits for scenes that are being finished; they are lost
  Finishing(const Finishing&) = delete;
  Finishing& operator=(const Finishing&) = delete;

  /// Adds a poured scene. Places count from 0, and each place is added once. If too many scenes wait, the call finishes
  /// scenes and hands them on before it returns, because the images of all scenes would not fit into memory.
  void add(std::size_t place, Scene&& scene);
  void hand_on_finished();  ///< hands on finished scenes that are next in order; never waits
  void wait();              ///< hands on all scenes, each when it is finished; throws what `finish` threw

 private:
  struct Entry {
    Result result;
    std::exception_ptr failed;
    std::atomic<bool> begun{false}, finished{false};
  };
  void finish(Entry& entry);  ///< does nothing if another thread finishes the entry
  void wait_for_first();      ///< waits for the first scene, or finishes it in this thread

  std::function<void(Result&)> finish_;
  std::function<void(Result&&)> hand_on_;
  std::map<std::size_t, std::shared_ptr<Entry>> entries_;  ///< key: place of the scene in the order
  std::size_t next_ = 0;                                   ///< place of the scene that is handed on next
  std::atomic<std::size_t> waiting_{0};                    ///< number of parts in scenes that are not finished
  std::mutex mutex_;
  std::condition_variable freed_;
  std::size_t free_;                ///< number of further scenes that may be begun now
  const std::size_t most_waiting_;  ///< largest number of scenes that wait to be finished or handed on
  tbb::task_group tasks_;
};

}  // namespace bin_scenes
