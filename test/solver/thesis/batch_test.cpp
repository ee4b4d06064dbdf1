// What must not matter: the run, the other worlds of a batch, threads, buffer sizes, the grid.
#include "scenes.hpp"
#include "solver/thesis/memory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

namespace bin_scenes::thesis::test {
namespace {

/// A handful of bodies falling on each other in a small box; `variant` turns them.
WorldBuilder handful(int variant) {
  WorldBuilder world;
  world.def.bin.inner_size = Vec3(0.12, 0.10, 0.1);
  const std::size_t a = world.shape(cube(3, 0.005)), b = world.shape(rod(5, 0.005));
  for (int i = 0; i < 6; ++i) {
    world.body(i % 2 ? a : b, Vec3(0.02 * (i % 3 - 1), 0.015 * (i % 2), 0.02 + 0.03 * i), Vec3(0.1, 0, -0.5), 0.05);
    world.starts.back().pose.orientation = Quat(Eigen::AngleAxisd(0.5 * i + 0.3 * variant, Vec3(1, i, 2).normalized()));
  }
  return world;
}

std::uint64_t settled_hash(const ThesisSettings& settings, int variant) {
  ThesisSolver solver(settings);
  const WorldId id = handful(variant).add(solver, settings);
  solver.advance({id}, 0.3);
  return hash_of(solver.states(id));
}

TEST(ThesisBatch, SameRunSameBits) {
  EXPECT_EQ(settled_hash({}, 0), settled_hash({}, 0));
  EXPECT_NE(settled_hash({}, 0), settled_hash({}, 1)) << "the hash does not see the states";
}

TEST(ThesisBatch, AWorldIsTheSameAloneAndInABatch) {
  ThesisSolver solver;
  std::vector<WorldId> ids;
  for (int variant = 0; variant < 3; ++variant) ids.push_back(handful(variant).add(solver));
  solver.advance(ids, 0.1);
  solver.advance({ids[2], ids[1], ids[0]}, 0.2);  // another order
  for (int variant = 0; variant < 3; ++variant)
    EXPECT_EQ(hash_of(solver.states(ids[variant])), settled_hash({}, variant)) << "world " << variant;
}

// Bodies, spheres and shapes stay on the device; so do states that nobody changed.
TEST(ThesisBatch, OnlyTheGridGoesUpBetweenSteps) {
  ThesisSolver solver;
  std::vector<WorldId> ids;
  for (int variant = 0; variant < 3; ++variant) ids.push_back(handful(variant).add(solver));
  const auto uploaded = [&] { return solver.profile().counters.at("gl_bytes_uploaded"); };
  const auto repeated = [&] {
    const auto at = solver.profile().counters.find("steps_repeated");
    return at == solver.profile().counters.end() ? 0 : at->second;
  };
  constexpr std::size_t grid = 3 * sizeof(gpu::ThesisWorld) + sizeof(gpu::ThesisSettingsBlock);
  constexpr int steps_per_look = 8;
  solver.advance(ids, 0.3);  // buffers grow
  for (int k = 0; k < 4; ++k) {
    const std::uint64_t before = uploaded(), repeated_before = repeated();
    solver.advance(ids, steps_per_look * solver.step_size());
    ASSERT_EQ(repeated(), repeated_before);
    EXPECT_LE(uploaded() - before, grid);
  }
  const std::uint64_t before = uploaded();
  solver.advance({ids[0], ids[1]}, solver.step_size());
  EXPECT_GT(uploaded() - before, grid) << "another batch is another memory";
}

TEST(ThesisBatch, GridAndBufferSizesDoNotChangeTheResult) {
  const std::uint64_t usual = settled_hash({}, 0);
  ThesisSettings settings;
  settings.grid_size = 4;  // most spheres in outer cells
  EXPECT_EQ(settled_hash(settings, 0), usual);
  settings = {};
  settings.cell_size = 3.0;
  EXPECT_EQ(settled_hash(settings, 0), usual);
  settings = {};
  settings.contacts_per_sphere = 16;
  EXPECT_EQ(settled_hash(settings, 0), usual);
}

TEST(ThesisBatch, AFullContactBufferGrowsAndIsReported) {
  ThesisSettings settings;
  settings.contacts_per_sphere = 1;
  ThesisSolver solver(settings);
  const WorldId id = handful(0).add(solver, settings);
  solver.advance({id}, 0.3);
  EXPECT_EQ(hash_of(solver.states(id)), settled_hash({}, 0)) << "a repeated step is not the same step";
  EXPECT_GT(solver.profile().counters.at("steps_repeated"), 0u);
  const std::vector<Flag> flags = solver.flags(id);
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].code, "contact_overflow");
  EXPECT_NE(flags[0].remedy.find("contacts_per_sphere"), std::string::npos);
}

