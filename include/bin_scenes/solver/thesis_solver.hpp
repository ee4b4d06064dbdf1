/// The sphere solver of J. Edhammer, "Rigid Body Physics for Synthetic Data Generation" (LiTH-ISY-EX--16/4958--SE,
/// 2016), chapter 5: parts as voxel spheres, a sorted grid, impulses with mass splitting and velocity bias, all in
/// compute passes. Preset `thesis`; kept for its tables and for comparison, the default solver is another.
///
/// Where the text contradicts mechanics, the code follows mechanics (shaders/thesis/contact_impulse.h lists these
/// places). Beyond the text: a batch of worlds, hash tables per body for the contact counts, results that do not depend
/// on order of arrival, buffers that grow, and a bin whose box and floor are lattices of static spheres computed on
/// demand.
///
/// Limits that are the method's own: fast or thin parts tunnel (raise sub_steps), results lean towards the voxel
/// grid, the surface of a part is as rough as its spheres.
#pragma once

#include "bin_scenes/solver/solver.hpp"

#include <memory>

namespace bin_scenes {

namespace thesis {
struct World;
}

class ThesisSolver : public Solver {
 public:
  /// Needs a GL device (gl/device.hpp) on this thread; throws an environment Error without one.
  explicit ThesisSolver(const ThesisSettings& settings = {});
  ~ThesisSolver() override;

  WorldId add_world(const WorldDef& def) override;
  /// A world of shapes made by hand, without part models (tests).
  WorldId add_world(thesis::World world);
  void remove_world(WorldId world) override;

  void insert(WorldId world, std::size_t body, const BodyState& state) override;
  void remove(WorldId world, std::size_t body) override;
  bool set_phase(WorldId world, const Phase& phase) override;  ///< one set of shapes serves both

  double advance(const std::vector<WorldId>& worlds, double seconds) override;

  std::vector<BodyState> states(WorldId world) const override;
  std::vector<bool> asleep(WorldId world) const override;  ///< the method has no sleep: always false

  double step_size() const override;
  std::uint64_t steps(WorldId world) const override;
  const Profile& profile() const override;
  std::vector<Flag> flags(WorldId world) const override;
  std::string name() const override { return "sphere/thesis"; }
  std::string device() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bin_scenes
