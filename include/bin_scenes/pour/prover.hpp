/// Whether a grasp lifts a part out of its heap: tried in a copy of the heap.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/lift_proof.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// A grasp to be tried.
struct Trial {
  int part = 0;               ///< id
  std::size_t gripper = 0;    ///< index into Request::grippers
  Pose pose;                  ///< of the gripper in the bin frame, at the end of its approach
  double width = 0.0;         ///< m, parallel: at which the pads should meet the part
  double force = 0.0;         ///< N: of each finger, or of the vacuum
  bool inner = false;         ///< parallel: the fingers expand
  Vec3 lift = Vec3::UnitZ();  ///< unit: direction of the lift in the bin frame
};

/// Fingers close with their force, or the vacuum pulls the part to the cup's ring; then the gripper moves by 0.1 m
/// along the lift, at first with its acceleration. Other parts sleep until something touches them. Always by the
/// default solver, on the CPU.
///
/// Keeps the shapes of parts and grippers between the scenes of a request. Thread-safe: serves one caller at a time.
class Prover {
 public:
  explicit Prover(const LoadedRequest& loaded);
  ~Prover();
  /// In the order of the trials; `loaded`: as at first, but for gravity. A trial's result depends on the scene alone,
  /// not on other trials.
  std::vector<LiftProof> prove(const Scene& scene, const LoadedRequest& loaded, const std::vector<Trial>& trials);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
