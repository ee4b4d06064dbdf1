#include "bin_scenes/sensor/resolve.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/range_image.hpp"
#include "part/shapes.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

/// Column and row on which a point of the bin frame falls.
Eigen::Vector2d pixel(const Sensor& s, const Vec3& x) {
  const Vec3 p = s.pose->inverse() * x;
  return {(s.k[0] * p.x() + s.k[1] * p.y()) / p.z() + s.k[2], s.k[4] * p.y() / p.z() + s.k[5]};
}

TEST(Resolve, PointsFallBackOnTheirPixels) {
  Sensor sensor;
  sensor.width = 64;
  sensor.height = 48;
  sensor.pose = Pose();
  for (const std::vector<double>& k : {std::vector<double>{}, {70, 3, 30, 0, 65, 25, 0, 0, 1}}) {
    sensor.k = k;
    RangeImage image;
    image.sensor = resolved(sensor, Bin());
    image.width = 64;
    image.height = 48;
    image.depth.assign(64 * 48, 0.7f);
    const auto points = points_of(image);
    for (const auto& [column, row] : {std::pair{0, 0}, std::pair{63, 47}, std::pair{20, 31}}) {
      const auto [x, y, z] = points[row * 64 + column];
      EXPECT_NEAR(pixel(image.sensor, Vec3(x, y, z)).x(), column, 1e-4);
      EXPECT_NEAR(pixel(image.sensor, Vec3(x, y, z)).y(), row, 1e-4);
      EXPECT_FLOAT_EQ(z, 0.7f);
    }
  }
}

TEST(Resolve, FieldOfViewSpansTheOuterEdgesOfTheImage) {
  Sensor sensor;
  sensor.fov = 1.0;
  const Sensor full = resolved(sensor, Bin());
  EXPECT_NEAR((639.5 - full.k[2]) / full.k[0], std::tan(0.5), 1e-12);
  EXPECT_NEAR((-0.5 - full.k[2]) / full.k[0], -std::tan(0.5), 1e-12);
}

TEST(Resolve, DefaultPoseSeesTheWholeRim) {
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

TEST(Resolve, RefusesWhatIsNoCamera) {
  Sensor sensor;
  sensor.k = {1, 2, 3};
  EXPECT_THROW(resolved(sensor, Bin()), Error);
  sensor.k.clear();
  sensor.near = 2.0;
  sensor.far = 1.0;
  EXPECT_THROW(resolved(sensor, Bin()), Error);
}

/// Problem of the Error that placing this sensor ends in; empty if it is accepted.
std::string refusal(const Sensor& sensor, const Bin& bin = {}, const std::vector<PartModelPtr>& models = {},
                    const std::vector<Pose>& poses = {}) {
  Request request;
  request.bin = bin;
  request.sensors = {sensor};
  for (std::size_t i = 0; i < models.size(); ++i) {
    request.parts.emplace_back();
    request.parts.back().poses = {poses[i]};
  }
  try {
    resolved_sensors({request, models});
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.where(), "sensors: camera");
    EXPECT_FALSE(error.remedy().empty());
    return error.problem();
  }
  return "";
}

TEST(Resolve, RefusesAPlaceFromWhichNothingCanBeSeen) {
  Sensor sensor;
  EXPECT_EQ(refusal(sensor), "");
  sensor.pose = Pose{Vec3(0, 0, -0.3), Quat::Identity()};
  EXPECT_NE(refusal(sensor).find("below the floor"), std::string::npos);
  sensor.pose = Pose{Vec3(0, 0, 1.0), Quat::Identity()};  // z up
  EXPECT_NE(refusal(sensor).find("looks away"), std::string::npos);
  Bin floor;
  floor.kind = Bin::Kind::floor;
  EXPECT_NE(refusal(sensor, floor).find("looks away"), std::string::npos);
  sensor.pose = Pose{Vec3(0, 0, 1.0), Quat(0, 1, 0, 0)};
  EXPECT_EQ(refusal(sensor, floor), "");
  const PartModelPtr box = PartModel::from_mesh(test::box_mesh({0.2, 0.2, 0.2}), "box");
  EXPECT_EQ(refusal(sensor, floor, {box}, {{Vec3(0, 0, 0.5), Quat::Identity()}}), "");
  EXPECT_NE(refusal(sensor, floor, {box}, {{Vec3(0, 0, 0.95), Quat::Identity()}}).find("inside part 0"),
            std::string::npos);
}

TEST(Resolve, ProjectorIsChecked) {
  Sensor sensor;
  sensor.model = "structured_light";
  EXPECT_EQ(refusal(sensor), "");
  sensor.projector.pose = Pose{Vec3(0.2, 0, 1.0), Quat::Identity()};
  EXPECT_NE(refusal(sensor).find("projector looks away"), std::string::npos);
  sensor.projector.pose = Pose{Vec3(0.2, 0, -1.0), Quat::Identity()};
  EXPECT_NE(refusal(sensor).find("projector stands"), std::string::npos);
  sensor.projector.pose = resolved(sensor, Bin()).pose;
  EXPECT_NE(refusal(sensor).find("triangulation"), std::string::npos);
}

TEST(Resolve, DisparitiesThatAreMatchedFitInSixteenBits) {
  Sensor sensor;
  sensor.model = "stereo";
  sensor.fidelity = Fidelity::decoded;
  sensor.far = 1.0;
  auto& stereo = sensor.settings.of<StereoSettings>();
  stereo.disparities = 1024;
  const double fx = resolved(sensor, Bin()).k[0];
  stereo.baseline = 1022.0 / fx;
  EXPECT_EQ(refusal(sensor), "");
  stereo.baseline = 1024.0 / fx;
  EXPECT_EQ(refusal(sensor),
            "the depth range needs disparities of 1024 (at far) to 2048 pixels, more than the 2047 that the matcher "
            "can find");
  sensor.fidelity = Fidelity::analytic;
  EXPECT_EQ(refusal(sensor), "");
}

