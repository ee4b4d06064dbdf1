/// The handle through which Python uses a heap. The heap itself belongs to the thread of the session (session.hpp),
/// like its solver.
#pragma once

#include "scene_data.hpp"
#include "session.hpp"

#include <memory>
#include <vector>

namespace bin_scenes::python {

/// Each call runs the function of Heap with this name, waits for its end, and is refused like Session::run().
class HeapHandle {
 public:
  HeapHandle(std::shared_ptr<Session> session, const Request& request, const Poll& poll);
  ~HeapHandle();
  HeapHandle(const HeapHandle&) = delete;
  HeapHandle& operator=(const HeapHandle&) = delete;

  bool settle(const Poll& poll);
  void remove(const std::vector<int>& ids, const Poll& poll);
  void lift(const std::vector<int>& ids, const Vec3& direction, double distance, const Poll& poll);
  std::vector<int> add(const std::vector<PartLine>& lines, const Poll& poll);
  void set_gravity(const Vec3& gravity, const Poll& poll);
  std::shared_ptr<SceneData> scene(const Wanted& wanted, const Poll& poll);

 private:
  /// Runs `job` with the heap in the thread of the session.
  void run(const char* caller, const std::function<void(Session&, Heap&)>& job, const Poll& poll);

  std::shared_ptr<Session> session_;
  Heap* heap_ = nullptr;
};

}  // namespace bin_scenes::python
