/// What must not matter: the run, the other worlds of a batch, threads of the driver, sizes of buffers. What must: who
/// touches whom when a part is taken out.
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "pour/settling.hpp"
#include "solver/fixture.hpp"
#include "solver/sphere_gl/convert.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"
#include "solver/sphere_gl/handful.hpp"
#include "solver/sphere_gl/resident.hpp"

#include <gtest/gtest.h>

#include <functional>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

namespace bin_scenes::sphere_gl {
namespace {

TEST(SphereGlBatch, SameRunSameBits) {
  EXPECT_EQ(fallen(0), fallen(0));
  EXPECT_NE(fallen(0), fallen(1)) << "the hash does not see the states";
}

TEST(SphereGlBatch, AStretchEndsWithAShorterStep) {
  Handful handful(0);
  handful.def.bin.kind = Bin::Kind::none;
  const auto solver = make_gl_sphere_solver(coarse());
  const WorldId id = handful.add(*solver);
  for (const double seconds : {0.0011, 0.0502}) {
    const BodyState before = solver->states(id)[0];
    EXPECT_NEAR(solver->advance({id}, seconds), seconds, 1e-12);
    const BodyState after = solver->states(id)[0];
    EXPECT_NEAR(after.velocity.linear.z() - before.velocity.linear.z(), -9.81 * seconds, 1e-5);
  }
  EXPECT_EQ(solver->steps(id), 1u + 21u);
}

TEST(SphereGlBatch, AWorldIsTheSameAloneAndInABatch) {
  const auto solver = make_gl_sphere_solver(coarse());
  std::vector<WorldId> ids;
  for (const int variant : {2, 0, 1}) ids.push_back(Handful(variant).add(*solver));
  solver->advance(ids, 0.1);
  // One leaves, the next takes its place; worlds are at different steps.
  const std::uint64_t none = solver->steps(ids[1]);
  solver->remove_world(ids[1]);
  ids[1] = Handful(0).add(*solver);
  EXPECT_LT(solver->steps(ids[1]), none);
  solver->advance({ids[1]}, 0.1);
  solver->advance({ids[2], ids[1], ids[0]}, 0.1);
  EXPECT_EQ(hash_of(solver->states(ids[0])), fallen(2));
  EXPECT_EQ(hash_of(solver->states(ids[1])), fallen(0));
  EXPECT_EQ(hash_of(solver->states(ids[2])), fallen(1));
}

// As pour() does it: the host looks at one world, and changes it, while the device works on the other; lists that are
// full grow meanwhile.
TEST(SphereGlBatch, AWorldIsTheSameWhileAnotherIsUnderWay) {
  Capacity small;
  small.pairs = small.rows = small.candidates = 1;
  const auto solver = make_gl_sphere_solver(coarse(), small);
  const WorldId one = Handful(1).add(*solver), two = Handful(2).add(*solver);
  for (int k = 0; k < 2; ++k) {
    solver->begin({one}, 0.1);
    if (k > 0) solver->finish({two});
    solver->begin({two}, 0.1);
    solver->finish({one});
  }
  const std::uint64_t hash = hash_of(solver->states(one));
  solver->remove_world(one);
  solver->finish({two});
  EXPECT_EQ(hash, fallen(1));
  EXPECT_EQ(hash_of(solver->states(two)), fallen(2));
}

// The last world's bodies lie far from the first's: what is counted in the world must not be read as if it were not.
TEST(SphereGlBatch, AWorldIsTheSameBehindAThousandBodies) {
  const auto solver = make_gl_sphere_solver(coarse());
  for (int k = 0; k < 100; ++k) Handful(2).add(*solver);
  const WorldId id = Handful(1).add(*solver);
  solver->advance({id}, 0.1);
  solver->advance({id}, 0.1);
  EXPECT_EQ(hash_of(solver->states(id)), fallen(1));
}

TEST(SphereGlBatch, AListThatIsFullGrowsAndTheStepIsRepeated) {
  Capacity small;
  small.pairs = 1;
  small.rows = 1;
  small.candidates = 1;
  EXPECT_EQ(fallen(1, small), fallen(1));
  const auto solver = make_gl_sphere_solver(coarse(), small);
  const WorldId id = Handful(1).add(*solver);
  solver->advance({id}, 0.2);
  EXPECT_GT(solver->profile().counters.at("steps_repeated"), 1u);
}

// An attempt for which there are too few rows has colored the manifolds: its repetition must find these colors, and
// judge them as it would have been done.
TEST(SphereGlBatch, AStepThatIsRepeatedForRowsHasTheSameColors) {
  Capacity few_rows;
  few_rows.rows = 1;
  for (const int variant : {1, 4, 5}) EXPECT_EQ(fallen(variant, few_rows), fallen(variant)) << variant;
}

TEST(SphereGlBatch, AListThatMayNotGrowIsFilledSeveralTimes) {
  Capacity small;
  small.candidates = 1;
  small.most_candidates = 200;  // no pair has as many: a pair that had more would never find room
  const auto solver = make_gl_sphere_solver(coarse(), small);
  const WorldId one = Handful(1).add(*solver), two = Handful(2).add(*solver);
  for (int k = 0; k < 2; ++k) solver->advance({one, two}, 0.1);
  EXPECT_EQ(hash_of(solver->states(one)), fallen(1));
  EXPECT_EQ(hash_of(solver->states(two)), fallen(2));
  // A step that finds more candidates than fit is repeated; 27 repetitions were seen on llvmpipe.
  EXPECT_GT(solver->profile().counters.at("steps_repeated"), 20u);
}

TEST(SphereGlBatch, AWorldIsTheSameInAGroupOfAnySize) {
  Capacity other;
  other.world_group = 256;
  EXPECT_EQ(fallen(2, other), fallen(2));
  other.pair_group = 32;
  EXPECT_EQ(fallen(2, other), fallen(2));
}

/// Three walls of four rows of bricks, each brick on two: 192 bodies, as many as a group holds on a software device, in
/// islands of 64.
struct Walls {
  WorldDef def;

