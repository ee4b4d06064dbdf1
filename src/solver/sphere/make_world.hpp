/// Converts between the common interface of solvers and a world of the default solver. The passes on the CPU and those
/// on the GPU share these functions, so that both build the same world and give the same answers.
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "solver/sphere/world.hpp"

#include <functional>

namespace bin_scenes::sphere {

/// A solver in which a mechanism is switched off or changed, for comparisons in benchmarks; requests cannot set it.
struct Variant {
  Settings settings;                   ///< initial settings; the values that a request sets replace some of them
  std::function<void(Shape&)> change;  ///< is applied to the shape of each part after it is made
};

/// Makes a world in which all bodies of `def` are absent. If the bin is a mesh, it is one more, fixed body after these.
/// `shape_of` returns the collision shape of a part; the shape must outlive the world.
World make_world(const WorldDef& def, const SphereSettings& settings,
                 const std::function<const Shape&(const PartModelPtr&)>& shape_of, const Settings& base = {});

/// Returns the flags for the report: whether time steps are divided because parts are small, and flags of the shapes.
std::vector<Flag> flags_of(const World& world);

/// Sets pose and velocity of a body to those of the state, and wakes the body.
void place(World& world, std::size_t body, const BodyState& state);

void set_jaws(World& world, const Jaws& jaws);
void set_force(World& world, std::size_t body, const Vec3& force, const Vec3& point);

/// Copies the settings of a phase into the world. Returns true if they differ from before, or if contacts must forget
/// their forces or bodies must fall asleep: the caller must then change the bodies and contacts accordingly.
bool take_phase(World& world, const Phase& phase);

/// Does the same as take_phase(), and changes bodies and contacts: after a change all bodies wake, or are put to sleep.
void set_phase(World& world, const Phase& phase);

/// Returns the pose of the model frame and the velocity of a body; a body that was never placed has a NaN position.
BodyState state_of(const World& world, std::size_t body);

/// Returns the contact forces of the last step. `bodies`: number of bodies of the caller; a later body is the bin.
std::vector<ContactForce> forces_of(const World& world, std::size_t bodies);

/// Returns the deepest contact of all steps since the last call, and resets it. `bodies`: as for forces_of().
WorstContact take_worst_contact(World& world, std::size_t bodies);

}  // namespace bin_scenes::sphere
