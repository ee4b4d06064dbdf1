#include "heap_handle.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <utility>

namespace bin_scenes::python {

HeapHandle::HeapHandle(std::shared_ptr<Session> session, const Request& request, const Poll& poll)
    : session_(std::move(session)) {
  session_->run(
      "Generator.heap", [&](Session& own) { heap_ = own.keep(own.generator().heap(request, own.hooks())); }, poll);
}

HeapHandle::~HeapHandle() {
  session_->drop(heap_);
}

void HeapHandle::run(const char* caller, const std::function<void(Session&, Heap&)>& job, const Poll& poll) {
  session_->run(
      caller,
      [&](Session& own) {
        const CancelScope scope(&own.cancelled());
        job(own, *heap_);
      },
      poll);
}

bool HeapHandle::settle(const Poll& poll) {
  bool at_rest = false;
  run(
      "Heap.settle", [&](Session& own, Heap& heap) { at_rest = heap.settle(own.hooks()); }, poll);
  return at_rest;
}

void HeapHandle::remove(const std::vector<int>& ids, const Poll& poll) {
  run(
      "Heap.remove", [&](Session&, Heap& heap) { heap.remove(ids); }, poll);
}

void HeapHandle::lift(const std::vector<int>& ids, const Vec3& direction, double distance, const Poll& poll) {
  run(
      "Heap.lift", [&](Session& own, Heap& heap) { heap.lift(ids, direction, distance, own.hooks()); }, poll);
}

std::vector<int> HeapHandle::add(const std::vector<PartLine>& lines, const Poll& poll) {
  std::vector<int> ids;
  run(
      "Heap.add",
      [&](Session& own, Heap& heap) { ids = heap.add(own.generator().new_parts(heap, lines, own.hooks())); }, poll);
  return ids;
}

void HeapHandle::set_gravity(const Vec3& gravity, const Poll& poll) {
  run(
      "Heap.set_gravity", [&](Session&, Heap& heap) { heap.set_gravity(gravity); }, poll);
}

std::shared_ptr<SceneData> HeapHandle::scene(const Wanted& wanted, const Poll& poll) {
  std::shared_ptr<SceneData> scene;
  const auto make = [&](Session& own, Heap& heap) {
    Generator::Options options = options_of(wanted, heap.loaded().request, "Heap.scene");
    options.hooks = own.hooks();
    scene = std::make_shared<SceneData>(own.generator().result(heap, options),
                                        std::make_shared<LoadedRequest>(heap.loaded()));
  };
  run("Heap.scene", make, poll);
  return scene;
}

}  // namespace bin_scenes::python
