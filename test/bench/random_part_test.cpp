#include "random_part.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "referee.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

namespace bin_scenes::bench {
namespace {

class RandomPart : public ::testing::Test {
 protected:
  RandomPart() : folder_(std::filesystem::temp_directory_path() / ("random_part_" + std::to_string(::getpid()))) {
    ::setenv("BIN_SCENES_CACHE", "off", 1);  // a part that an older build has united would pass
  }
  ~RandomPart() override { std::filesystem::remove_all(folder_); }

  PartModelPtr load(std::uint64_t seed) {
    pieces_ = write_random_part(folder_.string(), seed);
    LoadOptions options;
    options.unit = Unit::millimetre;
    return PartModel::load((folder_ / "part.obj").string(), options);
  }
  std::string text() const {
    std::ostringstream out;
    out << std::ifstream(folder_ / "part.obj").rdbuf();
    return out.str();
  }

  std::filesystem::path folder_;
  int pieces_ = 0;
};

TEST_F(RandomPart, IsOneClosedSolid) {
  std::vector<std::uint64_t> seeds = {177, 297};  // like 15, they do not close at the first tolerance
  for (std::uint64_t seed = 1; seed <= 20; ++seed) seeds.push_back(seed);
  for (const std::uint64_t seed : seeds) {
    const PartModelPtr part = load(seed);
    EXPECT_TRUE(part->load_report().closed) << seed;
    EXPECT_EQ(part->load_report().shells, 1u) << seed;
    EXPECT_GE(part->diagonal(), 0.045) << seed;
    EXPECT_LE(part->diagonal(), 0.065) << seed;
    EXPECT_GE(pieces_, 2) << seed;
    EXPECT_LE(pieces_, 6) << seed;
    EXPECT_EQ(read_pieces(folder_.string(), 1e-3).size(), static_cast<std::size_t>(pieces_)) << seed;
    std::filesystem::remove_all(folder_);
  }
}

// Solids that share space count once, at whatever tolerance they were united: by points within any of them.
TEST_F(RandomPart, HasTheVolumeOfItsUnion) {
  constexpr int points = 50000;
  for (const std::uint64_t seed : {1, 2, 15, 177, 297}) {
    const PartModelPtr part = load(seed);
    std::vector<HullPlanes> prisms;
    for (const std::vector<Vec3>& piece : read_pieces(folder_.string(), 1e-3))
      prisms.emplace_back(convex_hull(piece, 1000));
    const Aabb box = part->mesh().bounds();
    Random random(seed, 0, Stream::probe);
    int inside = 0;
    for (int i = 0; i < points; ++i) {
      const Vec3 u(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
      inside += distance_to_union(prisms, box.lower + u.cwiseProduct(box.size())) <= 0.0;
    }
    const double share = static_cast<double>(inside) / points, sigma = std::sqrt(share * (1.0 - share) / points);
    EXPECT_NEAR(part->mass().volume / box.size().prod(), share, 4.0 * sigma) << seed;
    std::filesystem::remove_all(folder_);
  }
}

TEST_F(RandomPart, FollowsFromItsSeedAlone) {
  load(7);
  const std::string seven = text();
  load(8);
  EXPECT_NE(text(), seven);
  load(7);
  EXPECT_EQ(text(), seven);
}

}  // namespace
}  // namespace bin_scenes::bench
