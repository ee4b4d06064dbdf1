/// Distributions of a plan: bounds, shares, and values that depend on (seed, heap, attempt) alone.
#include "bin_scenes/config/plan.hpp"
#include "config/config_fixture.hpp"

#include <map>

namespace bin_scenes {
namespace {

class PlanTest : public ConfigTest {
 protected:
  Plan plan(const std::string& draws, const std::string& more = "") {
    return read_plan(put("plan.yaml",
                         "seed: 3\nscenes: 1000\nrequest:\n  parts: [{model: bolt.stl, count: 5}, "
                         "{model: nut.stl, count: 7}]\ndraw:\n" +
                             draws + more));
  }
  static double volume(const PartLine&) { return 1e-5; }
};

TEST_F(PlanTest, DrawsAreWithinBoundsAndAsOftenAsAsked) {
  const Plan p = plan(
      "  parts[0].friction: {uniform: [0.2, 0.4]}\n  parts[0].count: {uniform: [3, 5]}\n"
      "  parts[1].friction: {normal: [0.5, 0.2], min: 0.4, max: 0.6}\n"
      "  pour.finish: {choice: [settled, pressed], weights: [3, 1]}\n  bin.inner_size: {choice: [[0.2, 0.2, 0.1]]}\n");
  std::map<std::size_t, int> counts;
  int settled = 0;
  double sum = 0.0;
  for (std::size_t heap = 0; heap < 1000; ++heap) {
    const Request r = p.request(heap, 0, volume);
    ASSERT_TRUE(r.parts[0].friction >= 0.2 && r.parts[0].friction < 0.4);
    ASSERT_TRUE(r.parts[1].friction >= 0.4 && r.parts[1].friction <= 0.6);
    ++counts[r.parts[0].count];
    settled += r.pour.finish == Pour::Finish::settled;
    sum += r.parts[0].friction;
    ASSERT_EQ(r.bin.inner_size, Vec3(0.2, 0.2, 0.1));
  }
  EXPECT_EQ(counts.size(), 3u);
  for (const auto& [count, n] : counts) EXPECT_NEAR(n, 333, 90) << count;  // six standard deviations
  EXPECT_NEAR(settled, 750, 85);
  EXPECT_NEAR(sum / 1000, 0.3, 0.011);
}

TEST_F(PlanTest, ADrawDependsOnItsHeapAndAttemptAlone) {
  const Plan p = plan("  parts[0].friction: {uniform: [0.2, 0.4]}\n");
  const Request late = p.request(77, 0, volume);
  EXPECT_EQ(p.request(77, 0, volume).text_sha256, late.text_sha256);
  EXPECT_NE(p.request(78, 0, volume).text_sha256, late.text_sha256);
  EXPECT_NE(p.request(77, 1, volume).text_sha256, late.text_sha256);
  EXPECT_NE(p.request(77, 1, volume).seed, late.seed);
  EXPECT_EQ(late.first, 77u);
}

TEST_F(PlanTest, FillAndSharesSetTheCounts) {
  const Plan p =
      plan("  parts[0].friction: {uniform: [0.2, 0.4]}\n", "amount: {fill: {uniform: [0.1, 0.1]}, shares: [3, 1]}\n");
  std::size_t first = 0, all = 0;
  for (std::size_t heap = 0; heap < 50; ++heap) {
    const Request r = p.request(heap, 0, volume);
    EXPECT_EQ(r.part_count(), 240u);  // 0.1 * 0.4 * 0.3 * 0.2 m3 of 1e-5 m3 each
    first += r.parts[0].count;
    all += r.part_count();
  }
  EXPECT_NEAR(static_cast<double>(first) / static_cast<double>(all), 0.75, 0.03);
}

}  // namespace
}  // namespace bin_scenes
