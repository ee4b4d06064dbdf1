#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace bin_scenes {
namespace {

Request request(std::size_t count) {
  Request r;
  r.parts.emplace_back();
  r.parts[0].model = "box";
  r.parts[0].count = count;
  return r;
}

TEST(Memory, GrowsWithPartsPixelsAndSettings) {
  const double none = estimate_memory(request(0), {}), few = estimate_memory(request(100), {});
  EXPECT_GT(few, none + 1e5);
  EXPECT_NEAR(estimate_memory(request(200), {}) - few, few - none, 1e-6 * few);
  Request seen = request(100);
  seen.sensors.emplace_back();
  EXPECT_GT(estimate_memory(seen, {}), few + 640 * 480 * 20.0);
  const PartModelPtr box = PartModel::from_mesh(box_mesh(0.05), "box");
  const double with_model = estimate_memory(request(100), {box});
  EXPECT_GT(with_model, few);
  EXPECT_EQ(estimate_memory(request(100), {box, box}), with_model) << "a shared model counts once";
}

TEST(Memory, ScenesAreSeenAtOnceAsFarAsTheirImagesFit) {
  Request seen = request(10);
  seen.sensors.emplace_back();
  const double one = estimate_memory(seen, {}), images = one - estimate_memory(request(10), {});
  seen.memory_budget = one;
  EXPECT_EQ(scenes_seen_at_once(seen, one), 1u);
  seen.memory_budget = one + 2.5 * images;
  EXPECT_EQ(scenes_seen_at_once(seen, one), 3u);
}

TEST(Memory, GrowsWithScenesThatWaitToBeJudgedButNotWithoutBound) {
  Request one = request(100), ten = one, many = one;
  ten.scenes = 10;
  many.scenes = 200'000'000;
  EXPECT_GT(estimate_memory(ten, {}), estimate_memory(one, {}));
  EXPECT_LT(estimate_memory(many, {}), 20.0 * estimate_memory(one, {})) << "scenes are made one after the other";
  ten.memory_budget = 0.5 * (estimate_memory(one, {}) + estimate_memory(ten, {}));
  EXPECT_THROW(estimate_memory(ten, {}), Error);
}

/// Bullet keeps contacts by pairs of hulls: a heap of concave parts takes far more than one of boxes.
TEST(Memory, CountsHulls) {
  const auto grows_by = [](const PartModelPtr& part) {
    Request some = request(100), more = request(200);
    some.solver.type = more.solver.type = SolverType::bullet;
    return estimate_memory(more, {part}) - estimate_memory(some, {part});
  };
  const char* models = std::getenv("BIN_SCENES_MODELS");
  if (!models) GTEST_SKIP() << "BIN_SCENES_MODELS is not set";
  LoadOptions load;
  load.unit = Unit::millimetre;
  EXPECT_GT(grows_by(PartModel::load(std::string(models) + "/channel_u.stl", load)),
            2.0 * grows_by(PartModel::from_mesh(box_mesh(0.05), "box")));
}

// A field has (diagonal / cell)^3 nodes: of many models each is a little coarser, before the request is refused.
TEST(Memory, FieldsOfManyModelsAreAsFineAsFits) {
  std::vector<PartModelPtr> boxes;
  Request r;
  for (int i = 0; i < 60; ++i) {
    boxes.push_back(PartModel::from_mesh(box_mesh(0.05 + 1e-4 * i), "box"));
    r.parts.push_back(request(1).parts[0]);
  }
  r.memory_budget = 4e9;
  const double full = estimate_memory(r, boxes), asked = r.solver.sphere.field_cell;
  EXPECT_EQ(field_cell_that_fits(r, boxes), asked);
  r.memory_budget = 0.5 * full;
  const double cell = field_cell_that_fits(r, boxes);
  EXPECT_GT(cell, 1.2 * asked);
  EXPECT_LT(cell, 1.4 * asked);
  EXPECT_LE(estimate_memory(r, boxes), r.memory_budget);
  EXPECT_GT(estimate_memory(r, boxes), 0.9 * r.memory_budget);
  r.memory_budget = 0.1 * full;
  EXPECT_EQ(field_cell_that_fits(r, boxes), 2 * asked);
  EXPECT_THROW(estimate_memory(r, boxes), Error);
  r.solver.type = SolverType::bullet;
  EXPECT_EQ(field_cell_that_fits(r, {}), asked);
}

// 20,000 parts in one place are a request of 400 kB and took 14 GB.
TEST(Memory, CountsPartsThatStartWithinEachOther) {
  const PartModelPtr box = PartModel::from_mesh(box_mesh(0.04), "box");
  Request r = request(20000);
  r.pour.pattern = Pour::Pattern::given;
  for (int i = 0; i < 20000; ++i)
    r.parts[0].poses.push_back({Vec3(1e-4 * (i % 100), 1e-4 * (i / 100), 0.1), Quat::Identity()});
  for (const SolverType type : {SolverType::sphere, SolverType::bullet}) {
    r.solver.type = type;
    try {
      estimate_memory(r, {box});
      ADD_FAILURE() << name_of(type);
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find("start within each other"), std::string::npos) << error.what();
      EXPECT_EQ(error.remedy(), "move the start poses apart");
    }
  }
  for (std::size_t i = 0; i < r.parts[0].poses.size(); ++i) {
    const double k = static_cast<double>(i);
    r.parts[0].poses[i].position = Vec3(0.041 * std::fmod(k, 100.0), 0.041 * std::floor(k / 100.0), 0.1);
  }
  EXPECT_LT(estimate_memory(r, {box}), r.memory_budget);
}

TEST(Memory, AboveTheBudgetIsRefusedWithTheFigure) {
  Request r = request(900000);
  r.memory_budget = 1e9;
  try {
    estimate_memory(r, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.where(), "memory_budget");
    EXPECT_NE(error.problem().find("1000 MB"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace bin_scenes
