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
  /// @param work  runs in the worker processes; if it throws an Error, the answer is {"error": what, "kind": code}
  /// @param warn  is called with a message for each worker that died
  Workers(std::size_t count, std::function<nlohmann::json(std::size_t heap)> work,
          std::function<void(const std::string&)> warn);
  ~Workers();  ///< kills the workers
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Distributes the heaps that `next` returns to the workers, and calls `done` with each answer. Ends early if `stop`
  /// is set. Throws an environment Error if workers keep dying on one heap. The parent must have no threads.
  void run(const std::function<std::optional<std::size_t>()>& next,
           const std::function<void(const nlohmann::json&)>& done, const std::atomic<bool>& stop,
           const std::function<void()>& idle);

 private:
  struct Worker {
    pid_t pid = -1;
    int socket = -1;
    std::optional<std::size_t> heap;
    std::size_t deaths = 0;  ///< how often workers died on this heap
    std::string line;        ///< part of an answer that has been received so far
  };

  void start(Worker& worker);
  void give(Worker& worker, std::size_t heap);
  void hear(Worker& worker, const std::function<void(const nlohmann::json&)>& done);
  static int end(Worker& worker);  ///< kills it; returns its status of waitpid(), 0 if it did not run

  std::function<nlohmann::json(std::size_t)> work_;
  std::function<void(const std::string&)> warn_;
  std::vector<Worker> workers_;
};

}  // namespace bin_scenes
