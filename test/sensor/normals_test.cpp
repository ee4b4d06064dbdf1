/// Normals of a cloud: what the measured points tell, as a real sensor's driver would compute them.
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/range_image.hpp"
#include "bin_scenes/sensor/resolve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Planes n . p = d, the nearer one of each pixel, with noise along the optical axis (m).
RangeImage image_of(const std::vector<std::pair<Vec3, double>>& planes, double noise, const std::string& model) {
  RangeImage image;
  image.sensor.model = model;
  image.width = image.sensor.width = 80;
  image.height = image.sensor.height = 60;
  image.sensor.k = {100, 0, 39.5, 0, 100, 29.5, 0, 0, 1};
  Random random(3, 0, Stream::probe);
  const Lens lens = lens_of(image.sensor);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      double z = 1e300;
      Vec3 normal = Vec3::Zero();
      for (const auto& [n, d] : planes) {
        const double here = d / n.dot(lens.ray(column, row));
        if (here > 0.0 && here < z) z = here, normal = n.dot(lens.ray(column, row)) > 0.0 ? Vec3(-n) : n;
      }
      image.depth.push_back(static_cast<float>(z + noise * random.normal()));
      image.normal.push_back(
          {static_cast<float>(normal.x()), static_cast<float>(normal.y()), static_cast<float>(normal.z())});
    }
  }
  return image;
}

double angle(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  const Eigen::Vector3f u(a[0], a[1], a[2]), v(b[0], b[1], b[2]);
  return static_cast<double>(std::atan2(u.cross(v).norm(), u.dot(v)));
}

std::vector<double> errors(const RangeImage& image) {
  const auto normals = normals_of(image, points_of(image));
  std::vector<double> all;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (std::isnan(image.depth[i])) continue;
    const auto& n = normals[i];
    EXPECT_NEAR(std::hypot(std::hypot(n[0], n[1]), n[2]), 1.0f, 1e-5f) << i;
    all.push_back(angle(n, image.normal[i]));
  }
  std::sort(all.begin(), all.end());
  return all;
}

const Vec3 tilted = Vec3(0.5, -0.3, 1.0).normalized();

TEST(Normals, OfAPlaneWithoutNoiseAreThePlanes) {
  const std::vector<double> all = errors(image_of({{tilted, 0.6}}, 0.0, "structured_light"));
  EXPECT_EQ(all.size(), 80u * 60u);
  EXPECT_LT(all.back(), 1e-3) << "depth is stored in single precision";
}

TEST(Normals, AreAsNoisyAsTheirPoints) {
  // Of 25 pixels of pitch p on a plane, noise s turns the fitted plane by s / (p sqrt(50)) about each of two axes.
  const double noise = 2e-4, pitch = 0.6 / 100, expected = noise / (pitch * std::sqrt(50.0));
  const std::vector<double> all = errors(image_of({{Vec3::UnitZ(), 0.6}}, noise, "structured_light"));
  const double median = all[all.size() / 2];
  EXPECT_NEAR(median, expected * std::sqrt(2.0 * std::log(2.0)), 0.15 * expected) << "that of a Rayleigh distribution";
}

TEST(Normals, DoNotMixTheTwoSidesOfAnEdge) {
  // A step of 0.1 m in the middle: no neighbourhood reaches over it.
  RangeImage image = image_of({{Vec3::UnitZ(), 0.6}}, 0.0, "stereo");
  for (int row = 0; row < image.height; ++row)
    for (int column = 40; column < image.width; ++column)
      image.depth[static_cast<std::size_t>(row) * 80 + column] += 0.1f;
  EXPECT_LT(errors(image).back(), 1e-3);
}

TEST(Normals, AreMissingWhereThePointsTellNone) {
  RangeImage image = image_of({{tilted, 0.6}}, 0.0, "time_of_flight");
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if (i / 80 != 30) image.depth[i] = nan;  // one row is left: a line has no plane
  image.depth[0] = 0.6f;                     // and a point alone
  for (const auto& n : normals_of(image, points_of(image)))
    EXPECT_TRUE(std::isnan(n[0]) && std::isnan(n[1]) && std::isnan(n[2]));
}

TEST(Normals, OfAnExactSensorAreExact) {
  RangeImage image = image_of({{tilted, 0.6}}, 1e-3, "ideal");
  image.depth[17] = nan;
  const auto normals = normals_of(image, points_of(image));
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (i == 17) {
      EXPECT_TRUE(std::isnan(normals[i][0]));
    } else {
      EXPECT_EQ(normals[i], image.normal[i]);
    }
  }
}

TEST(Normals, OfPointsOffTheRaysOfTheirPixelsAreThoseOfThePoints) {
  RangeImage image = image_of({{tilted, 0.6}}, 0.0, "laser_line");
  image.points.clear();
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 80; ++column) {
      const double x = 0.003 * column - 0.1, y = 0.004 * row - 0.1;
      image.points.push_back({static_cast<float>(x), static_cast<float>(y),
                              static_cast<float>((0.6 - tilted.x() * x - tilted.y() * y) / tilted.z())});
      image.depth[static_cast<std::size_t>(row) * 80 + column] = image.points.back()[2];
    }
  }
  EXPECT_LT(errors(image).back(), 1e-3);
}

}  // namespace
}  // namespace bin_scenes
