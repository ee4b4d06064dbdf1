/// Selects the grasps of a scene that are tested by simulation, and attaches the results to them. Prover
/// (pour/prover.hpp) does the simulation.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/pour/prover.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// Places in `grasps` of up to `count` free ones, the best first, at even ranks from the best to the worst.
std::vector<std::size_t> spread_over_scores(const std::vector<SceneGrasp>& grasps, std::size_t count, bool all = false);

/// Fills in SceneGrasp::proof of those that the request asks for.
void prove_grasps(SceneGrasps& grasps, const Scene& scene, const LoadedRequest& loaded, Prover& prover);

/// The prover of the heap that was asked about last.
class HeapProver {
 public:
  /// @param solver  the heap's, by which it is known
  Prover& of(const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver);

 private:
  std::weak_ptr<Solver> solver_;
  std::vector<PartModelPtr> parts_;
  std::unique_ptr<Prover> prover_;
};

}  // namespace bin_scenes