TEST(ThesisBatch, AFullListOfContactsGrowsAndNothingIsLost) {
  // 50 x 50 spheres in the hollows of a lattice as wide: four contacts a sphere, and at first there is room for two.
  const auto plate = [] {
    WorldBuilder world;
    world.body(world.floor().shape(block(50, 50, 1, 0.005, 0.01)), Vec3(0, 0, 0.003), Vec3(0, 0, -0.1), 1.0);
    return world;
  };
  ThesisSolver solver;
  const WorldId first = plate().add(solver);
  solver.advance({first}, 0.1);
  const std::uint64_t repeated = solver.profile().counters.at("steps_repeated");
  EXPECT_GT(repeated, 0u);
  EXPECT_GT(solver.profile().counters.at("contacts"), 2u * 2500u * 5u) << "half of the ten steps";
  const WorldId second = plate().add(solver);
  solver.advance({second}, 0.1);
  EXPECT_EQ(solver.profile().counters.at("steps_repeated"), repeated) << "the room was not kept";
  EXPECT_EQ(hash_of(solver.states(second)), hash_of(solver.states(first))) << "a repeated step is not the same step";
  EXPECT_TRUE(solver.flags(first).empty()) << "of no concern to the user";
}

TEST(ThesisBatch, AFullNeighbourTableGrowsAndIsReported) {
  // 40 balls on one plate: more neighbours than a table has at first.
  ThesisSolver solver;
  WorldBuilder world;
  world.def.bin.kind = Bin::Kind::none;
  const std::size_t plate = world.shape(block(16, 12, 1, 0.005, 0.01)), sphere = world.shape(ball(0.005));
  world.body(plate, Vec3::Zero(), Vec3::Zero(), 1.0);
  for (int i = 0; i < 40; ++i)
    world.body(sphere, Vec3(0.015 * (i % 8) - 0.055, 0.02 * (i / 8) - 0.045, 0.006), Vec3(0, 0, -0.1), 0.01);
  const WorldId id = world.add(solver);
  solver.advance({id}, 0.01);
  const std::vector<Flag> flags = solver.flags(id);
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].code, "neighbour_overflow");
  for (int i = 1; i <= 40; ++i)
    EXPECT_GT(solver.states(id)[i].velocity.linear.z(), -0.19) << "ball " << i << " fell on";
}

TEST(ThesisBatch, PrintsHash) {  // for the test below, in a process of its own
  if (!std::getenv("BIN_SCENES_TEST_PRINT_HASH")) GTEST_SKIP() << "runs inside another test";
  std::printf("hash %016llx\n", static_cast<unsigned long long>(settled_hash({}, 0)));
}

std::string hash_in_process(const std::string& environment) {
  const std::string command =
      environment + " BIN_SCENES_TEST_PRINT_HASH=1 /proc/self/exe --gtest_filter=ThesisBatch.PrintsHash";
  // /proc/self/exe inside the shell would be the shell: resolve it here.
  std::array<char, 4096> path{};
  const auto length = readlink("/proc/self/exe", path.data(), path.size() - 1);
  std::string resolved = command;
  resolved.replace(resolved.find("/proc/self/exe"), 14, "'" + std::string(path.data(), length) + "'");
  std::string out;
  FILE* pipe = popen(resolved.c_str(), "r");
  std::array<char, 256> line{};
  while (pipe && std::fgets(line.data(), line.size(), pipe))
    if (std::string(line.data()).rfind("hash ", 0) == 0) out = line.data();
  if (pipe) pclose(pipe);
  return out;
}

