/// Makes scenes ahead of demand in a thread of its own, so that the node answers a request for the next scene without
/// waiting. When a scene of another request is shown, the scenes that were made ahead are discarded. The number of
/// waiting scenes is limited.
#pragma once

#include "publication.hpp"
#include "scene_maker.hpp"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace bin_scenes {

class Ahead {
 public:
  /// `depth`: largest number of scenes that wait. `publication` makes those images of the scenes that have subscribers.
  Ahead(int depth, Publication& publication);
  ~Ahead();
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;

  /// States that the present scene is `index` of this request. The scenes after it are made, and scenes for another
  /// request are discarded.
  void follow(const Request& request, std::size_t index);
  /// Returns the next scene, and waits for it if it is not finished. Throws the error that occurred while it was made,
  /// or Error(cancelled).
  MadeScene take(const RunHooks& hooks);
  std::size_t ready() const;  ///< number of finished scenes

 private:
  void run();

  const std::size_t depth_;
  Publication& publication_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<MadeScene> ready_;
  std::exception_ptr failed_;  ///< error of the scene after those that are ready
  bool following_ = false, stop_ = false;
  Request request_;
  std::size_t next_ = 0;               ///< index of the scene that is made next
  std::atomic<bool> unwanted_{false};  ///< cancels the scene that is being made
  std::thread thread_;
};

}  // namespace bin_scenes
