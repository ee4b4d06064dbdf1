/// The watch of a world by a device against the host's own: the same states in, the same decisions out, observation by
/// observation. And what is read back for it.
#include "bin_scenes/pour/rest_watch.hpp"
#include "pour/device_watch.hpp"
#include "pour/energy_audit.hpp"
#include "solver/sphere_gl/handful.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

using sphere_gl::Handful;

constexpr double slice = 7 * 0.0025, window = 0.25;   // s; whole steps, as where heaps settle
constexpr double rest_move = 1e-3, rest_turn = 1e-2;  // d, rad
constexpr DeviceWatch::Ages ages{0.1, 0.05, 0.2, window};

WatchRules rules_of(const WorldDef& def) {
  constexpr double far = std::numeric_limits<double>::infinity();
  const Vec3 half = 0.5 * def.bin.inner_size;
  return {Vec3(-half.x(), -half.y(), 0.0), Vec3(half.x(), half.y(), far), rest_move, rest_turn};
}

/// RestWatch, EnergyAudit and the tests of HeapCore over states that were read.
struct HostWatch {
  const WorldDef& def;
  RestWatch rest;
  EnergyAudit audit;
  std::vector<bool> in;

  explicit HostWatch(const WorldDef& of) : def(of), rest(of.bodies.size()), audit(of), in(of.bodies.size(), true) {}

  const PartModel& part(std::size_t b) const { return *def.parts[def.bodies[b].part]; }

  std::vector<std::size_t> observe(double time, const std::vector<BodyState>& states) {
    std::vector<std::size_t> left;
    const WatchRules rules = rules_of(def);
    for (std::size_t b = 0; b < states.size(); ++b) {
      if (!in[b] || def.bodies[b].fixed) continue;
      const Vec3 center = states[b].pose * part(b).mass().center;
      if ((center.array() < rules.lower.array()).any() || (center.array() > rules.upper.array()).any()) {
        in[b] = false;
        audit.leave(b);
        left.push_back(b);
        continue;
      }
      rest.observe(b, time, center, states[b].pose.orientation, {window, rest_move * part(b).diagonal(), rest_turn});
    }
    audit.observe(time, states);
    return left;
  }

  template <class Test>
  std::size_t count(Test test) const {
    std::size_t sum = 0;
    for (std::size_t b = 0; b < in.size(); ++b) sum += in[b] && !def.bodies[b].fixed && test(b);
    return sum;
  }
  bool fast(const BodyState& state, std::size_t b) const {
    const double size = part(b).diagonal(), limit = 0.25 * std::sqrt(def.gravity.norm() * size);
    return !(state.velocity.linear.norm() + 0.5 * size * state.velocity.angular.norm() <= limit);
  }
};

/// Parts that fall into a box beside a fixed one; one flies over the edge.
struct Scene {
  Handful parts{1};
  Scene() {
    parts.def.bodies[2].fixed = true;
    parts.starts[2] = {{Vec3(0.04, 0.03, 0.01), Quat::Identity()}, {}};
    parts.starts[4].velocity.linear = Vec3(1.5, 0, 0.5);
    parts.def.wall_height = 0.1;
  }
};

TEST(DeviceWatch, DecidesAsTheHostDoes) {
  const Scene scene;
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse());
  const WorldId id = scene.parts.add(*solver);
  DeviceWatch watch(*solver->watch(), rules_of(scene.parts.def), window);
  watch.begin_world(id);
  watch.restart();
  HostWatch host(scene.parts.def);
  for (std::size_t b = 0; b < scene.parts.starts.size(); ++b) host.audit.enter(b, scene.parts.starts[b]);
  double time = 0.0;
  std::size_t escaped = 0, rested = 0, partly = 0;
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE(k);
    if (k == 60) {  // pushed by nobody, which both must notice
      const std::vector<BodyState> before = solver->states(id);
      for (std::size_t b = 0; b < before.size(); ++b) {
        if (!host.in[b] || scene.parts.def.bodies[b].fixed) continue;
        BodyState state = before[b];
        state.velocity.linear += Vec3(0.0, 0.0, 0.8 + 0.05 * static_cast<double>(b));
        solver->insert(id, b, state);
      }
    }
    watch.ask(time + slice, ages, false, true);
    time += slice;
    solver->advance({id}, slice);
    watch.take();
    const std::vector<BodyState> states = solver->states(id);
    const std::vector<std::size_t> left = host.observe(time, states);
    ASSERT_EQ(watch.seen().outside, left.size());
    for (const std::size_t b : left) {
      EXPECT_TRUE(watch.is_outside(b));
      solver->remove(id, b);
    }
    escaped += left.size();
    const std::vector<bool> asleep = solver->asleep(id);
    ASSERT_EQ(watch.seen().fast, host.count([&](std::size_t b) { return host.fast(states[b], b); }));
    if (left.empty()) {  // what is taken out wakes what it touched
      ASSERT_EQ(watch.seen().awake, host.count([&](std::size_t b) { return !asleep[b]; }));
    }
    for (const double age : ages)
      ASSERT_EQ(watch.moved(age), host.count([&](std::size_t b) { return host.rest.still(b, time) < age; })) << age;
    ASSERT_EQ(watch.seen().unrested, host.count([&](std::size_t b) { return !host.rest.resting(b); }));
    host.count([&](std::size_t b) {
      EXPECT_EQ(watch.resting(b), host.rest.resting(b)) << b;
      EXPECT_NEAR(watch.still(b), host.rest.still(b, time), 1e-9) << b;
      return true;
    });
    rested += watch.seen().unrested == 0;
    partly += watch.seen().unrested > 0 && watch.moved(0.1) < 6;
    const EnergyReport mine = watch.energy(), twin = host.audit.worst();
    ASSERT_NEAR(mine.gain, twin.gain, 1e-4 + 1e-4 * twin.gain);
    ASSERT_NEAR(mine.thrown.ratio, twin.thrown.ratio, 1e-3 * (1.0 + twin.thrown.ratio));
    ASSERT_NEAR(watch.energy_of_all().relative, host.audit.worst_of_world().relative, 1e-4);
    if (twin.gain > 0.1) {
      ASSERT_EQ(mine.part, twin.part);
      ASSERT_NEAR(mine.time, twin.time, 1e-9);
    }
    if (twin.thrown.ratio > 1.0) {
      ASSERT_EQ(mine.thrown.part, twin.thrown.part);
      ASSERT_EQ(mine.thrown.beside, twin.thrown.beside);
      ASSERT_NEAR(mine.thrown.time, twin.thrown.time, 1e-9);
    }
  }
  EXPECT_GE(escaped, 1u);
  EXPECT_GT(partly, 3u) << "observations at which some move and some do not";
  EXPECT_GT(host.audit.worst().gain, 0.1) << "the push";
  EXPECT_GT(host.audit.worst().thrown.ratio, 1.0);
  EXPECT_GT(host.audit.worst_of_world().relative, 0.01);
}