TEST(ThesisBatch, ThreadsOfTheDriverDoNotMatter) {
  const std::string without = hash_in_process("LP_NUM_THREADS=0");
  EXPECT_EQ(without.size(), 22u) << without;
  EXPECT_EQ(without, hash_in_process("LP_NUM_THREADS=2"));
}

TEST(ThesisBatch, TheGridHoldsTheWholeOfABinOfSpheres) {
  WorldBuilder builder;
  builder.def.bin.kind = Bin::Kind::mesh;
  builder.body(builder.shape(ball(0.01)), Vec3(0, 0, 0.03));
  World world = make_world(builder.def, builder.shapes, {});
  world.present = {true};
  world.states = {to_state(builder.starts[0], world.shapes[0])};
  world.bin_spheres = block(60, 40, 1, 0.01, 0.02);
  std::vector<BodyIndex> index;
  const gpu::ThesisWorld laid = lay_out({&world}, {}, {}, 0.01, index).worlds[0];
  EXPECT_GT(laid.grid.x, 50u);  // one cell for all that is far from the body would take 2400 * 2400 comparisons
  EXPECT_GT(laid.grid.y, 30u);
  EXPECT_LE(laid.origin.x, -0.59f);
  EXPECT_LE(laid.origin.y, -0.39f);
}

TEST(ThesisBatch, BodiesComeAndGo) {
  ThesisSolver solver;
  WorldBuilder world;
  world.floor();
  const std::size_t sphere = world.shape(ball(0.01));
  world.body(sphere, Vec3(0, 0, 0.01), Vec3::Zero(), 0.1);
  world.body(sphere, Vec3(0, 0, 0.0305), Vec3::Zero(), 0.1);
  const WorldId id = solver.add_world(make_world(world.def, world.shapes, {}));
  EXPECT_FALSE(solver.states(id)[0].pose.finite()) << "absent until inserted";
  EXPECT_EQ(solver.advance({id}, 0.02), 0.02);  // an empty world costs nothing
  EXPECT_EQ(solver.profile().counters.count("contacts"), 0u);

  solver.insert(id, 0, world.starts[0]);
  solver.insert(id, 1, world.starts[1]);
  solver.advance({id}, 0.1);
  EXPECT_GT(solver.states(id)[1].pose.position.z(), 0.028) << "held by the lower ball";
  solver.remove(id, 0);
  const BodyState gone = solver.states(id)[0];
  solver.advance({id}, 0.2);
  EXPECT_LT(solver.states(id)[1].pose.position.z(), 0.011) << "nothing holds it";
  EXPECT_EQ(hash_of({solver.states(id)[0]}), hash_of({gone})) << "an absent body keeps what it had";
  EXPECT_EQ(solver.steps(id), 32u);
}

TEST(ThesisBatch, FixedBodiesHoldOthersAndStay) {
  ThesisSolver solver;
  WorldBuilder world;
  world.def.bin.kind = Bin::Kind::none;
  const std::size_t plate = world.shape(block(5, 5, 1, 0.01, 0.01)), sphere = world.shape(ball(0.01));
  world.body(plate, Vec3::Zero(), Vec3::Zero(), 1.0, 0.5, 0.0, true);
  world.body(sphere, Vec3(0, 0, 0.03), Vec3::Zero(), 0.1);
  const WorldId id = world.add(solver);
  const std::vector<BodyState> before = solver.states(id);
  solver.advance({id}, 0.5);
  EXPECT_NEAR(solver.states(id)[1].pose.position.z(), 0.02, 0.02 * 0.01 + 1e-5);  // slop is 1 % of the radius
  EXPECT_EQ(hash_of({solver.states(id)[0]}), hash_of({before[0]}));
}