  Walls() {
    def.parts = {PartModel::from_mesh(testing::box_mesh({0.08, 0.04, 0.04}), "brick")};
    def.bin.kind = Bin::Kind::floor;
    def.bodies.assign(software_group_bodies, testing::material(0.5));
  }

  WorldId add(Solver& solver) const {
    const WorldId id = solver.add_world(def);
    for (std::size_t i = 0; i < def.bodies.size(); ++i) {
      const auto wall = static_cast<double>(i / 64), row = static_cast<double>(i / 16 % 4);
      const double along = static_cast<double>(i % 16) + 0.5 * static_cast<double>(i / 16 % 2);
      BodyState state;
      state.pose.position = Vec3(0.085 * along, 0.1 * wall, 0.04 * row + 0.02);
      solver.insert(id, i, state);
    }
    return id;
  }
};

// For the test below, in a process of its own: three small worlds, and a large one.
TEST(SphereGlBatch, PrintsHash) {
  if (!std::getenv("BIN_SCENES_TEST_PRINT_HASH")) GTEST_SKIP() << "runs inside another test";
  const auto print = [](std::uint64_t hash) { std::printf("hash %016llx\n", static_cast<unsigned long long>(hash)); };
  const auto solver = make_gl_sphere_solver(coarse());
  if (std::getenv("BIN_SCENES_TEST_ALONE")) {
    const WorldId id = Handful(1).add(*solver);
    solver->advance({id}, 0.2);
    return print(hash_of(solver->states(id)));
  }
  std::vector<WorldId> ids;
  for (const int variant : {2, 0, 1}) ids.push_back(Handful(variant).add(*solver));
  for (int k = 0; k < 2; ++k) solver->advance(ids, 0.1);
  for (const WorldId id : ids) print(hash_of(solver->states(id)));
  SphereSettings settings = coarse();
  settings.field_cell = 0.01;
  const auto full = make_gl_sphere_solver(settings);
  const WorldId walls = Walls().add(*full);
  full->set_phase(walls, phases::press);
  for (int k = 0; k < 2; ++k) full->advance({walls}, 0.25);
  print(hash_of(full->states(walls)));
  const std::vector<bool> asleep = full->asleep(walls);
  print(std::hash<std::vector<bool>>()(asleep));
  EXPECT_GT(std::count(asleep.begin(), asleep.end(), true), 64) << "no island was joined";
}

std::string hash_in_process(const std::string& environment) {
  std::array<char, 4096> path{};
  const auto length = readlink("/proc/self/exe", path.data(), path.size() - 1);
  const std::string command = environment + " BIN_SCENES_TEST_PRINT_HASH=1 '" +
                              std::string(path.data(), static_cast<std::size_t>(length)) +
                              "' --gtest_filter=SphereGlBatch.PrintsHash";
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 256> line{};
  while (pipe && std::fgets(line.data(), line.size(), pipe))
    if (std::string(line.data()).rfind("hash ", 0) == 0) out += line.data();
  if (pipe) pclose(pipe);
  return out;
}

TEST(SphereGlBatch, ThreadsOfTheDriverDoNotMatter) {
  const std::string without = hash_in_process("LP_NUM_THREADS=0");
  EXPECT_EQ(without.size(), 5 * 22u) << without;
  EXPECT_EQ(without, hash_in_process("LP_NUM_THREADS=2"));
}

// As many invocations run in step as fit a vector of the processor. Without Mesa's cache, which does not tell code of
// one width from that of another, compiling takes long: one small world.
TEST(SphereGlBatch, WidthsOfTheDriversVectorsDoNotMatter) {
  const std::string alone = " BIN_SCENES_TEST_ALONE=1",
                    narrow = hash_in_process("MESA_SHADER_CACHE_DISABLE=true LP_NATIVE_VECTOR_WIDTH=128" + alone);
  EXPECT_EQ(narrow.size(), 22u) << narrow;
  EXPECT_EQ(narrow, hash_in_process("LP_NATIVE_VECTOR_WIDTH=256" + alone));
}

/// What is asked of the device while worlds of the solver go on by `seconds`, the first time that no list grows.
gl::Traffic asked_for(
    Solver& solver, const std::vector<WorldId>& ids, double seconds, const std::function<void()>& before_it = [] {}) {
  const auto repeated = [&] {
    const auto& counters = solver.profile().counters;
    const auto at = counters.find("steps_repeated");
    return at == counters.end() ? 0 : at->second;
  };
  for (int stretch = 0; stretch < 10; ++stretch) {
    before_it();
    const std::uint64_t repeated_before = repeated();
    const gl::Traffic before = gl::traffic();
    solver.advance(ids, seconds);
    const gl::Traffic after = gl::traffic();
    if (repeated() > repeated_before) continue;
    return {after.dispatches - before.dispatches, after.barriers - before.barriers,
            after.argument_barriers - before.argument_barriers, after.bytes_uploaded - before.bytes_uploaded,
            after.bytes_read_back - before.bytes_read_back};
  }
  ADD_FAILURE() << "lists grow on";
  return {};
}

TEST(SphereGlBatch, WorldsAtOnceGoByMemory) {
  constexpr std::size_t two_gib = (std::size_t{1} << 31) - 1;
  Capacity capacity;
  capacity.bodies = 256;
  EXPECT_EQ(worlds_at_once(capacity, two_gib, false), 651u);
  EXPECT_EQ(worlds_at_once(capacity, std::size_t{128} << 20, false), 128u) << "half of a block of 128 MiB";
  EXPECT_EQ(worlds_at_once(capacity, two_gib, true), 4u);
  capacity.memory = 1e8;
  EXPECT_EQ(worlds_at_once(capacity, two_gib, false), 65u);
  capacity.memory = 1.0;
  EXPECT_EQ(worlds_at_once(capacity, two_gib, false), 1u);
}

// What a step costs on a device for which dispatches and barriers are dear (docs/develop/gpu.md).
TEST(SphereGlBatch, AStepIsElevenDispatchesForAllWorldsOfABatch) {
  const auto solver = make_gl_sphere_solver(coarse());
  std::vector<WorldId> ids;
  for (const int variant : {0, 1, 2}) ids.push_back(Handful(variant).add(*solver));
  solver->advance(ids, 0.2);
  for (const Phase phase : {phases::pour, phases::press, phases::probe}) {
    for (const WorldId id : ids) solver->set_phase(id, phase);
    solver->advance(ids, 0.05);  // lists grow
    const auto wake = [&] {
      for (const Phase each : {phases::settle, phase})
        for (const WorldId id : ids) solver->set_phase(id, each);
    };
    const gl::Traffic woken = asked_for(*solver, ids, 7 * solver->step_size(), wake);
    EXPECT_EQ(woken.barriers, 7u * 11u + 3u + 3u + 2u + 2u + 2u);  // bodies that a phase wakes go up, a copy a world
    const gl::Traffic slice = asked_for(*solver, ids, 7 * solver->step_size());
    EXPECT_EQ(slice.dispatches, 7u * 11u + 3u) << "and three of the watch";
    // A barrier behind each, and one before each copy: what worlds are to do, who runs, settings; one read back.
    EXPECT_EQ(slice.barriers, 7u * 11u + 3u + 1u + 2u + 2u);
    EXPECT_EQ(slice.argument_barriers, 7u * 3u) << "how many pairs, samples and touches there are";
    EXPECT_EQ(slice.bytes_uploaded,
              3 * sizeof(gpu::SphereAsk) + 3 * sizeof(gpu::uint) + sizeof(gpu::SphereSettingsBlock));
    EXPECT_EQ(slice.bytes_read_back, 3 * (sizeof(gpu::SphereSeen) + sizeof(gpu::SphereProgress) +
                                          sizeof(gpu::SphereWorst) + sizeof(gpu::SphereAudit)) +
                                         (5 + 8 + 11) * sizeof(gpu::SphereState));
  }
}

// Steps of a fast world are shortened. Its host knows from the last slice how many dispatches they need, and waits
// once; worlds that are done meanwhile are neither stepped nor read again.
TEST(SphereGlBatch, AWorldWhoseStepsAreShortenedIsObservedOnceASlice) {
  Handful still(0), fast(2);
  still.def.bin.kind = fast.def.bin.kind = Bin::Kind::none;
  for (std::size_t i = 0; i < fast.starts.size(); ++i) {
    fast.starts[i].pose.position = Vec3(0.0, 0.0, static_cast<double>(i));
    fast.starts[i].velocity.linear = Vec3(11.0, 0.0, 0.0);  // a step is cut into 4
  }
  const auto solver = make_gl_sphere_solver(coarse());
  const std::vector<WorldId> ids = {still.add(*solver), fast.add(*solver)};
  const auto observations = [&] { return solver->profile().counters.at("observations"); };
  constexpr std::size_t all =
      sizeof(gpu::SphereSeen) + sizeof(gpu::SphereProgress) + sizeof(gpu::SphereWorst) + sizeof(gpu::SphereAudit);
  const double slice = 7 * solver->step_size();
  solver->advance(ids, slice);
  EXPECT_EQ(observations(), 2u) << "at first nobody knows";
  for (int k = 0; k < 3; ++k) {
    const std::uint64_t before = observations();
    const gl::Traffic asked = asked_for(*solver, ids, slice);
    EXPECT_EQ(asked.dispatches, 4u * 7u * 11u + 3u);
    EXPECT_EQ(asked.bytes_read_back, 2 * all + (5 + 11) * sizeof(gpu::SphereState));
    EXPECT_EQ(observations() - before, 1u);
  }
}

TEST(SphereGlBatch, WorldsWithTheMostSweepsComeFirst) {
  std::vector<Resident> worlds(4);
  const std::array stiffness{Stiffness::soft, Stiffness::rigid, Stiffness::soft, Stiffness::stiff};
  std::vector<const Resident*> all;
  for (std::size_t k = 0; k < worlds.size(); ++k) {
    worlds[k].slot = 10 + k;
    worlds[k].world.stiffness = stiffness[k];
    all.push_back(&worlds[k]);
  }
  EXPECT_EQ(longest_first(all), (std::vector<Batch::Slot>{13, 11, 10, 12}));
}

/// Two stacks of two blocks: what is taken out wakes the one above it, not the other stack. Asleep, a world costs no
/// contact work.
TEST(SphereGlBatch, TakingAPartOutWakesWhatItHeldUp) {
  SphereSettings settings = coarse();
  settings.field_cell = 0.01;
  const auto solver = make_gl_sphere_solver(settings);
  WorldDef def;
  def.parts = {PartModel::from_mesh(testing::box_mesh({0.05, 0.05, 0.05}), "block"),
               PartModel::from_mesh(testing::box_mesh({0.03, 0.03, 0.03}), "small block")};
  def.bin.kind = Bin::Kind::floor;
  def.bodies.assign(4, testing::material(0.5));
  def.bodies[1].part = def.bodies[3].part = 1;
  const WorldId id = solver->add_world(def);
  for (std::size_t i = 0; i < 4; ++i) {
    BodyState state;
    state.pose.position = Vec3(i < 2 ? 0.0 : 0.2, 0, i % 2 ? 0.065 : 0.025);
    solver->insert(id, i, state);
  }
  solver->advance({id}, 1.0);
  EXPECT_EQ(solver->asleep(id), std::vector<bool>(4, true));
  const auto tested = [&] { return solver->profile().counters.at("nodes_tested"); };
  const std::uint64_t before = tested();
  solver->advance({id}, 0.2);
  EXPECT_EQ(tested(), before);
  solver->remove(id, 0);
  solver->advance({id}, solver->step_size());
  EXPECT_EQ(solver->asleep(id), (std::vector<bool>{false, false, true, true}));
  solver->advance({id}, 0.5);
  EXPECT_NEAR(solver->states(id)[1].pose.position.z(), 0.015, 1e-4);
  solver->set_phase(id, phases::settle);
  solver->advance({id}, solver->step_size());
  EXPECT_EQ(solver->asleep(id)[2], false) << "finer samples must look again";
}

}  // namespace
}  // namespace bin_scenes::sphere_gl
