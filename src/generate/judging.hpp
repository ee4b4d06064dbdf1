/// Scenes on their way from the solver to the caller: judged by other threads while the next ones are poured, handed
/// on in order by the thread that pours, which owns the GL context that draws them.
#pragma once

#include "bin_scenes/scene/scene.hpp"

#include <tbb/task_group.h>

#include <atomic>
#include <exception>
#include <functional>
#include <map>
#include <memory>

namespace bin_scenes {

/// Parts of scenes that may wait for a judge. On one core nobody judges beside the thread that pours: it then does it
/// itself.
constexpr std::size_t most_parts_waiting = 100'000;

class Judging {
 public:
  /// `judge` runs in any thread and for several scenes at once; `hand_on` in the thread that calls this class.
  Judging(std::function<void(Scene&)> judge, std::function<void(Scene&&)> hand_on)
      : judge_(std::move(judge)), hand_on_(std::move(hand_on)) {}
  ~Judging();  ///< waits for scenes that are being judged; they are lost
  Judging(const Judging&) = delete;
  Judging& operator=(const Judging&) = delete;

  void add(std::size_t place, Scene&& scene);  ///< places count from 0, each comes once
  void hand_on_judged();                       ///< those that are ready and whose turn it is; never waits
  void finish();                               ///< all, after waiting for them; throws what a judge threw

 private:
  struct Entry {
    Scene scene;
    std::exception_ptr failed;
    std::atomic<bool> judged{false};
  };

  std::function<void(Scene&)> judge_;
  std::function<void(Scene&&)> hand_on_;
  std::map<std::size_t, std::unique_ptr<Entry>> entries_;  ///< by place
  std::size_t next_ = 0;                                   ///< place whose turn it is
  std::atomic<std::size_t> waiting_{0};                    ///< parts of scenes not judged yet
  tbb::task_group tasks_;
};

}  // namespace bin_scenes
