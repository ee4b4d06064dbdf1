/// The sphere solver of J. Edhammer, "Rigid Body Physics for Synthetic Data Generation" (LiTH-ISY-EX--16/4958--SE,
/// 2016), chapter 5: parts are voxel spheres, a sorted grid finds their contacts, and impulses with mass splitting and
/// velocity bias resolve them, all in compute passes. It is selected by the preset `thesis` and kept for comparison
/// with the tables of the thesis; the default solver is a different method.
///
/// Where the thesis contradicts mechanics, the code follows mechanics (shaders/thesis/contact_impulse.h lists these
/// places). Beyond the thesis, the code has batches of worlds, hash tables per body for the contact counts,
/// results that do not depend on the order of arrival, buffers that grow, and bins whose walls and floor are lattices
/// of static spheres that are computed on demand.
///
/// The method has limits: fast or thin parts pass through each other (more sub_steps help), resting poses are biased by
/// the voxel grid, and the surface of a part is as rough as its spheres.
#pragma once

#include "bin_scenes/solver/solver.hpp"

#include <memory>

namespace bin_scenes {

namespace thesis {
struct World;
}

/// The solver of the thesis, as the head of this file describes it.
class ThesisSolver : public Solver {
 public:
  /// Requires a GL device (gl/device.hpp) on this thread; throws an environment Error without one.
  explicit ThesisSolver(const ThesisSettings& settings = {});
  ~ThesisSolver() override;

  WorldId add_world(const WorldDef& def) override;
  /// Adds a world of shapes that are made without part models, for tests.
  WorldId add_world(thesis::World world);
  void remove_world(WorldId world) override;

  void insert(WorldId world, std::size_t body, const BodyState& state) override;
  void remove(WorldId world, std::size_t body) override;
  bool set_phase(WorldId world, const Phase& phase) override;  ///< returns false: all phases use the same shapes

  double advance(const std::vector<WorldId>& worlds, double seconds) override;

  std::vector<BodyState> states(WorldId world) const override;
  std::vector<bool> asleep(WorldId world) const override;  ///< always false: the method has no sleep

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