TEST(ThesisBatch, NothingLeaksThroughTheBox) {
  ThesisSolver solver(settings_with(1.0, 2));
  WorldBuilder world;
  world.def.bin.inner_size = Vec3(0.1, 0.1, 0.2);
  const std::size_t shape = world.shape(cube(3, 0.004));
  for (int i = 0; i < 8; ++i)
    world.body(shape, Vec3(0.03 * (i % 2) - 0.015, 0.03 * (i / 2 % 2) - 0.015, 0.03 + 0.03 * (i / 4)),
               Vec3(2.0 * (i % 3 - 1), 2.0 * ((i + 1) % 3 - 1), -2.0), 0.05);
  const WorldId id = world.add(solver, settings_with(1.0, 2));
  for (int k = 0; k < 10; ++k) {
    solver.advance({id}, 0.05);
    for (const BodyState& state : solver.states(id)) {
      EXPECT_LT(state.pose.position.cwiseAbs().head<2>().maxCoeff(), 0.05);
      EXPECT_GT(state.pose.position.z(), 0.0);
    }
  }
}

TEST(ThesisBatch, StatesAreOfTheModelFrame) {
  // A part whose origin lies far from its centre of mass, spinning about it: the origin circles, the centre stays.
  std::vector<Sphere> spheres = rod(3, 0.01);
  for (Sphere& sphere : spheres) sphere.center += Vec3(0.2, -0.1, 0.05);
  ThesisSolver solver;
  WorldBuilder world;
  world.nothing();
  world.body(world.shape(spheres), Vec3(0.3, 0.4, 0.5));
  world.starts[0].pose.orientation = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  world.starts[0].velocity.angular = world.starts[0].pose.orientation * Vec3(0, 0, M_PI);
  const WorldId id = world.add(solver);
  const BodyState begin = solver.states(id)[0];
  EXPECT_LT((begin.pose.position - world.starts[0].pose.position).norm(), 1e-7);
  EXPECT_LT(begin.pose.orientation.angularDistance(world.starts[0].pose.orientation), 1e-6);
  solver.advance({id}, 1.0);
  const BodyState half = solver.states(id)[0];  // half a turn
  const Vec3 center(0.2, -0.1, 0.05);
  EXPECT_LT((half.pose * center - world.starts[0].pose * center).norm(), 1e-6);
  EXPECT_LT((half.pose * (center + Vec3(0.02, 0, 0)) - world.starts[0].pose * (center - Vec3(0.02, 0, 0))).norm(),
            1e-5);
}

Mesh box_mesh(const Vec3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(Vec3(i & 1 ? size.x() : 0, i & 2 ? size.y() : 0, i & 4 ? size.z() : 0));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(ThesisBatch, PartModelsComeToRestInABinAndInABinOfSpheres) {
  ThesisSettings settings;
  settings.voxels = 4;
  WorldDef def;
  def.parts = {PartModel::from_mesh(box_mesh(Vec3(0.04, 0.03, 0.02)), "box")};
  def.bodies = {{0, 0.1, 0.5, 0.1, false}};
  def.bin.inner_size = Vec3(0.1, 0.1, 0.1);
  for (const Bin::Kind kind : {Bin::Kind::box, Bin::Kind::mesh}) {
    def.bin.kind = kind;
    if (kind == Bin::Kind::mesh) {  // a slab, its top at z = 0
      def.bin_model = PartModel::from_mesh(box_mesh(Vec3(0.1, 0.1, 0.02)), "slab");
      def.bin.pose.position = Vec3(-0.05, -0.05, -0.02);
    }
    ThesisSolver solver(settings);
    const WorldId id = solver.add_world(def);
    solver.insert(id, 0, {{Vec3(-0.02, -0.015, 0.01), Quat::Identity()}, {}});
    solver.advance({id}, 1.0);
    const BodyState state = solver.states(id)[0];
    // On the floor, at most a lattice hollow (0.59 radii of 5 mm) deep; the model's origin is its lower corner.
    EXPECT_NEAR(state.pose.position.z(), -0.0015, 0.0016) << "kind " << static_cast<int>(kind);
    EXPECT_LT(state.velocity.linear.norm(), 0.01);
    EXPECT_EQ(solver.name(), "sphere/thesis");
  }
}

}  // namespace
}  // namespace bin_scenes::thesis::test
