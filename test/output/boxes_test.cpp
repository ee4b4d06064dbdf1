#include "output/boxes.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

/// A square of 0.2 m in the plane z = 1, of which the camera sees a metre as 100 pixels.
PixelBox box_of_a_square_at(double x, double y) {
  Mesh square;
  for (const double u : {-0.1, 0.1})
    for (const double v : {-0.1, 0.1}) square.vertices.emplace_back(x + u, y + v, 1.0);
  Sensor sensor;
  sensor.width = sensor.height = 101;
  sensor.k = {100, 0, 50, 0, 100, 50, 0, 0, 1};
  return projected_box(square, Pose(), sensor);
}

TEST(ProjectedBox, HasThePartsSizeWhereverItIs) {
  using Box = std::array<int, 4>;
  EXPECT_EQ(box_of_a_square_at(0.0, 0.0).xywh(), (Box{40, 40, 21, 21}));
  EXPECT_EQ(box_of_a_square_at(2.0, 2.0).xywh(), (Box{240, 240, 21, 21}));
  EXPECT_EQ(box_of_a_square_at(-2.0, -2.0).xywh(), (Box{-160, -160, 21, 21})) << "left of the image and above it";
}

TEST(ProjectedBox, IsEmptyBehindTheCamera) {
  Mesh behind;
  behind.vertices = {Vec3(0, 0, -1)};
  Sensor sensor;
  sensor.k = {100, 0, 50, 0, 100, 50, 0, 0, 1};
  EXPECT_TRUE(projected_box(behind, Pose(), sensor).empty());
}

}  // namespace
}  // namespace bin_scenes
