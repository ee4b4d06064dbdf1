#include "bin_scenes/gl/prefix_sum.hpp"

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/gl/device.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::gl {
namespace {

// Around every boundary of a block (1024), and one size that needs a third level (more than 1024^2).
class PrefixSumTest : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Sizes, PrefixSumTest,
                         ::testing::Values(0, 1, 2, 1023, 1024, 1025, 2048, 70000, 1048576, 1048577));

TEST_P(PrefixSumTest, AgreesWithTheLoop) {
  Device::current().make_current();
  const std::size_t count = GetParam();
  Random random(5, count, Stream::probe);
  std::vector<std::uint32_t> counts(count);
  for (std::uint32_t& n : counts) n = static_cast<std::uint32_t>(random.below(9));
  Buffer<std::uint32_t> in("counts"), out("starts");
  in.upload(counts);
  PrefixSum prefix_sum;
  prefix_sum.run(in, out, count);
  const std::vector<std::uint32_t> starts = out.download(0, count + 1);
  std::uint32_t running = 0;
  for (std::size_t i = 0; i <= count; ++i) {
    ASSERT_EQ(starts[i], running) << "at " << i;
    if (i < count) running += counts[i];
  }
}

TEST(PrefixSum, BuffersAreUsedAgainForAnotherSize) {
  Device::current().make_current();
  PrefixSum prefix_sum;
  for (std::size_t count : {5000u, 3u, 2000000u, 7000u}) {
    Buffer<std::uint32_t> in("ones"), out("starts");
    in.upload(std::vector<std::uint32_t>(count, 1));
    prefix_sum.run(in, out, count);
    EXPECT_EQ(out.download(count, 1)[0], count);
    EXPECT_EQ(out.download(count / 2, 1)[0], count / 2);
  }
}

}  // namespace
}  // namespace bin_scenes::gl