TEST(Resolve, ACameraInTheWallIsToldSo) {
  Sensor sensor;
  sensor.model = "structured_light";
  sensor.pose = Pose{Vec3(0.2025, 0, 0.1), Quat(0, 1, 0, 0)};  // in the middle of a wall of 5 mm
  EXPECT_NE(refusal(sensor).find("camera stands inside the bin's wall"), std::string::npos);
  sensor.pose->position.z() = 0.6;
  EXPECT_EQ(refusal(sensor), "");
}

TEST(Resolve, LampsAreChecked) {
  Sensor sensor;
  sensor.model = "image";
  auto& lamps = sensor.settings.of<ImageSettings>().lamps;
  lamps.emplace_back();
  EXPECT_EQ(refusal(sensor), "");
  lamps[0].pose = Pose{Vec3(0.2025, 0, 0.1), Quat(0, 1, 0, 0)};
  EXPECT_NE(refusal(sensor).find("lamp stands inside the bin's wall"), std::string::npos);
  lamps[0].pose->position = Vec3(0, 0, -0.5);
  EXPECT_NE(refusal(sensor).find("lamp stands 0.5"), std::string::npos);
  lamps[0].type = ImageLamp::Type::dome;  // has no place
  EXPECT_EQ(refusal(sensor), "");
}

TEST(Resolve, LaserIsChecked) {
  Sensor sensor;
  sensor.model = "laser_line";
  EXPECT_EQ(refusal(sensor), "");
  sensor.laser.pose = resolved(sensor, Bin()).laser.pose;
  sensor.laser.pose->orientation = Quat::Identity();  // z up
  EXPECT_NE(refusal(sensor).find("laser looks away"), std::string::npos);
  // A sheet through the camera's centre: the line stays in one column whatever it falls on.
  sensor.pose = Pose{Vec3(0, 0, 1.0), Quat(0, 1, 0, 0)};
  sensor.laser.pose = Pose{Vec3(0, 0.2, 1.0), Quat(0, 1, 0, 0)};
  EXPECT_NE(refusal(sensor).find("triangulation"), std::string::npos);
}

TEST(Resolve, ALaserMayPassTheBinOnlyInThatPartOfTheScan) {
  Sensor sensor;
  sensor.model = "laser_line";
  sensor.pose = Pose{Vec3(-0.25, 0, 1.0), Quat(0, 1, 0, 0)};
  sensor.laser.pose = Pose{Vec3(-0.35, 0, 1.0), Quat(0, 1, 0, 0)};  // straight down, beside the bin
  sensor.scan.step = 1e-3;
  sensor.scan.profiles = 1000;
  EXPECT_EQ(refusal(sensor), "");
}

TEST(Resolve, RefusesADistortionThatFoldsTheImage) {
  Sensor sensor;
  sensor.fov = 1.6;
  sensor.distortion = {-0.2, 0, 0, 0, 0};
  EXPECT_NE(refusal(sensor).find("folds"), std::string::npos);
  sensor.fov = 0.8;
  EXPECT_EQ(refusal(sensor), "");
}

TEST(Resolve, ProjectorAndLaserStandABaselineAsideAndAimAtTheBin) {
  Sensor sensor;
  sensor.projector.baseline = 0.3;
  sensor.laser.baseline = -0.1;
  const Sensor full = resolved(sensor, Bin());
  const Vec3 right = full.pose->orientation * Vec3::UnitX();
  EXPECT_NEAR((full.projector.pose->position - full.pose->position - 0.3 * right).norm(), 0.0, 1e-12);
  EXPECT_NEAR((full.laser.pose->position - full.pose->position + 0.1 * right).norm(), 0.0, 1e-12);
  const Vec3 middle(0, 0, 0.1), ahead = full.projector.pose->inverse() * middle;
  EXPECT_NEAR(ahead.head<2>().norm(), 0.0, 1e-12);
  EXPECT_GT(ahead.z(), 0.0);
}

TEST(Resolve, DepthIsCountedAsFinelyAsTheBinAllows) {
  Sensor sensor;
  sensor.pose = Pose{Vec3(0, 0, 1.0), Quat(0, 1, 0, 0)};
  EXPECT_EQ(resolved(sensor, Bin()).depth_scale, 2e-5) << "65,534 counts of 20 um are 1.31 m";
  sensor.pose->position.z() = 2.0;
  EXPECT_EQ(resolved(sensor, Bin()).depth_scale, 5e-5);
  Bin none;
  none.kind = Bin::Kind::none;
  EXPECT_EQ(resolved(sensor, none).depth_scale, 2e-4) << "10 m of range";
}

TEST(Resolve, IndirectLightIsAsTheModelHasItUnlessGiven) {
  const std::pair<const char*, std::optional<int>> defaults[] = {
      {"ideal", std::nullopt}, {"structured_light", 1}, {"laser_line", 1}, {"stereo", 0}, {"time_of_flight", 1}};
  for (const auto& [model, bounces] : defaults) {
    Sensor sensor;
    sensor.model = model;
    EXPECT_EQ(resolved(sensor, Bin()).bounces, bounces) << model;
    sensor.bounces = 0;
    EXPECT_EQ(resolved(sensor, Bin()).bounces, 0) << model;
  }
}

}  // namespace
}  // namespace bin_scenes
