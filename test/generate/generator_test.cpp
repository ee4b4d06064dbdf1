#include "generator_fixture.hpp"

#include <algorithm>
#include <atomic>

namespace bin_scenes {
namespace {

// Sizes that agree in six decimals.
TEST_F(GeneratorTest, LinesOfNearlyTheSameScaleHaveTheirOwnSizes) {
  std::ofstream(dir / "box.stl") << box_stl(40000.0);
  Request request = boxes(1);
  request.parts.push_back(request.parts[0]);
  request.parts[0].scale = 1.0e-6;
  request.parts[1].scale = 1.4e-6;
  run(request);
  const double ratio = generator.loaded().parts[1]->diagonal() / generator.loaded().parts[0]->diagonal();
  EXPECT_NEAR(ratio, 1.4, 1e-6);
}

TEST_F(GeneratorTest, AFileThatChangedSinceTheRequestWasReadIsRefused) {
  Request request = boxes(1);
  request.parts[0].sha256 = std::string(64, '0');
  EXPECT_EQ(failure(request), ErrorKind::input);
}

// A list of their indices alone would take 8 GB.
TEST_F(GeneratorTest, AThousandMillionScenesTakeNoListAndEndWhenTheCallerSaysSo) {
  Request request = boxes(1);
  request.scenes = 1'000'000'000;
  std::atomic<bool> stop{false};
  Generator::Options options;
  options.hooks.cancel = &stop;
  options.hooks.progress = [&](const Progress& progress) { stop = progress.simulated_s > 0.0; };
  try {
    run(request, options);
    FAIL() << "ended by itself";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

TEST_F(GeneratorTest, AFixedFloorMayBeLargerThanTenMetres) {
  std::ofstream(dir / "floor.stl") << box_stl({14.0, 14.0, 0.5});
  Request request = boxes(1);
  request.bin.kind = Bin::Kind::none;
  request.pour.pattern = Pour::Pattern::given;
  request.parts[0].poses = {{Vec3(3.0, 2.0, 0.021), Quat::Identity()}};
  request.parts.push_back(request.parts[0]);
  PartLine& floor = request.parts[1];
  floor.path = (dir / "floor.stl").string();
  floor.poses = {{Vec3(0.0, 0.0, -0.25), Quat::Identity()}};
  floor.fixed = true;
  EXPECT_EQ(failure(request), ErrorKind::input) << "may be meant in another unit";
  floor.unit = Unit::metre;
  for (const SolverType type : {SolverType::bullet, SolverType::sphere}) {
    request.solver.type = type;
    const Scene scene = run(request).at(0).scene;
    EXPECT_TRUE(scene.report.at_rest) << name_of(type);
    EXPECT_NEAR(scene.parts[0].pose.position.z(), 0.02, 2e-4) << name_of(type);
  }
}

// Parts fell through such a bin, and all that the scene told was that they had escaped.
TEST_F(GeneratorTest, ABinOfSheetsWithoutThicknessIsRefusedWhereItWouldHoldNothing) {
  constexpr std::size_t but_one_side = 10;  // triangles: the side towards +x is open
  Request request = boxes(2);
  request.bin.kind = Bin::Kind::mesh;
  request.bin.unit = Unit::metre;
  request.bin.mesh = (dir / "bin.stl").string();
  request.bin.pose.orientation = Quat(Eigen::AngleAxisd(-M_PI / 2.0, Vec3::UnitY()));  // its open side up
  std::ofstream(request.bin.mesh) << box_stl(0.2, but_one_side);
  const Report report = run(request).at(0).scene.report;
  EXPECT_TRUE(report.accepted) << "by Bullet";
  ASSERT_EQ(report.flags.size(), 1u);
  EXPECT_EQ(report.flags[0].code, "surface_open");
  EXPECT_EQ(report.flags[0].text.rfind("bin: the surface is not closed", 0), 0u) << report.flags[0].text;
  EXPECT_EQ(report.flags[0].remedy.find("thickness"), std::string::npos) << report.flags[0].remedy;
  for (const SolverType type : {SolverType::sphere, SolverType::automatic}) {
    request.solver.type = type;
    EXPECT_EQ(failure(request), ErrorKind::input) << name_of(type);
  }
  // A slab without its lower face is no sheet: it has an inside.
  std::ofstream(request.bin.mesh) << box_stl({0.02, 0.2, 0.2}, but_one_side);
  request.bin.pose.orientation = Quat(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitY()));
  request.pour.pattern = Pour::Pattern::given;
  for (const double x : {-0.05, 0.05}) request.parts[0].poses.push_back({Vec3(x, 0, 0.031), Quat::Identity()});
  EXPECT_TRUE(run(request).at(0).scene.report.accepted);
}

// Thirty plates of a millimetre in a narrow bin. Where soft contacts let them sink by a tenth of that they end in each
// other.
TEST_F(GeneratorTest, ThinPartsOnEachOtherStayApart) {
  std::ofstream(dir / "box.stl") << box_stl({0.03, 0.02, 0.001});
  Request request = boxes(30);
  request.solver.type = SolverType::sphere;
  request.pour.finish = Pour::Finish::probed;
  request.bin.inner_size = Vec3(0.05, 0.04, 0.3);
  for (request.seed = 2; request.seed < 5; ++request.seed) {
    const Report report = run(request).at(0).scene.report;
    EXPECT_TRUE(report.at_rest) << request.seed;
    EXPECT_LT(report.penetration.max_relative, 1e-3) << request.seed;
  }
}

TEST_F(GeneratorTest, AHeapIsTheSceneThatIsGeneratedAndGoesOn) {
  Request request = boxes(6);
  request.solver.type = SolverType::sphere;
  request.drift_check = true;
  request.sensors.emplace_back();
  const Generator::Result scene = std::move(run(request).at(0));
  Heap heap = generator.heap(request);
  ASSERT_TRUE(heap.settle());
  const Generator::Result same = generator.result(heap, {});
  EXPECT_EQ(same.scene.report.state_hash, scene.scene.report.state_hash);
  EXPECT_EQ(same.scene.report.finish, scene.scene.report.finish);
  EXPECT_TRUE(same.scene.report.accepted);
  EXPECT_TRUE(same.scene.report.drift.measured);
  EXPECT_GT(same.images.at(0).visible.at(4), 0u);
  heap.remove({4});
  ASSERT_TRUE(heap.settle());
  const Generator::Result picked = generator.result(heap, {});
  EXPECT_TRUE(picked.scene.report.accepted);
  EXPECT_EQ(picked.scene.parts.at(4).state, PartState::removed);
  EXPECT_EQ(picked.images.at(0).visible.at(4), 0u);
}

TEST_F(GeneratorTest, DriftIsOfThePartsThatAreThere) {
  Request request = boxes(3);
  request.pour.pattern = Pour::Pattern::given;
  request.drift_check = true;
  for (const double x : {0.5, -0.05, 0.05}) request.parts[0].poses.push_back({Vec3(x, 0, 0.021), Quat::Identity()});
  const Report report = run(request).at(0).scene.report;  // the first stands beside the bin
  ASSERT_EQ(report.escaped, std::vector<int>{0});
  ASSERT_TRUE(report.drift.measured);
  EXPECT_LT(report.drift.max, 0.001);

  for (Pose& pose : request.parts[0].poses) pose.position.x() += 1.0;
  EXPECT_FALSE(run(request).at(0).scene.report.drift.measured) << "nobody is left to drift";
}

TEST_F(GeneratorTest, DriftGoesOnWithoutALineThatIsGone) {
  Request request = boxes(1);
  request.pour.pattern = Pour::Pattern::given;
  request.drift_check = true;
  request.parts.push_back(request.parts[0]);
  request.parts[0].poses = {Pose{Vec3(0.5, 0, 0.021), Quat::Identity()}};
  request.parts[1].poses = {Pose{Vec3(0.0, 0, 0.021), Quat::Identity()}};
  EXPECT_LT(run(request).at(0).scene.report.drift.max, 0.001);
}

TEST_F(GeneratorTest, PoursJudgesAndHandsOverInOrder) {
  Request request = boxes(4);
  request.scenes = 2;
  request.first = 5;
  const auto results = run(request);
  ASSERT_EQ(results.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Scene& scene = results[i].scene;
    EXPECT_EQ(scene.index, 5 + i);
    EXPECT_EQ(scene.seed, 3u);
    ASSERT_EQ(scene.parts.size(), 4u);
    EXPECT_TRUE(scene.report.accepted) << (scene.report.reasons.empty() ? "" : scene.report.reasons[0]);
    EXPECT_EQ(scene.report.solver, "bullet");
    EXPECT_FALSE(scene.report.solver_reason.empty());
    EXPECT_TRUE(results[i].images.empty()) << "no sensors, no images";
    for (const ScenePart& part : scene.parts) EXPECT_EQ(part.state, PartState::resting);
  }
  EXPECT_NE(results[0].scene.report.state_hash, results[1].scene.report.state_hash);
}

TEST_F(GeneratorTest, TheSameRequestGivesTheSameBitsAndASceneDoesNotDependOnItsNeighbours) {
  Request request = boxes(4);
  request.scenes = 2;
  const auto first = run(request);
  Generator other;
  std::vector<Scene> again;
  request.first = 1;
  request.scenes = 1;
  other.generate(request, {}, [&](Generator::Result&& result) { again.push_back(std::move(result.scene)); });
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].report.state_hash, first[1].scene.report.state_hash);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(again[0].parts[i].pose.position, first[1].scene.parts[i].pose.position);
    EXPECT_EQ(again[0].parts[i].pose.orientation.coeffs(), first[1].scene.parts[i].pose.orientation.coeffs());
  }
}

