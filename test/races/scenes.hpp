/// Scenes in which the passes of the sphere solver go most of their ways.
#pragma once

#include "bin_scenes/solver/thesis_solver.hpp"
#include "bin_scenes/solver/world_watch.hpp"
#include "races/recorder.hpp"
#include "solver/sphere_gl/handful.hpp"

namespace bin_scenes::races {

/// 170 blocks, balls and eggs that strike the floor beside each other, 80 of them a tray that lies there, and ten in
/// the air: more pairs than groups take in one go, a color of more manifolds than a group has invocations, and
/// manifolds for which no color is left.
struct Carpet {
  static constexpr int tray_end = 80, floor_end = 170;
  WorldDef def;
  std::vector<BodyState> starts;

  Carpet() {
    def.parts = {PartModel::from_mesh(testing::box_mesh({0.018, 0.02, 0.022}), "block"),
                 PartModel::from_mesh(testing::box_mesh({0.35, 0.35, 0.02}), "tray"),
                 PartModel::from_mesh(testing::sphere_mesh(0.01, 3), "ball"), PartModel::from_mesh(egg(), "egg")};
    def.bin.kind = Bin::Kind::box;
    def.bin.inner_size = Vec3(1.0, 0.5, 0.1);
    for (int i = 0; i < floor_end; ++i) {
      const bool on_tray = i < tray_end;
      add(i % 8 == 5   ? 2
          : i % 8 == 6 ? 3
                       : 0,
          Vec3(0.035 * (i % 10) + (on_tray ? -0.41 : 0.05), 0.035 * ((on_tray ? i : i - tray_end) / 10) - 0.14,
               on_tray ? 0.033 : 0.012));
    }
    for (int i = 0; i < 10; ++i) add(0, Vec3(0.035 * i + 0.05, 0, 0.3));
    add(1, Vec3(-0.25, 0, 0.011));
  }

 private:
  static Mesh egg() {
    Mesh mesh = testing::sphere_mesh(0.01, 2);
    for (Vec3& v : mesh.vertices) v.x() *= 1.3;
    return mesh;
  }

  void add(std::size_t part, const Vec3& position) {
    BodyDef body;
    body.part = part;
    body.restitution = 0.5;
    def.bodies.push_back(body);
    BodyState state;
    state.pose.position = position;
    const double tilt = 0.002 * static_cast<double>(def.bodies.size() % 7) + 0.003;  // no two corners are as deep
    state.pose.orientation = Quat(1, tilt, 0.6 * tilt, 0.3).normalized();
    state.velocity.linear = Vec3(0, 0, part == 1 ? 0 : -0.8);
    starts.push_back(state);
  }
};

/// Two heaps at once: as they begin, as they strike, as they come to rest in each way of sleeping, and as some are
/// taken away.
inline void watch_heaps(Recorder& recorder, const sphere_gl::Capacity& capacity) {
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse(), capacity);
  const std::vector<WorldId> worlds = {sphere_gl::Handful(2).add(*solver), sphere_gl::Handful(1).add(*solver)};
  const auto watch_after = [&](double seconds) {
    if (seconds > 0) solver->advance(worlds, seconds);
    recorder.begin();
    solver->advance(worlds, solver->step_size());
    recorder.end();
  };
  const auto change_to = [&](Phase::Sleep sleep, Stiffness stiffness, bool forgets) {
    Phase phase;
    phase.sleep = sleep;
    phase.stiffness = stiffness;
    phase.forgets = forgets;
    for (const WorldId world : worlds) solver->set_phase(world, phase);
  };
  for (const double seconds : {0.0, 0.03, 0.03, 0.04, 0.3}) watch_after(seconds);
  change_to(Phase::Sleep::by_part, Stiffness::rigid, true);
  watch_after(0);
  watch_after(0.05);
  change_to(Phase::Sleep::by_touch, Stiffness::stiff, false);
  watch_after(0.02);
  watch_after(0.3);
  for (const WorldId world : worlds)
    for (const std::size_t body : {1, 4}) solver->remove(world, body);
  watch_after(0);
}

