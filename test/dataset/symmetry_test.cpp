/// Symmetries and diameters of parts for which they are known.
#include "bin_scenes/part/symmetry.hpp"

#include "part/shapes.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace bin_scenes {
namespace {

PartModelPtr sample(const std::string& name) {
  LoadOptions options;
  options.unit = Unit::millimetre;
  return PartModel::load(std::string(std::getenv("BIN_SCENES_MODELS")) + "/" + name + ".stl", options);
}

TEST(Symmetry, OfSampleParts) {
  const Symmetries ring = find_symmetries(*sample("washer"));
  ASSERT_EQ(ring.continuous.size(), 1u);
  EXPECT_NEAR(std::abs(ring.continuous[0].direction.z()), 1.0, 1e-6);
  EXPECT_EQ(ring.discrete.size(), 1u);  // over

  const Symmetries nut = find_symmetries(*sample("nut_hex"));
  EXPECT_TRUE(nut.continuous.empty());
  EXPECT_EQ(nut.discrete.size(), 11u);  // of a hexagonal prism

  const Symmetries mug = find_symmetries(*sample("mug"));
  EXPECT_TRUE(mug.continuous.empty());
  EXPECT_TRUE(mug.discrete.empty());
}

TEST(Symmetry, MapsThePartOntoItself) {
  const PartModelPtr nut = sample("nut_hex");
  for (const Pose& turn : find_symmetries(*nut).discrete) {
    for (const Vec3& vertex : nut->mesh().vertices)
      ASSERT_LT(nut->query().nearest(turn * vertex).distance, 0.02 * nut->diagonal());
  }
}

TEST(Diameter, IsThatOfAllPairs) {
  const PartModelPtr part = sample("bracket_l");
  double longest = 0.0;
  for (const Vec3& a : part->mesh().vertices)
    for (const Vec3& b : part->mesh().vertices) longest = std::max(longest, (a - b).norm());
  EXPECT_DOUBLE_EQ(diameter(part->mesh()), longest);
}

}  // namespace
}  // namespace bin_scenes
