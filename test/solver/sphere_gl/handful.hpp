/// A handful of parts that fall into a small box on the GPU form, for tests that compare bits.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "solver/fixture.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

namespace bin_scenes::sphere_gl {

inline SphereSettings coarse() {
  SphereSettings settings;
  settings.coarse_samples = 60;
  settings.fine_samples = 150;
  settings.field_cell = 0.03;
  return settings;
}

/// Angle irons that fall into a small box: 5, 8, 11 of them by variant.
struct Handful {
  WorldDef def;
  std::vector<BodyState> starts;

  explicit Handful(int variant) {
    using testing::box_mesh;
    static const PartModelPtr angle = PartModel::from_mesh(
        testing::merged(box_mesh({0.06, 0.02, 0.02}), box_mesh({0.02, 0.04, 0.02}, {0.02, 0.03, 0})), "angle");
    def.parts = {angle};
    def.bin.kind = Bin::Kind::box;
    def.bin.inner_size = Vec3(0.16, 0.14, 0.1);
    def.wall_height = 0.5;
    BodyDef body;
    body.mass = 0.1;
    body.restitution = 0.4;  // impacts read where bodies were before the step
    def.bodies.assign(static_cast<std::size_t>(5 + 3 * variant), body);
    Random random(7, static_cast<std::uint64_t>(variant), Stream::probe);
    for (std::size_t i = 0; i < def.bodies.size(); ++i) {
      BodyState state;
      state.pose.position = Vec3(0.02 * (static_cast<double>(i % 3) - 1), 0.03 * (i % 2) - 0.02, 0.05 + 0.04 * i);
      state.pose.orientation = random.orientation();
      state.velocity.linear = Vec3(0, 0, -0.5);
      starts.push_back(state);
    }
  }

  WorldId add(Solver& solver) const {
    const WorldId id = solver.add_world(def);
    for (std::size_t i = 0; i < starts.size(); ++i) solver.insert(id, i, starts[i]);
    return id;
  }
};

inline std::uint64_t hash_of(const std::vector<BodyState>& states) {
  std::vector<ScenePart> parts(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) parts[i].pose = states[i].pose;
  return state_hash(parts);
}

inline std::uint64_t fallen(int variant, const Capacity& capacity = {}) {
  const auto solver = make_gl_sphere_solver(coarse(), capacity);
  const WorldId id = Handful(variant).add(*solver);
  solver->advance({id}, 0.1);
  solver->advance({id}, 0.1);
  return hash_of(solver->states(id));
}

}  // namespace bin_scenes::sphere_gl
