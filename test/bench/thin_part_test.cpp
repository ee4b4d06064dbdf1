#include "thin_part.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/part_model.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace bin_scenes::bench {
namespace {

class ThinPart : public ::testing::Test {
 protected:
  ThinPart() : folder_(std::filesystem::temp_directory_path() / ("thin_part_" + std::to_string(::getpid()))) {
    ::setenv("BIN_SCENES_CACHE", "off", 1);  // a part that an older build has united would pass
  }
  ~ThinPart() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

/// Of those whose volume has a closed form; what pieces share counts once.
TEST_F(ThinPart, HasTheVolumeOfItsUnion) {
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

TEST_F(ThinPart, OtherNamesAreRefused) {
  EXPECT_THROW(write_thin_part(folder_.string(), "sheets"), Error);
}

}  // namespace
}  // namespace bin_scenes::bench
