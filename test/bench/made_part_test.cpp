/// Parts made of convex pieces are closed solids with the volume of their union.
#include "made_part.hpp"

#include "bin_scenes/core/error.hpp"
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
#include <map>
#include <sstream>
#include <vector>

namespace bin_scenes::bench {
namespace {

class MadePart : public ::testing::Test {
 protected:
  MadePart() : folder_(std::filesystem::temp_directory_path() / ("made_part_" + std::to_string(::getpid()))) {
    ::setenv("BIN_SCENES_CACHE", "off", 1);  // a part that an older build has united would pass
  }
  ~MadePart() override { std::filesystem::remove_all(folder_); }

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

TEST_F(MadePart, IsOneClosedSolid) {
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
    EXPECT_EQ(read_pieces((folder_ / "pieces.obj").string(), 1e-3).size(), static_cast<std::size_t>(pieces_)) << seed;
    std::filesystem::remove_all(folder_);
  }
}

// Solids that share space count once, at whatever tolerance they were united: by points within any of them.
TEST_F(MadePart, HasTheVolumeOfItsUnion) {
  constexpr int points = 50000;
  for (const std::uint64_t seed : {1, 2, 15, 177, 297}) {
    const PartModelPtr part = load(seed);
    std::vector<HullPlanes> prisms;
    for (const std::vector<Vec3>& piece : read_pieces((folder_ / "pieces.obj").string(), 1e-3))
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

TEST_F(MadePart, FollowsFromItsSeedAlone) {
  load(7);
  const std::string seven = text();
  load(8);
  EXPECT_NE(text(), seven);
  load(7);
  EXPECT_EQ(text(), seven);
}

/// Of those whose volume has a closed form; what pieces share counts once.
TEST_F(MadePart, ThatIsThinHasTheVolumeOfItsUnion) {
  const double sector = 0.5 * std::sin(2 * M_PI / 16) * (13.0 * 13.0 - 11.0 * 11.0) * 45.0;
  const std::map<std::string, double> volume = {
      // mm3
      {"sheet", 50 * 30 * 0.5},           {"disc", 12 * std::sin(2 * M_PI / 24) * 25 * 25 * 0.6},
      {"lattice", 10 * 42 * 4 - 25 * 8},  {"comb", 50 * 6 * 3 + 9 * 2 * 20 * 3},
      {"frame", 3 * (50 * 40 - 42 * 32)}, {"tube", 16 * sector}};
  for (const std::string& name : thin_parts()) {
    const std::string folder = folder_.string() + "/" + name;
    write_thin_part(folder, name);
    LoadOptions options;
    options.unit = Unit::millimetre;
    const PartModelPtr part = PartModel::load(folder + "/part.obj", options);
    EXPECT_TRUE(part->load_report().closed) << name;
    if (volume.count(name)) {
      EXPECT_NEAR(part->mass().volume, 1e-9 * volume.at(name), 1e-5 * part->mass().volume) << name;
    }
    EXPECT_NEAR(part->diagonal(), 0.058, 0.013) << name;
  }
}

TEST_F(MadePart, OtherNamesAreRefused) {
  EXPECT_THROW(write_thin_part(folder_.string(), "sheets"), Error);
}

}  // namespace
}  // namespace bin_scenes::bench
