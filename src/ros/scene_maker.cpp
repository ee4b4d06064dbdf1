#include "scene_maker.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <utility>

namespace bin_scenes {

MadeScene SceneMaker::pour(const Request& request, const RunHooks& hooks) {
  Profile loading;
  std::shared_ptr<Heap> heap;
  {
    const StageTimer timer(loading, "load");
    heap = std::make_shared<Heap>(generator_.heap(request, hooks));
  }
  MadeScene made = settled(heap, hooks);
  made.scene.report.profile.merge(loading);
  made.asked = request;
  return made;
}

void SceneMaker::keep(const MadeScene& made) {
  heap_ = made.heap;
  has_scene_ = true;
  loaded_ = made.loaded;
  asked_ = made.asked;
  last_.seed = made.scene.seed;
  last_.index = made.scene.index;
  last_.sensors = made.scene.sensors;
}

Heap& SceneMaker::heap(const char* purpose) const {
  if (!heap_) throw input_error("there is no heap in the bin", purpose, "make a scene first: generate, generate_scene");
  return *heap_;
}

MadeScene SceneMaker::pick(const std::vector<int>& ids, const Lift& lift, const RunHooks& hooks) {
  Heap& heap = this->heap("pick_part");
  if (lift.distance != 0.0) heap.lift(ids, lift.direction, lift.distance, hooks);
  heap.remove(ids);
  return settled(heap_, hooks);
}

MadeScene SceneMaker::add(const std::vector<PartLine>& lines, const RunHooks& hooks) {
  if (!has_scene_) heap("add_parts");  // says what is missing
  if (!heap_) {
    Request anew = loaded_.request;
    anew.parts = lines;
    anew.pour.scene.clear();
    if (anew.pour.pattern == Pour::Pattern::given) anew.pour.pattern = Pour::Pattern::rain;
    MadeScene made = pour(anew, hooks);
    made.asked = asked_;
    return made;
  }
  heap_->add(generator_.new_parts(*heap_, lines, hooks));
  return settled(heap_, hooks);
}

MadeScene SceneMaker::settle(const RunHooks& hooks) {
  heap("pick_part");
  return settled(heap_, hooks);
}

MadeScene SceneMaker::heap_as_it_lies(const char* purpose) const {
  MadeScene made;
  made.loaded = heap(purpose).loaded();
  if (made.loaded.request.grippers.empty())
    throw input_error("the request of the scene has no grippers", purpose,
                      "add for instance `grippers: [robotiq_2f_85]`");
  made.scene = heap_->scene();
  made.scene.sensors = last_.sensors;
  made.images.resize(made.scene.sensors.size());
  return made;
}

SceneGrasps SceneMaker::grasps(const MadeScene& made, const std::vector<RangeImage>& images,
                               const RunHooks& hooks) const {
  const CancelScope scope(hooks.cancel);
  return grasper_.find(made.scene, made.loaded, images);
}

void SceneMaker::prove(SceneGrasps& grasps, MadeScene& made, std::size_t count, bool all, const RunHooks& hooks) {
  const CancelScope scope(hooks.cancel);
  made.loaded.request.prove = count;
  made.loaded.request.prove_all = all;
  prove_grasps(grasps, made.scene, made.loaded, prover_.of(made.loaded, heap_->solver()));
}

MadeScene SceneMaker::settled(const std::shared_ptr<Heap>& heap, const RunHooks& hooks) {
  heap->settle(hooks);
  Generator::Options options;
  options.render = false;  // which images are wanted is not known here
  options.hooks = hooks;
  Generator::Result result = generator_.result(*heap, options);
  MadeScene made;
  made.scene = std::move(result.scene);
  made.images.resize(made.scene.sensors.size());
  made.loaded = heap->loaded();
  made.asked = asked_;
  made.heap = heap;
  return made;
}

MadeScene SceneMaker::emptied() const {
  MadeScene empty;
  empty.scene = last_;
  empty.scene.report.at_rest = empty.scene.report.accepted = true;
  empty.loaded = loaded_;
  empty.asked = asked_;
  empty.loaded.request.parts.clear();
  empty.loaded.parts.clear();
  empty.images.resize(empty.scene.sensors.size());
  return empty;
}

}  // namespace bin_scenes