TEST_F(GeneratorTest, TheNextSceneTakesThePlaceOfOneThatRests) {
  Request request = boxes(6);
  request.solver.type = SolverType::sphere;
  request.solver.sphere.device = SphereSettings::Device::gpu;  // llvmpipe: four at once
  request.scenes = 8;
  std::vector<std::size_t> poured;  // scenes in hand, look after look
  Generator::Options options;
  options.hooks.progress = [&](const Progress& p) {
    if (p.simulated_s > 0) poured.push_back(p.scene);
  };
  const auto results = run(request, options);
  ASSERT_EQ(results.size(), 8u);
  for (std::size_t i = 0; i < results.size(); ++i) EXPECT_EQ(results[i].scene.index, i);
  const auto fifth = std::find(poured.begin(), poured.end(), 4u);
  EXPECT_TRUE(std::any_of(fifth, poured.end(), [](std::size_t scene) { return scene < 4; }))
      << "it waited until all of the first four were at rest";
  request.scenes = 1;
  for (const std::size_t index : {0, 4, 7}) {
    request.first = index;
    EXPECT_EQ(run(request).at(0).scene.report.state_hash, results[index].scene.report.state_hash) << index;
  }
}

TEST_F(GeneratorTest, KeepsAModelUntilItsFileChanges) {
  run(boxes(1));
  const PartModelPtr once = generator.loaded().parts.at(0);
  run(boxes(1));
  EXPECT_EQ(generator.loaded().parts.at(0), once);
  std::ofstream(dir / "box.stl") << box_stl(0.0401);
  run(boxes(1));
  EXPECT_NE(generator.loaded().parts.at(0), once);
}

