#include "bin_scenes/core/error.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "box_mesh.hpp"

#include <gtest/gtest.h>

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
  const double few = estimate_memory(request(100), {});
  EXPECT_GT(few, 1e5);
  EXPECT_NEAR(estimate_memory(request(200), {}), 2 * few, 1e-6 * few);
  Request seen = request(100);
  seen.sensors.emplace_back();
  EXPECT_GT(estimate_memory(seen, {}), few + 640 * 480 * 20.0);
  const PartModelPtr box = PartModel::from_mesh(box_mesh(0.05), "box");
  const double with_model = estimate_memory(request(100), {box});
  EXPECT_GT(with_model, few);
  EXPECT_EQ(estimate_memory(request(100), {box, box}), with_model) << "a shared model counts once";
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
