/// A heap that outlives its scene: parts are taken out and added, gravity turns, and it settles again.
#include "bin_scenes/pour/heap.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/fixture.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <algorithm>
#include <atomic>

namespace bin_scenes::testing {

namespace {

const PartModelPtr& cube() {
  static const PartModelPtr part = PartModel::from_mesh(box_mesh({0.02, 0.02, 0.02}), "cube");
  return part;
}
const PartModelPtr& angle() {
  static const PartModelPtr part = PartModel::from_mesh(
      merged(box_mesh({0.06, 0.02, 0.02}), box_mesh({0.02, 0.04, 0.02}, {0.02, 0.03, 0})), "angle");
  return part;
}

PartLine line_of(const PartModelPtr& part, std::size_t count) {
  PartLine line;
  line.model = part->path();
  line.count = count;
  return line;
}

struct Kind {
  const char* name;
  SolverType type;
  SphereSettings::Device device;
};

Heap heap_of(const Kind& kind, const std::vector<PartLine>& lines, const std::vector<PartModelPtr>& parts) {
  Request request;
  request.seed = 3;
  request.solver.type = kind.type;
  request.solver.sphere.device = kind.device;
  request.bin.inner_size = Vec3(0.30, 0.30, 0.12);
  request.pour.finish = Pour::Finish::pressed;
  request.parts = lines;
  if (!lines[0].poses.empty()) request.pour.pattern = Pour::Pattern::given;
  std::string reason;
  return Heap({request, parts}, make_solver({request, parts}, reason));
}
Heap heap_of(const Kind& kind, const PartModelPtr& part, std::size_t count, const std::vector<Pose>& poses = {}) {
  PartLine line = line_of(part, count);
  line.poses = poses;
  return heap_of(kind, {line}, {part});
}

/// Cubes on each other, at the given places.
std::vector<Pose> towers(const std::vector<double>& places, int height) {
  std::vector<Pose> poses;
  for (const double x : places)
    for (int level = 0; level < height; ++level) poses.push_back({Vec3(x, 0, 0.01 + 0.02 * level), Quat::Identity()});
  return poses;
}

bool same_bits(const Pose& a, const Pose& b) {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

double height(const Scene& scene, int id) {
  return scene.parts.at(static_cast<std::size_t>(id)).pose.position.z();
}

class HeapTest : public ::testing::TestWithParam<Kind> {};
using Device = SphereSettings::Device;
INSTANTIATE_TEST_SUITE_P(Solvers, HeapTest,
                         ::testing::Values(Kind{"sphere", SolverType::sphere, Device::cpu},
                                           Kind{"sphere_gl", SolverType::sphere, Device::gpu},
                                           Kind{"bullet", SolverType::bullet, Device::automatic}),
                         [](const auto& info) { return info.param.name; });

TEST_P(HeapTest, APickMovesWhatThePartCarriedAndNothingElse) {
  Heap heap = heap_of(GetParam(), cube(), 6, towers({-0.05, 0.05}, 3));
  ASSERT_TRUE(heap.settle());
  const Scene before = heap.scene();
  heap.remove({0});
  ASSERT_TRUE(heap.settle());
  const Scene after = heap.scene();
  EXPECT_TRUE(after.report.at_rest);
  EXPECT_EQ(after.parts[0].state, PartState::removed);
  EXPECT_FALSE(after.parts[0].pose.finite());
  for (const int id : {1, 2}) EXPECT_NEAR(height(after, id), height(before, id) - 0.02, 2e-4) << id;
  for (const int id : {3, 4, 5}) EXPECT_TRUE(same_bits(after.parts[id].pose, before.parts[id].pose)) << id;
  EXPECT_LT(after.report.simulated_s, 2.0) << "the clock of this settle";
  EXPECT_TRUE(after.report.worst.penetration.known);
  EXPECT_GT(after.report.worst.penetration.value, 0.0);
  EXPECT_LT(after.report.worst.penetration.relative, 0.02);
}

/// The GPU form holds so many bodies in a scene: what is refused leaves the heap as it was.
TEST(HeapOnTheGpu, RefusesMorePartsThanItHoldsAndGoesOn) {
  Request request;
  request.seed = 3;
  request.bin.inner_size = Vec3(0.30, 0.30, 0.12);
  PartLine line = line_of(cube(), 2);
  line.poses = towers({0.0}, 2);
  request.parts = {line};
  request.pour.pattern = Pour::Pattern::given;
  sphere_gl::Capacity capacity;
  capacity.group_bodies = 3;
  Heap heap({request, {cube()}}, make_gl_sphere_solver({}, capacity));
  ASSERT_TRUE(heap.settle());
  EXPECT_THROW(heap.add({{line_of(cube(), 2), cube()}}), Error);
  EXPECT_EQ(heap.scene().parts.size(), 2u);
  EXPECT_EQ(heap.add({{line_of(cube(), 1), cube()}}), std::vector<int>{2});
  ASSERT_TRUE(heap.settle());
  EXPECT_NEAR(height(heap.scene(), 1), 0.03, 2e-4);
}

TEST_P(HeapTest, WhatLayOnAFixedPartFallsWhenThatIsTakenOut) {
  PartLine shelf = line_of(cube(), 1), on_it = line_of(cube(), 1);
  shelf.fixed = true;
  shelf.poses = {{Vec3(0, 0, 0.05), Quat::Identity()}};
  on_it.poses = {{Vec3(0, 0, 0.07), Quat::Identity()}};
  Heap heap = heap_of(GetParam(), {shelf, on_it}, {cube(), cube()});
  ASSERT_TRUE(heap.settle());
  ASSERT_NEAR(height(heap.scene(), 1), 0.07, 2e-4);
  EXPECT_THROW(heap.lift({0}, Vec3::UnitZ(), 0.03), Error) << "a gripper does not move it";
  heap.remove({0});
  ASSERT_TRUE(heap.settle());
  EXPECT_NEAR(height(heap.scene(), 1), 0.01, 2e-4);
}

TEST_P(HeapTest, OfAPouredHeapMostPartsKeepTheirPosesInAPick) {
  Heap heap = heap_of(GetParam(), angle(), 12);
  ASSERT_TRUE(heap.settle());
  const Scene before = heap.scene();
  std::size_t top = 0;
  for (std::size_t i = 0; i < 12; ++i)
    if (before.parts[i].pose.position.z() > before.parts[top].pose.position.z()) top = i;
  heap.remove({static_cast<int>(top)});
  ASSERT_TRUE(heap.settle());
  const Scene after = heap.scene();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < 12; ++i) kept += same_bits(after.parts[i].pose, before.parts[i].pose);
  EXPECT_GE(kept, 6u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(after.parts[i].id, static_cast<int>(i));
}

TEST_P(HeapTest, IdsLastAsPartsAreTakenOutAndAdded) {
  Heap heap = heap_of(GetParam(), cube(), 4);
  ASSERT_TRUE(heap.settle());
  heap.remove({1, 2});
  EXPECT_EQ(heap.add({{line_of(angle(), 2), angle()}}), (std::vector<int>{4, 5}));
  ASSERT_TRUE(heap.settle());
  const Scene scene = heap.scene();
  ASSERT_EQ(scene.parts.size(), 6u);
  for (int id = 0; id < 6; ++id) {
    const ScenePart& part = scene.parts[static_cast<std::size_t>(id)];
    EXPECT_EQ(part.id, id);
    EXPECT_EQ(part.state, id == 1 || id == 2 ? PartState::removed : PartState::resting) << id;
    EXPECT_EQ(part.model, id < 4 ? "cube" : "angle");
  }
  EXPECT_EQ(heap.request().part_count(), 6u);
  EXPECT_EQ(heap.add({{line_of(cube(), 1), cube()}}), std::vector<int>{6});
  for (const int id : {1, 7, -1}) EXPECT_THROW(heap.remove({0, id}), Error) << id;
  ASSERT_TRUE(heap.settle());
  EXPECT_EQ(heap.scene().parts[0].state, PartState::resting) << "an error changes nothing";
}

TEST_P(HeapTest, WhatIsAddedComesToLieOnTheHeap) {
  Heap heap = heap_of(GetParam(), angle(), 4);
  ASSERT_TRUE(heap.settle());
  heap.add({{line_of(angle(), 4), angle()}});
  ASSERT_TRUE(heap.settle());
  const Scene scene = heap.scene();
  EXPECT_TRUE(scene.report.at_rest);
  EXPECT_TRUE(scene.report.escaped.empty());
  EXPECT_TRUE(scene.report.not_poured.empty());
  for (const ScenePart& part : scene.parts) EXPECT_GT(part.pose.position.z(), 0.005) << part.id;
}

TEST_P(HeapTest, PartsSlideWhenGravityTilts) {
  Heap heap = heap_of(GetParam(), cube(), 2, towers({-0.02, 0.02}, 1));
  ASSERT_TRUE(heap.settle());
  const auto x_after = [&](double angle) {
    heap.set_gravity(9.81 * Vec3(std::sin(angle), 0, -std::cos(angle)));
    EXPECT_TRUE(heap.settle());
    return heap.scene().parts[1].pose.position.x();
  };
  EXPECT_NEAR(x_after(0.3), 0.02, 1e-3) << "friction holds up to 0.46";
  EXPECT_NEAR(x_after(0.6), 0.14, 1e-3) << "at the wall";
}

TEST_P(HeapTest, ACancelledSettleLeavesAHeapThatSettles) {
  Heap heap = heap_of(GetParam(), cube(), 3);
  std::atomic<bool> cancel{false};
  RunHooks hooks;
  hooks.cancel = &cancel;
  hooks.progress = [&](const Progress& progress) { cancel = progress.simulated_s > 0.05; };
  EXPECT_THROW(heap.settle(hooks), Error);
  EXPECT_FALSE(heap.scene().report.at_rest);
  heap.remove({0});
  EXPECT_TRUE(heap.settle());
  const Scene scene = heap.scene();
  EXPECT_EQ(scene.parts[0].state, PartState::removed);
  for (const int id : {1, 2}) EXPECT_EQ(scene.parts[id].state, PartState::resting) << id;
  EXPECT_TRUE(heap.settle());
  EXPECT_TRUE(same_bits(heap.scene().parts[1].pose, scene.parts[1].pose)) << "what rests is left alone";
}

TEST_P(HeapTest, IsEmptiedPartByPart) {
  Heap heap = heap_of(GetParam(), cube(), 5);
  ASSERT_TRUE(heap.settle());
  for (int id = 0; id < 5; ++id) {
    heap.remove({id});
    ASSERT_TRUE(heap.settle()) << id;
    const Scene scene = heap.scene();
    for (int other = id + 1; other < 5; ++other) EXPECT_EQ(scene.parts[other].state, PartState::resting) << other;
  }
}

TEST_P(HeapTest, ALiftDragsWhatHangsInThePartAndNothingElse) {
  Heap heap = heap_of(GetParam(), cube(), 4, towers({-0.05, 0.05}, 2));
  ASSERT_TRUE(heap.settle());
  const Scene before = heap.scene();
  heap.lift({0}, Vec3(0, 0, 2), 0.05);
  const Scene lifted = heap.scene();
  EXPECT_NEAR(height(lifted, 0), height(before, 0) + 0.05, 2e-3);
  EXPECT_NEAR(height(lifted, 1), height(before, 1) + 0.05, 5e-3) << "what lies on it rises with it";
  for (const int id : {2, 3}) EXPECT_TRUE(same_bits(lifted.parts[id].pose, before.parts[id].pose)) << id;
  heap.remove({0});
  ASSERT_TRUE(heap.settle());
  EXPECT_NEAR(height(heap.scene(), 1), 0.01, 5e-4) << "and falls when it is gone";
  for (const int id : {2, 3}) EXPECT_TRUE(same_bits(heap.scene().parts[id].pose, before.parts[id].pose)) << id;
  EXPECT_THROW(heap.lift({0}, Vec3::UnitZ(), 0.05), Error) << "it is not there";
  EXPECT_THROW(heap.lift({1}, Vec3::Zero(), 0.05), Error);
  EXPECT_THROW(heap.lift({1}, Vec3::UnitZ(), 1e3), Error);
}

TEST_P(HeapTest, ALiftCarriesAllThatLiesOnThePart) {
  Heap heap = heap_of(GetParam(), cube(), 4, towers({0}, 4));
  ASSERT_TRUE(heap.settle());
  const Scene before = heap.scene();
  heap.lift({0}, Vec3::UnitZ(), 0.03);
  for (const int id : {0, 1, 2, 3})
    EXPECT_NEAR(height(heap.scene(), id), height(before, id) + 0.03, 3e-4) << "each, with three times its load: " << id;
}

TEST_P(HeapTest, ALiftIsNoEnergyFromNowhere) {
  static const PartModelPtr small = PartModel::from_mesh(box_mesh({1e-3, 1e-3, 1e-3}), "small");
  Heap heap =
      heap_of(GetParam(), small, 2, {{Vec3(0, 0, 5e-4), Quat::Identity()}, {Vec3(0, 0, 1.5e-3), Quat::Identity()}});
  ASSERT_TRUE(heap.settle());
  heap.lift({0}, Vec3::UnitZ(), 2e-3);
  const Report report = heap.scene().report;
  EXPECT_EQ(report.energy.gain, 0.0);
  EXPECT_EQ(report.energy.thrown.ratio, 0.0);
}

TEST_P(HeapTest, ALiftLeavesTheBitsOfWhatItDoesNotTouch) {
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  Heap heap = heap_of(GetParam(), angle(), 2, {{Vec3(-0.08, 0, 0.01), turned}, {Vec3(0.08, 0, 0.01), turned}});
  ASSERT_TRUE(heap.settle());
  const Scene before = heap.scene();
  heap.lift({0}, Vec3::UnitZ(), 0.05);
  EXPECT_TRUE(same_bits(heap.scene().parts[1].pose, before.parts[1].pose));
  ASSERT_TRUE(heap.settle());
  EXPECT_TRUE(same_bits(heap.scene().parts[1].pose, before.parts[1].pose));
  EXPECT_NEAR(height(heap.scene(), 0), 0.01, 3e-4) << "it has fallen again";
}

TEST_P(HeapTest, AfterALiftWhatSleptThroughItStillPressesAndFalls) {
  Heap heap = heap_of(GetParam(), cube(), 4, towers({-0.05, 0.05}, 2));
  ASSERT_TRUE(heap.settle());
  const auto pressing = [](const Scene& scene, int a, int b) {
    return std::any_of(scene.contacts.begin(), scene.contacts.end(),
                       [&](const SceneContact& c) { return c.a == a && c.b == b; });
  };
  ASSERT_TRUE(pressing(heap.scene(), 2, 3) && pressing(heap.scene(), 2, -1));
  heap.lift({0}, Vec3::UnitZ(), 0.05);
  heap.remove({0});
  ASSERT_TRUE(heap.settle());
  EXPECT_TRUE(pressing(heap.scene(), 2, 3) && pressing(heap.scene(), 2, -1));
  heap.remove({2});
  ASSERT_TRUE(heap.settle());
  EXPECT_NEAR(height(heap.scene(), 3), 0.01, 2e-4);
}

}  // namespace
}  // namespace bin_scenes::testing