TEST_F(GeneratorTest, ProgressNeverFallsAndNamesKnownPhases) {
  Request request = boxes(3);
  request.scenes = 2;
  std::vector<Progress> seen;
  Generator::Options options;
  options.hooks.progress = [&](const Progress& progress) { seen.push_back(progress); };
  run(request, options);
  ASSERT_GT(seen.size(), 5u);
  EXPECT_EQ(seen.front().phase, "load");
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i].fraction, seen[i - 1].fraction);
  EXPECT_GT(seen.back().fraction, 0.9);
  EXPECT_LE(seen.back().fraction, 1.0);
}

TEST_F(GeneratorTest, CanBeCancelledAndUsedAgain) {
  std::atomic<bool> cancel{true};
  Generator::Options options;
  options.hooks.cancel = &cancel;
  try {
    run(boxes(3), options);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
  cancel = false;
  EXPECT_EQ(run(boxes(1), options).size(), 1u);
}

TEST_F(GeneratorTest, RendersOnlyWhenSomebodyLooks) {
  Request request = boxes(2);
  request.sensors.emplace_back();
  request.sensors[0].width = 64;
  request.sensors[0].height = 48;
  Generator::Options blind;
  blind.render = false;
  const auto unseen = run(request, blind);
  EXPECT_TRUE(unseen.at(0).images.empty());
  EXPECT_EQ(unseen[0].scene.report.profile.stages_ms.count("render"), 0u);
  ASSERT_EQ(unseen[0].scene.sensors.size(), 1u);
  EXPECT_EQ(unseen[0].scene.sensors[0].k.size(), 9u) << "where the camera would be is known all the same";

  const auto seen = run(request);
  ASSERT_EQ(seen.at(0).images.size(), 1u);
  EXPECT_EQ(seen[0].images[0].depth.size(), 64u * 48u);
  EXPECT_EQ(seen[0].scene.report.state_hash, unseen[0].scene.report.state_hash);
  for (const ScenePart& part : seen[0].scene.parts) {
    EXPECT_GT(part.visible_fraction.at("camera"), 0.0);
    EXPECT_LE(part.visible_fraction.at("camera"), 1.0);
  }
}

TEST_F(GeneratorTest, ASensorThatCannotSeeIsRefusedBeforeAnythingIsPoured) {
  Request request = boxes(2);
  request.sensors.emplace_back();
  request.sensors[0].pose = Pose{Vec3(0, 0, 1), Quat::Identity()};  // looks up
  Generator::Options options;
  bool poured = false;
  options.hooks.progress = [&](const Progress& progress) { poured |= progress.simulated_s > 0.0; };
  EXPECT_THROW(run(request, options), Error);
  EXPECT_FALSE(poured);
}

TEST_F(GeneratorTest, FixedPartsAreSeenLikeOthers) {
  Request request = boxes(1);
  request.parts[0].fixed = true;
  request.parts[0].poses = {{Vec3(0, 0, 0.05), Quat::Identity()}};
  request.sensors.emplace_back();
  request.sensors[0].width = 64;
  request.sensors[0].height = 48;
  const auto results = run(request);
  EXPECT_EQ(results.at(0).scene.parts.at(0).visible_fraction.at("camera"), 1.0);
  EXPECT_EQ(results[0].images.at(0).label[24 * 64 + 32], 1);
}

TEST_F(GeneratorTest, DriftIsMeasuredOnlyWhenAskedFor) {
  Request request = boxes(2);
  EXPECT_FALSE(run(request).at(0).scene.report.drift.measured);
  request.drift_check = true;
  const auto results = run(request);
  EXPECT_TRUE(results.at(0).scene.report.drift.measured);
  EXPECT_LT(results[0].scene.report.drift.max, 0.001);
}

TEST_F(GeneratorTest, BadInputIsAnInputErrorBeforeAnythingIsSimulated) {
  Request absent = boxes(1);
  absent.parts[0].path = (dir / "nowhere.stl").string();
  EXPECT_EQ(failure(absent), ErrorKind::input);
  Request huge = boxes(1000000);
  huge.memory_budget = 1e6;
  EXPECT_EQ(failure(huge), ErrorKind::input);
  Request negative = boxes(1);
  negative.parts[0].friction = -1;
  EXPECT_EQ(failure(negative), ErrorKind::input);
  Request unit = boxes(1);
  unit.parts[0].scale = 1000;  // a box of 40 m
  EXPECT_EQ(failure(unit), ErrorKind::input);
}

}  // namespace
}  // namespace bin_scenes
