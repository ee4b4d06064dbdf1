/// Tests by simulation whether a grasp lifts a part out of its heap. The test runs in a copy of the heap, which itself
/// does not change. grasp/ proposes the grasps; `prove` of a request selects how many are tested.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/lift_proof.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// A grasp to be tested.
struct Trial {
  int part = 0;               ///< id of the part
  std::size_t gripper = 0;    ///< index into Request::grippers
  Pose pose;                  ///< from the gripper frame to the bin frame, at the end of the approach
  double width = 0.0;         ///< parallel grippers: opening (m) at which the pads should meet the part
  double force = 0.0;         ///< force of each finger or of the vacuum (N)
  bool inner = false;         ///< parallel grippers: the fingers expand instead of closing
  Vec3 lift = Vec3::UnitZ();  ///< unit vector, direction of the lift in the bin frame
};

/// Simulates grasps. The fingers close with their force, or the vacuum pulls the part against the ring of the cup; then
/// the gripper moves by 0.1 m along the lift and starts with its own acceleration. The other parts sleep until
/// something touches them. The simulation always uses the default solver on the CPU.
///
/// A Prover keeps the shapes of parts and grippers between the scenes of a request. It may be shared by threads, and
/// serves one caller at a time.
class Prover {
 public:
  explicit Prover(const LoadedRequest& loaded);
  ~Prover();
  /// Returns the results in the order of the trials. The result of a trial depends on the scene only, not on the other
  /// trials. @param loaded  as given to the constructor, except that gravity may differ
  std::vector<LiftProof> prove(const Scene& scene, const LoadedRequest& loaded, const std::vector<Trial>& trials);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
