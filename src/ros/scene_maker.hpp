/// Makes the scenes of one bin, and keeps the heap of the present scene so that parts can be removed and added. It
/// stands between the services of the node and the library (pour/heap.hpp). It publishes nothing.
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "generate/proving.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// A scene, with all that is needed to show it.
struct MadeScene {
  Scene scene;
  LoadedRequest loaded;  ///< the request with the parts that were added; without the models of parts once it is stored
  std::vector<RangeImage> images;  ///< one a sensor; RangeImage() until somebody subscribes (Publication)
  std::vector<bool> with_gray;     ///< by sensor: whether its image has a grey image
  Request asked;               ///< the request that was poured first; next_scene follows it, whatever was added since
  std::shared_ptr<Heap> heap;  ///< the heap of which it is a snapshot; null: the bin was emptied
};

/// How parts are moved before they are removed.
struct Lift {
  Vec3 direction = Vec3::UnitZ();  ///< bin frame, any length
  double distance = 0.0;           ///< m; 0: the parts are removed without being moved
};

/// One thread at a time. All calls throw Error; those that make a scene leave the heap that is kept as it was, but for
/// pick() and add(), which change it first and settle it then: settle() completes what was cancelled.
class SceneMaker {
 public:
  /// A scene of its own, with a heap of its own.
  MadeScene pour(const Request& request, const RunHooks& hooks);

  /// From now on pick() and add() change the heap of this scene.
  void keep(const MadeScene& scene);

  MadeScene pick(const std::vector<int>& ids, const Lift& lift, const RunHooks& hooks);
  /// Onto the heap, or into the bin if it was emptied.
  MadeScene add(const std::vector<PartLine>& lines, const RunHooks& hooks);
  MadeScene settle(const RunHooks& hooks);
  /// Returns the present heap as a scene without judgement and images, for grasps().
  MadeScene heap_as_it_lies(const char* purpose) const;
  /// What cameras see of them only if `images` are those of the scene.
  SceneGrasps grasps(const MadeScene& made, const std::vector<RangeImage>& images, const RunHooks& hooks) const;
  /// Simulates the lift of up to `count` of these grasps, which are those of heap_as_it_lies(); with `all`, also of
  /// blocked parts and of those that would slip.
  void prove(SceneGrasps& grasps, MadeScene& made, std::size_t count, bool all, const RunHooks& hooks);
  /// The empty bin of the scene that is kept.
  MadeScene emptied() const;

  bool has_scene() const { return has_scene_; }
  /// What was poured, with the index of the scene; the heap has changed since, perhaps.
  const Request& asked() const { return asked_; }

 private:
  MadeScene settled(const std::shared_ptr<Heap>& heap, const RunHooks& hooks);
  Heap& heap(const char* purpose) const;

  Generator generator_;
  Grasper grasper_;
  HeapProver prover_;
  std::shared_ptr<Heap> heap_;
  bool has_scene_ = false;
  LoadedRequest loaded_;  ///< the request of the stored scene
  Request asked_;         ///< likewise: MadeScene::asked
  Scene last_;            ///< without parts: seed, index, sensors
};

}  // namespace bin_scenes
