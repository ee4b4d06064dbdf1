/// Makes the scenes of one bin, and keeps the heap of the present scene so that parts can be removed and added. The
/// services of the node use it; it uses the library (pour/heap.hpp), and publishes nothing.
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "generate/proving.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// A scene with all data that is needed to publish it.
struct MadeScene {
  Scene scene;
  LoadedRequest loaded;            ///< the request with the parts that were added; has no part models once it is stored
  std::vector<RangeImage> images;  ///< one per sensor; each is empty until there is a subscriber (Publication)
  std::vector<bool> with_gray;     ///< by sensor: whether its image has a grey image
  Request asked;                   ///< the request of the first pour, without added parts; next_scene uses it
  std::shared_ptr<Heap> heap;      ///< heap of which the scene is a snapshot; null: the bin was emptied
};

/// How parts are moved before they are removed from the heap.
struct Lift {
  Vec3 direction = Vec3::UnitZ();  ///< in the bin frame; need not have unit length
  double distance = 0.0;           ///< distance (m); 0: the parts are removed without being moved
};

/// Only one thread at a time may use it. All calls throw Error. If a call fails, the stored heap does not change,
/// except for pick() and add(): they change it first and then settle it, and settle() completes what was cancelled.
class SceneMaker {
 public:
  /// Pours a new heap and returns its scene. The stored heap is not affected.
  MadeScene pour(const Request& request, const RunHooks& hooks);

  /// Stores the heap of a scene: from now on, pick() and add() change it.
  void keep(const MadeScene& scene);

  MadeScene pick(const std::vector<int>& ids, const Lift& lift, const RunHooks& hooks);
  /// Pours parts onto the stored heap, or into the bin if it was emptied.
  MadeScene add(const std::vector<PartLine>& lines, const RunHooks& hooks);
  MadeScene settle(const RunHooks& hooks);
  /// Returns the present heap as a scene without judgement and images, for grasps().
  MadeScene heap_as_it_lies(const char* purpose) const;
  /// Finds the grasps of a scene. Cameras are taken into account only if `images` contains the images of the scene.
  SceneGrasps grasps(const MadeScene& made, const std::vector<RangeImage>& images, const RunHooks& hooks) const;
  /// Simulates the lift of up to `count` of the grasps of heap_as_it_lies(). If `all` is true, grasps of parts that are
  /// blocked, and grasps that would slip, are included.
  void prove(SceneGrasps& grasps, MadeScene& made, std::size_t count, bool all, const RunHooks& hooks);
  /// Returns a scene with the empty bin of the stored scene.
  MadeScene emptied() const;

  bool has_scene() const { return has_scene_; }
  /// Returns the request of the first pour, with the index of the scene. The heap may have changed since then.
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
  Request asked_;         ///< MadeScene::asked of the stored scene
  Scene last_;            ///< seed, index and sensors of the stored scene, without parts
};

}  // namespace bin_scenes
