/// Selects the grasps of a scene that are tested by simulation, and attaches the results to them. Prover
/// (pour/prover.hpp) does the simulation.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/pour/prover.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <memory>
#include <vector>

namespace bin_scenes {

/// Returns the indices of up to `count` free grasps at even ranks of score; with `all`, also blocked or slipping ones.
std::vector<std::size_t> spread_over_scores(const std::vector<SceneGrasp>& grasps, std::size_t count, bool all = false);

/// Simulates the grasps that the request selects, and sets their SceneGrasp::proof.
void prove_grasps(SceneGrasps& grasps, const Scene& scene, const LoadedRequest& loaded, Prover& prover);

/// Keeps the prover of the heap for which it was last called.
class HeapProver {
 public:
  /// @param solver  solver of the heap; the prover is made again if it is another solver
  Prover& of(const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver);

 private:
  std::weak_ptr<Solver> solver_;
  std::vector<PartModelPtr> parts_;
  std::unique_ptr<Prover> prover_;
};

}  // namespace bin_scenes
