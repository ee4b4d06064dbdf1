/// Converts between the common interface of solvers and a world of the default solver. The passes on the CPU and those
/// on the GPU share these functions, so that both build the same world and give the same answers.
#pragma once

#include "bin_scenes/solver/solver.hpp"
#include "solver/sphere/world.hpp"

#include <functional>

namespace bin_scenes::sphere {

/// The solver with a mechanism taken away or changed, which no request can ask for: what benchmarks compare with.
struct Variant {
  Settings settings;                   ///< except those that the request sets
  std::function<void(Shape&)> change;  ///< is done to each part's shape
};

/// All bodies absent. A bin given as a mesh is one more, fixed body behind those of the definition.
/// `shape_of`: the collision shape of a part; it must outlive the world.
World make_world(const WorldDef& def, const SphereSettings& settings,
                 const std::function<const Shape&(const PartModelPtr&)>& shape_of, const Settings& base = {});

/// What the user should know of a world: a time step that is too long for its parts is cut; the flags of its shapes.
std::vector<Flag> flags_of(const World& world);

/// Sets pose and velocity of a body to those of the state, and wakes the body.
void place(World& world, std::size_t body, const BodyState& state);

void set_jaws(World& world, const Jaws& jaws);
void set_force(World& world, std::size_t body, const Vec3& force, const Vec3& point);

/// Takes over the samples, contact settings and sleep of a phase. Returns true if these differ from before, or if the
/// contacts are to forget their forces, or bodies are to sleep: the caller must then change bodies and contacts.
bool take_phase(World& world, const Phase& phase);

/// The same; a change wakes all bodies, or puts them to sleep.
void set_phase(World& world, const Phase& phase);

/// Pose of the model frame and velocity; NaN position for a body that was never placed.
BodyState state_of(const World& world, std::size_t body);

/// Of the last step. `bodies`: of the caller; what stands behind them is the bin.
std::vector<ContactForce> forces_of(const World& world, std::size_t bodies);

/// Of all steps since it was last taken. `bodies`: as above.
WorstContact take_worst_contact(World& world, std::size_t bodies);

}  // namespace bin_scenes::sphere