inline void watch_carpet(Recorder& recorder, const sphere_gl::Capacity& capacity) {
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse(), capacity);
  const Carpet carpet;
  const WorldId world = solver->add_world(carpet.def);
  for (std::size_t i = 0; i < carpet.starts.size(); ++i) solver->insert(world, i, carpet.starts[i]);
  WorldWatch& watch = *solver->watch();
  watch.set_rules(world, {Vec3(-0.5, -0.25, 0.0), Vec3(0.5, 0.25, 0.295), 1e-3, 1e-2});  // those in the air are outside
  WatchAsk ask;
  ask.observation = 1;
  ask.seconds = 2 * solver->step_size();
  ask.rest_anew = ask.energy_anew = ask.states = true;
  watch.ask(world, ask);
  recorder.begin();
  solver->advance({world}, ask.seconds);
  recorder.end();
  // Ten from the floor and those in the air change places: pairs part and others begin in one step.
  const std::vector<BodyState> states = solver->states(world);
  for (std::size_t k = 0; k < 10; ++k) {
    const std::size_t low = Carpet::tray_end + k, high = Carpet::floor_end + k;
    solver->insert(world, low, states[high]);
    solver->insert(world, high, states[low]);
  }
  // Two are thrown by nobody, as the audit of their energy sees.
  for (const std::size_t body : {std::size_t{3}, std::size_t{90}}) {
    BodyState state = states[body];
    state.velocity.linear.z() += 6.0;
    solver->insert(world, body, state);
  }
  ask = {};
  ask.observation = 2;
  ask.seconds = solver->step_size();
  ask.since = {1, 2, 1, 2};
  ask.rested = 1;
  ask.states = true;
  watch.ask(world, ask);
  recorder.begin();
  solver->advance({world}, solver->step_size());
  recorder.end();
}

/// Blocks that fall onto a plate asleep at `speed` (m/s), with a `gap` (m): all are of one color, until the plate
/// wakes. A block that is fast wakes it as it strikes, a slow one by pressing in the step before the one that is
/// watched.
inline void watch_waking(Recorder& recorder, double speed, double gap, int steps_before) {
  WorldDef def;
  def.parts = {PartModel::from_mesh(testing::box_mesh({0.018, 0.02, 0.022}), "block"),
               PartModel::from_mesh(testing::box_mesh({0.2, 0.2, 0.02}), "plate")};
  def.bin.kind = Bin::Kind::floor;
  def.bodies.assign(5, testing::material(0.5));
  def.bodies[0].part = 1;  // the plate comes first in its pairs, so that coloring reads at once whether it is awake
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse());
  const WorldId world = solver->add_world(def);
  BodyState state;
  state.pose.position = Vec3(0, 0, 0.01);
  solver->insert(world, 0, state);
  Phase asleep;
  asleep.begins_asleep = true;
  solver->set_phase(world, asleep);
  for (std::size_t i = 1; i <= 4; ++i) {
    state.pose.position = Vec3(0.04 * static_cast<double>(i) - 0.1, 0, 0.031 + gap);
    state.velocity.linear = Vec3(0, 0, -speed);
    solver->insert(world, i, state);
  }
  for (int k = 0; k < steps_before; ++k) solver->advance({world}, solver->step_size());
  recorder.begin();
  solver->advance({world}, solver->step_size());
  recorder.end();
}

/// A heap for which no buffer has room at first: it begins where it lay in another solver.
inline void watch_overflow(Recorder& recorder, sphere_gl::Capacity capacity) {
  const sphere_gl::Handful heap(2);
  const auto usual = make_gl_sphere_solver(sphere_gl::coarse());
  const WorldId fallen = heap.add(*usual);
  usual->advance({fallen}, 0.3);
  capacity.pairs = capacity.rows = capacity.candidates = 1;
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse(), capacity);
  const WorldId world = solver->add_world(heap.def);
  const std::vector<BodyState> states = usual->states(fallen);
  for (std::size_t i = 0; i < states.size(); ++i) solver->insert(world, i, states[i]);
  recorder.begin(false);
  solver->advance({world}, solver->step_size());
  recorder.end();
}

/// The same two heaps as spheres, by the method of the thesis.
inline void watch_spheres(Recorder& recorder) {
  ThesisSolver solver;
  const std::vector<WorldId> worlds = {sphere_gl::Handful(2).add(solver), sphere_gl::Handful(1).add(solver)};
  for (const double seconds : {0.0, 0.1, 0.1}) {
    if (seconds > 0) solver.advance(worlds, seconds);
    recorder.begin();
    solver.advance(worlds, solver.step_size());
    recorder.end();
  }
}

}  // namespace bin_scenes::races
