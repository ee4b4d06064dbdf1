#include "generate/proving.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

const PartPick& pick_of(const SceneGrasps& grasps, int id) {
  return *std::find_if(grasps.parts.begin(), grasps.parts.end(), [&](const PartPick& pick) { return pick.id == id; });
}

}  // namespace

std::vector<std::size_t> spread_over_scores(const std::vector<SceneGrasp>& grasps, std::size_t count, bool all) {
  using Obstacle = SceneGrasp::Obstacle;
  std::vector<std::size_t> free;
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const Obstacle obstacle = grasps[i].obstacle;
    if (grasps[i].free() || (all && (obstacle == Obstacle::blocked || obstacle == Obstacle::slips))) free.push_back(i);
  }
  std::stable_sort(free.begin(), free.end(),
                   [&](std::size_t a, std::size_t b) { return grasps[a].score > grasps[b].score; });
  BIN_SCENES_ASSERT(std::is_sorted(free.begin(), free.end(),
                                   [&](std::size_t a, std::size_t b) { return grasps[a].score > grasps[b].score; }));
  if (free.size() <= count) return free;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(free[count == 1 ? 0 : k * (free.size() - 1) / (count - 1)]);
  BIN_SCENES_ASSERT(chosen.size() == count);
  return chosen;
}

void prove_grasps(SceneGrasps& grasps, const Scene& scene, const LoadedRequest& loaded, Prover& prover) {
  const std::vector<std::size_t> chosen =
      spread_over_scores(grasps.grasps, loaded.request.prove, loaded.request.prove_all);
  std::vector<Trial> trials;
  for (const std::size_t i : chosen) {
    const SceneGrasp& grasp = grasps.grasps[i];
    const Vec3& lift = pick_of(grasps, grasp.part).lift;
    Trial trial;
    trial.part = grasp.part;
    trial.gripper = grasp.gripper;
    trial.pose = grasp.pose;
    trial.width = grasp.width;
    trial.force = grasp.force;
    trial.inner = grasp.inner;
    if (lift.norm() > 0.0) trial.lift = lift.normalized();
    trials.push_back(trial);
  }
  const std::vector<LiftProof> proofs = prover.prove(scene, loaded, trials);
  BIN_SCENES_ASSERT(proofs.size() == trials.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) grasps.grasps[chosen[k]].proof = proofs[k];
}

Prover& HeapProver::of(const LoadedRequest& loaded, const std::shared_ptr<Solver>& solver) {
  if (!prover_ || solver_.lock() != solver || parts_ != loaded.parts) {
    prover_ = std::make_unique<Prover>(loaded);
    solver_ = solver;
    parts_ = loaded.parts;
  }
  return *prover_;
}

}  // namespace bin_scenes
