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

/// Parts of scenes that may wait to be finished. On one core nobody does it beside the thread that pours: it then does
/// it itself.
constexpr std::size_t most_parts_waiting = 100'000;

/// Returns how many poured scenes may wait, if the images of `at_once` scenes fit into memory: enough for all cores,
/// and no more.
std::size_t scenes_waiting(std::size_t at_once);

class Finishing {
 public:
  using Result = Generator::Result;
  /// `finish` is called in any thread and for up to `at_once` scenes at the same time, whose images must fit into
  /// memory together. `hand_on` is called in the thread that uses this class.
  Finishing(std::function<void(Result&)> finish, std::function<void(Result&&)> hand_on, std::size_t at_once)
      : finish_(std::move(finish)),
        hand_on_(std::move(hand_on)),
        free_(at_once),
        most_waiting_(scenes_waiting(at_once)) {}
  ~Finishing();  ///< waits for scenes that are being finished; they are lost
  Finishing(const Finishing&) = delete;
  Finishing& operator=(const Finishing&) = delete;

  /// Adds a poured scene. Places count from 0, and each is added once. If pouring is faster than finishing, or than the
  /// caller, it waits and hands scenes on, because memory holds the images of a few scenes but not of all.
  void add(std::size_t place, Scene&& scene);
  void hand_on_finished();  ///< hands on the scenes that are finished and next in order; never waits
  void wait();              ///< for all, and hands on each as soon as it is finished; throws what `finish` threw

 private:
  struct Entry {
    Result result;
    std::exception_ptr failed;
    std::atomic<bool> begun{false}, finished{false};
  };
  void finish(Entry& entry);  ///< unless another thread does it
  void wait_for_first();      ///< whatever its turn; finishes it in this thread if no other has begun

  std::function<void(Result&)> finish_;
  std::function<void(Result&&)> hand_on_;
  std::map<std::size_t, std::shared_ptr<Entry>> entries_;  ///< by place in the order of scenes
  std::size_t next_ = 0;                                   ///< place whose turn it is
  std::atomic<std::size_t> waiting_{0};                    ///< parts of scenes not finished yet
  std::mutex mutex_;
  std::condition_variable freed_;
  std::size_t free_;                ///< scenes that may be begun now
  const std::size_t most_waiting_;  ///< scenes that wait to be finished or handed on
  tbb::task_group tasks_;
};

}  // namespace bin_scenes