TEST(DeviceWatch, ReadsThirtyTwoBytesOfAWorld) {
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse());
  std::vector<WorldId> ids;
  std::vector<DeviceWatch> watches;
  for (const int variant : {0, 1, 2}) {
    const Handful parts(variant);
    ids.push_back(parts.add(*solver));
    watches.emplace_back(*solver->watch(), rules_of(parts.def), window);
    watches.back().begin_world(ids.back());
  }
  const auto bytes = [&] { return solver->profile().counters.at("gl_bytes_read_back"); };
  constexpr std::uint64_t states = (5 + 8 + 11) * 144 + 3 * (176 + 32 + 48);
  constexpr int slices = 60;
  double time = 0.0;
  for (int k = 1; k <= slices; ++k) {
    const std::uint64_t before = k == 1 ? 0 : bytes();
    for (DeviceWatch& watch : watches) watch.ask(time + slice, ages, false, k == slices);
    time += slice;
    solver->advance(ids, slice);
    for (DeviceWatch& watch : watches) watch.take();
    const std::uint64_t read = bytes() - before;
    // Steps of fast parts are cut, and the host looks again at worlds that need more of them than it expected. And
    // while lists grow, it reads what they need.
    if (k <= 50) continue;
    EXPECT_EQ(read, 3u * 32u + (k == slices ? states : 0u)) << k;
  }
  for (const WorldId id : ids) EXPECT_FALSE(solver->states(id).empty());
  EXPECT_LT(watches[2].seen().fast, 3u) << "they lie";
}

// A step of the fast world is four. Beside it the others go on, slice after slice, and each is observed when its own is
// done; the states are those of worlds that are advanced alone.
TEST(DeviceWatch, AWorldIsNotWaitedForByOthers) {
  std::vector<Handful> parts{Handful(0), Handful(1)};
  for (Handful& handful : parts) handful.def.bin.kind = Bin::Kind::none;
  for (std::size_t i = 0; i < parts[1].starts.size(); ++i) {
    parts[1].starts[i].pose.position = Vec3(0.0, 0.0, static_cast<double>(i));
    parts[1].starts[i].velocity.linear = Vec3(11.0, 0.0, 0.0);
  }
  const auto hash_alone = [&](std::size_t k, int slices) {
    const auto solver = make_gl_sphere_solver(sphere_gl::coarse());
    const WorldId id = parts[k].add(*solver);
    for (int slice_number = 0; slice_number < slices; ++slice_number) solver->advance({id}, slice);
    return sphere_gl::hash_of(solver->states(id));
  };
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse());
  WorldWatch& watch = *solver->watch();
  std::vector<WorldId> ids;
  std::vector<DeviceWatch> watches;
  for (const Handful& handful : parts) {
    ids.push_back(handful.add(*solver));
    watches.emplace_back(watch, rules_of(handful.def), window);
    watches.back().begin_world(ids.back());
  }
  std::array<int, 2> slices{};
  std::array<double, 2> time{};
  for (int piece = 0; piece < 9; ++piece) {
    for (std::size_t k = 0; k < 2; ++k)
      if (!watch.under_way(ids[k])) watches[k].ask(time[k] + slice, ages, false, false);
    watch.begin_some(ids, slice);
    watch.finish_some(ids);
    for (std::size_t k = 0; k < 2; ++k) {
      if (watch.under_way(ids[k])) continue;
      watches[k].take();
      time[k] += slice;
      EXPECT_EQ(watches[k].seen().observation, static_cast<std::uint32_t>(++slices[k]));
    }
  }
  EXPECT_EQ(slices, (std::array<int, 2>{9, 2})) << "28 of 63 shortened steps are those of a slice";
  solver->begin({ids[1]}, slice);
  solver->finish({ids[1]});
  EXPECT_FALSE(watch.under_way(ids[1])) << "finish() ends the slice that was under way, and begins no other";
  EXPECT_EQ(sphere_gl::hash_of(solver->states(ids[0])), hash_alone(0, 9));
  EXPECT_EQ(sphere_gl::hash_of(solver->states(ids[1])), hash_alone(1, 3));
}

}  // namespace
}  // namespace bin_scenes
