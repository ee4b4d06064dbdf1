#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/range_camera.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

/// Column and row on which a point of the bin frame falls.
Eigen::Vector2d pixel(const Sensor& s, const Vec3& x) {
  const Vec3 p = s.pose->inverse() * x;
  return {(s.k[0] * p.x() + s.k[1] * p.y()) / p.z() + s.k[2], s.k[4] * p.y() / p.z() + s.k[5]};
}

TEST(Pinhole, PointsFallBackOnTheirPixels) {
  Sensor sensor;
  sensor.width = 64;
  sensor.height = 48;
  sensor.pose = Pose();
  for (const std::vector<double>& k : {std::vector<double>{}, {70, 3, 30, 0, 65, 25, 0, 0, 1}}) {
    sensor.k = k;
    RangeImage image;
    image.sensor = resolved(sensor, Bin());
    image.depth.assign(64 * 48, 0.7f);
    for (const auto& [column, row] : {std::pair{0, 0}, std::pair{63, 47}, std::pair{20, 31}}) {
      const auto [x, y, z] = point_at(image, column, row);
      EXPECT_NEAR(pixel(image.sensor, Vec3(x, y, z)).x(), column, 1e-4);
      EXPECT_NEAR(pixel(image.sensor, Vec3(x, y, z)).y(), row, 1e-4);
      EXPECT_FLOAT_EQ(z, 0.7f);
    }
  }
}

TEST(Pinhole, FieldOfViewSpansTheOuterEdgesOfTheImage) {
  Sensor sensor;
  sensor.fov = 1.0;
  const Sensor full = resolved(sensor, Bin());
  EXPECT_NEAR((639.5 - full.k[2]) / full.k[0], std::tan(0.5), 1e-12);
  EXPECT_NEAR((-0.5 - full.k[2]) / full.k[0], -std::tan(0.5), 1e-12);
}

TEST(Pinhole, DefaultPoseSeesTheWholeRim) {
  for (const double fov : {0.3, 0.75, 1.5}) {
    for (const Vec3& size : {Vec3(0.4, 0.3, 0.2), Vec3(0.1, 1.0, 0.5), Vec3(2.0, 0.2, 0.1)}) {
      Sensor sensor;
      sensor.fov = fov;
      Bin bin;
      bin.inner_size = size;
      const Sensor full = resolved(sensor, bin);
      for (int i = 0; i < 4; ++i) {
        const Vec3 corner((i & 1 ? 1 : -1) * (0.5 * size.x() + bin.wall_thickness),
                          (i & 2 ? 1 : -1) * (0.5 * size.y() + bin.wall_thickness), size.z());
        const Eigen::Vector2d at = pixel(full, corner);
        EXPECT_TRUE(at.x() >= 0 && at.x() <= 639 && at.y() >= 0 && at.y() <= 479) << at.transpose();
        EXPECT_GE((full.pose->inverse() * corner).z(), full.near);
      }
      EXPECT_GT(pixel(full, Vec3(0.01, 0, 0)).x(), full.k[2]) << "image right is bin x";
      EXPECT_LT(pixel(full, Vec3(0, 0.01, 0)).y(), full.k[5]) << "image up is bin y";
    }
  }
}

TEST(Pinhole, RefusesWhatIsNoCamera) {
  Sensor sensor;
  sensor.k = {1, 2, 3};
  EXPECT_THROW(resolved(sensor, Bin()), Error);
  sensor.k.clear();
  sensor.near = 2.0;
  sensor.far = 1.0;
  EXPECT_THROW(resolved(sensor, Bin()), Error);
}

}  // namespace
}  // namespace bin_scenes
