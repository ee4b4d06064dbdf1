#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "bin_scenes/pour/heap.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/solver/solver.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
  const double none = estimate_memory({request(0)}), few = estimate_memory({request(100)});
  EXPECT_GT(few, none + 1e5);
  EXPECT_NEAR(estimate_memory({request(200)}) - few, few - none, 1e-6 * few);
  Request seen = request(100);
  seen.sensors.emplace_back();
  EXPECT_GT(estimate_memory({seen}), few + 640 * 480 * 20.0);
  Request image = seen;
  image.sensors[0].model = "image";
  const double plain = estimate_memory({image});
  image.sensors[0].settings.of<ImageSettings>().denoise = true;
  EXPECT_GT(estimate_memory({image}), plain + 640 * 480 * 80.0);
  const PartModelPtr box = PartModel::from_mesh(box_mesh(0.05), "box");
  const double with_model = estimate_memory({request(100), {box}});
  EXPECT_GT(with_model, few);
  EXPECT_EQ(estimate_memory({request(100), {box, box}}), with_model) << "a shared model counts once";
}

TEST(Memory, ScenesAreSeenAtOnceAsFarAsTheirImagesFit) {
  Request seen = request(10);
  seen.sensors.emplace_back();
  const double one = estimate_memory({seen}), images = one - estimate_memory({request(10)});
  seen.memory_budget = one;
  EXPECT_EQ(scenes_seen_at_once(seen, one), 1u);
  seen.memory_budget = one + 2.5 * images;
  EXPECT_EQ(scenes_seen_at_once(seen, one), 3u);
}

TEST(Memory, GrowsWithScenesThatWaitToBeJudgedButNotWithoutBound) {
  Request one = request(100), ten = one, many = one;
  ten.scenes = 10;
  many.scenes = 200'000'000;
  EXPECT_GT(estimate_memory({ten}), estimate_memory({one}));
  EXPECT_LT(estimate_memory({many}), 20.0 * estimate_memory({one})) << "scenes are made one after the other";
  ten.memory_budget = 0.5 * (estimate_memory({one}) + estimate_memory({ten}));
  EXPECT_THROW(estimate_memory({ten}), Error);
}

/// Bullet keeps contacts by pairs of hulls: a heap of concave parts takes far more than one of boxes.
TEST(Memory, CountsHulls) {
  const auto grows_by = [](const PartModelPtr& part) {
    Request some = request(100), more = request(200);
    some.solver.type = more.solver.type = SolverType::bullet;
    return estimate_memory({more, {part}}) - estimate_memory({some, {part}});
  };
  const char* models = std::getenv("BIN_SCENES_MODELS");
  if (!models) GTEST_SKIP() << "BIN_SCENES_MODELS is not set";
  LoadOptions load;
  load.unit = Unit::millimetre;
  EXPECT_GT(grows_by(PartModel::load(std::string(models) + "/channel_u.stl", load)),
            2.0 * grows_by(PartModel::from_mesh(box_mesh(0.05), "box")));
}

// Of many models each has a coarser field, before the request is refused; by nothing but their number and the budget.
TEST(Memory, FieldsOfManyModelsShareHalfOfTheBudget) {
  std::vector<PartModelPtr> boxes;
  Request r;
  for (int i = 0; i < 60; ++i) {
    boxes.push_back(PartModel::from_mesh(box_mesh(0.05 + 1e-4 * i), "box"));
    r.parts.push_back(request(1).parts[0]);
  }
  const double full = estimate_memory({r, boxes});
  const std::size_t most = field_nodes_that_fit({r, boxes});
  EXPECT_GT(most, 8'000'000u);
  r.memory_budget = 0.5 * full;
  const std::size_t nodes = field_nodes_that_fit({r, boxes});
  EXPECT_NEAR(static_cast<double>(nodes * boxes.size() * sizeof(float)), 0.5 * r.memory_budget, 1e-4 * full);
  EXPECT_LE(estimate_memory({r, boxes}), r.memory_budget);
  boxes.resize(120, boxes[0]);
  r.parts.resize(120, r.parts[0]);
  r.scenes = 1000;
  EXPECT_EQ(field_nodes_that_fit({r, boxes}), nodes) << "the same model again, and more scenes, change nothing";
  r.memory_budget = 0.02 * full;
  EXPECT_THROW(estimate_memory({r, boxes}), Error);
}

TEST(Memory, ACoarserFieldIsTold) {
  std::vector<PartModelPtr> boxes;
  Request r;
  r.memory_budget = 3e8;
  r.seconds = 0.01;
  const std::string path = "memory_test_box";
  for (int i = 0; i < 20; ++i) {
    boxes.push_back(PartModel::from_mesh(box_mesh(0.05 + 1e-4 * i), path));
    r.parts.push_back(request(1).parts[0]);
  }
  std::string reason;
  const Heap heap({r, boxes}, make_solver({r, boxes}, reason));
  const auto flags = heap.scene().report.flags;
  const auto coarsened = [](const Flag& flag) { return flag.code == "field_coarsened"; };
  ASSERT_EQ(std::count_if(flags.begin(), flags.end(), coarsened), 1);
  const Flag& told = *std::find_if(flags.begin(), flags.end(), coarsened);
  EXPECT_NE(told.text.find("19 more parts"), std::string::npos) << told.text;
  EXPECT_NE(told.remedy.find("memory_budget"), std::string::npos) << told.remedy;
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
      estimate_memory({r, {box}});
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
  EXPECT_LT(estimate_memory({r, {box}}), r.memory_budget);
}

TEST(Memory, AboveTheBudgetIsRefusedWithTheFigure) {
  Request r = request(900000);
  r.memory_budget = 1e9;
  try {
    estimate_memory({r});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.where(), "memory_budget");
    EXPECT_NE(error.problem().find("1000 MB"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace bin_scenes
