/// Processes that make heaps for one parent. A worker that dies is replaced, and its heap is made again; workers die
/// with their parent.
///
///     parent ── number of a heap ──► worker
///            ◄── one line of JSON ──
#pragma once

#include <nlohmann/json.hpp>

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

class Workers {
 public:
  /// `work` runs in the workers. Its Error becomes {"error": what, "kind": code}.
  /// `warn` hears of each worker that died.
  Workers(std::size_t count, std::function<nlohmann::json(std::size_t heap)> work,
          std::function<void(const std::string&)> warn);
  ~Workers();  ///< kills them
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Has every heap that `next` gives made by some worker, and hands each answer to `done`. Returns early once `stop`
  /// is set. Throws an environment Error if workers keep dying on one heap. The parent must have no threads.
  void run(const std::function<std::optional<std::size_t>()>& next,
           const std::function<void(const nlohmann::json&)>& done, const std::atomic<bool>& stop,
           const std::function<void()>& idle);

 private:
  struct Worker {
    pid_t pid = -1;
    int socket = -1;
    std::optional<std::size_t> heap;
    std::size_t deaths = 0;  ///< on that heap
    std::string line;        ///< the part of an answer that has arrived
  };

  void start(Worker& worker);
  void give(Worker& worker, std::size_t heap);
  void hear(Worker& worker, const std::function<void(const nlohmann::json&)>& done);
  static int end(Worker& worker);  ///< status of waitpid(); 0 if there was none

  std::function<nlohmann::json(std::size_t)> work_;
  std::function<void(const std::string&)> warn_;
  std::vector<Worker> workers_;
};

}  // namespace bin_scenes
