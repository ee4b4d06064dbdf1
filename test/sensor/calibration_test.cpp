#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/metrics.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "raster/stage.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

namespace bin_scenes {
namespace {

const Bin& no_bin() {
  static const Bin bin = [] {
    Bin none;
    none.kind = Bin::Kind::none;
    return none;
  }();
  return bin;
}

Sensor exact(const std::string& model) {
  Sensor sensor;
  sensor.model = model;
  sensor.width = 160;
  sensor.height = 120;
  sensor.fov = 0.4;
  sensor.near = 0.7;
  sensor.far = 1.43;
  sensor.noise = false;
  sensor.bounces = 0;
  sensor.imager.bits = 16;
  sensor.scan.step = 0.004;
  sensor.scan.profiles = 60;
  sensor.pose = Pose();
  sensor.projector.pose = Pose{Vec3(0.15, 0.0, 0.0), Quat::Identity()};  // looks the camera's way
  sensor.projector.fov = 0.9;
  return sensor;
}

/// Points of a plate at z = 1 that a device reports whose truth is given, against those of an exact one; both valid.
struct Pair {
  Vec3 exact, reported;
  std::size_t row;
};
std::vector<Pair> pairs(const Sensor& sensor, const std::function<void(Sensor&)>& err) {
  Targets targets;
  targets.add(box_target({4.0, 4.0, 0.02}), {Vec3(0, 0, 1.01), Quat::Identity()}, {0.6, 0.0, 0.4});
  const Scenery scenery = targets.scenery();
  Sensor believed = resolved(sensor, no_bin());
  believed.settings.of<CalibrationSettings>().focal = 1.0;  // not exact; `err` says how
  Sensor device = believed;
  err(device);
  RangeImage image = measure(scenery, render(scenery, lens_of(device), *device.pose, device.near, device.far), device,
                             targets.surfaces(), {1, 0, 0});
  const auto as_vectors = [](const std::vector<std::array<float, 3>>& points) {
    std::vector<Vec3> out;
    for (const auto& p : points) out.emplace_back(p[0], p[1], p[2]);
    return out;
  };
  const std::vector<Vec3> true_points = as_vectors(points_of(image));
  report_as_believed(image, device, believed);
  EXPECT_EQ(image.sensor.k, believed.k);
  const std::vector<Vec3> reported = as_vectors(points_of(image));
  std::vector<Pair> out;
  for (std::size_t i = 0; i < reported.size(); ++i)
    if (reported[i].allFinite())
      out.push_back({true_points[i], reported[i], i / static_cast<std::size_t>(image.width)});
  EXPECT_GT(out.size(), 5000u);
  return out;
}

void lengthen_focal(Sensor& device, double share) {
  device.k[0] *= 1.0 + share;
  device.k[4] *= 1.0 + share;
}

constexpr double small = 1e-3, second = 4e-6;  // second order of it, and what single precision leaves

TEST(Calibration, FocalLengthTiltsTriangulatedDepth) {
  // With u = f (1 + e) X / Z the believed ray has (1 + e) X / Z and meets the projector's plane at Z (1 - e X / b).
  for (const Pair& p : pairs(exact("structured_light"), [](Sensor& d) { lengthen_focal(d, small); })) {
    const double tilt = small * p.exact.x() / 0.15;
    ASSERT_NEAR(p.reported.z(), p.exact.z() * (1.0 - tilt), second + 2.0 * tilt * tilt);
    ASSERT_NEAR(p.reported.x(), p.exact.x() * (1.0 + small - tilt), second + 2.0 * tilt * tilt);
  }
}

TEST(Calibration, FocalLengthScalesDepthOfStereoAndWidthOfTimeOfFlight) {
  for (const Pair& p : pairs(exact("stereo"), [](Sensor& d) { lengthen_focal(d, small); })) {
    ASSERT_NEAR(p.reported.z(), p.exact.z() * (1.0 - small), second);
    ASSERT_NEAR(p.reported.x(), p.exact.x(), second);
  }
  for (const Pair& p : pairs(exact("time_of_flight"), [](Sensor& d) { lengthen_focal(d, small); })) {
    ASSERT_NEAR(p.reported.norm(), p.exact.norm(), second);
    ASSERT_NEAR(p.reported.x() / p.reported.z(), p.exact.x() / p.exact.z() * (1.0 + small), second);
  }
}

TEST(Calibration, PrincipalPointBendsDepth) {
  const double off = 0.5;  // pixel
  const double f = Lens::from_fov(160, 120, 0.4).fx;
  for (const Pair& p : pairs(exact("structured_light"), [&](Sensor& d) { d.k[2] += off; }))
    ASSERT_NEAR(p.reported.z(), 1.0 - off / f / 0.15, 2.0 * std::pow(off / f / 0.15, 2));
}

TEST(Calibration, BaselineScales) {
  const double b = 0.15;
  for (const Pair& p :
       pairs(exact("structured_light"), [&](Sensor& d) { d.projector.pose->position.x() += small * b; }))
    ASSERT_LT((p.reported - (1.0 - small) * p.exact).norm(), second);
  const double s = StereoSettings().baseline;
  for (const Pair& p :
       pairs(exact("stereo"), [&](Sensor& d) { d.settings.of<StereoSettings>().baseline += small * s; }))
    ASSERT_LT((p.reported - (1.0 - small) * p.exact).norm(), second);
  // A laser's carriage is not scaled with it: what is, is where a profile lies from the camera of its time.
  Sensor laser = exact("laser_line");
  for (const Pair& p : pairs(laser, [&](Sensor& d) { d.laser.pose->position *= 1.0 + small; })) {
    const Vec3 carriage((static_cast<double>(p.row) - 29.5) * laser.scan.step, 0.0, 0.0);
    ASSERT_LT((p.reported - carriage - (1.0 - small) * (p.exact - carriage)).norm(), second);
  }
}

TEST(Calibration, AnOffsetLengthensRanges) {
  for (const Pair& p :
       pairs(exact("time_of_flight"), [](Sensor& d) { d.settings.of<CalibrationSettings>().range = small; }))
    ASSERT_LT((p.reported - (p.exact.norm() + small) * p.exact.normalized()).norm(), second);
}

TEST(Calibration, AnOffsetBelowTheNearestSurfaceLeavesNothing) {
  Sensor believed = resolved(exact("time_of_flight"), no_bin());
  believed.settings.of<CalibrationSettings>().range = 1.0;  // m
  Sensor device = believed;
  device.settings.of<CalibrationSettings>().range = -0.8;
  RangeImage image;
  image.width = believed.width;
  image.height = believed.height;
  image.depth.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height), 0.75f);
  image.depth[0] = 1.0f;
  image.label.assign(image.depth.size(), 1);
  image.snr.assign(image.depth.size(), 10.0f);
  image.validity.assign(image.depth.size(), static_cast<std::uint8_t>(Validity::valid));
  report_as_believed(image, device, believed);
  EXPECT_GT(image.depth[0], 0.2f);
  const std::size_t middle = (image.depth.size() + static_cast<std::size_t>(image.width)) / 2;
  EXPECT_TRUE(std::isnan(image.depth[middle])) << image.depth[middle];
  EXPECT_EQ(image.validity[middle], static_cast<std::uint8_t>(Validity::nothing));
}

TEST(Calibration, PoseMovesTheDeviceAndNothingInIt) {
  for (const char* model : {"structured_light", "stereo", "time_of_flight", "laser_line"}) {
    Sensor sensor = resolved(exact(model), no_bin());
    sensor.settings.of<CalibrationSettings>().position = 2e-3;
    sensor.settings.of<CalibrationSettings>().rotation = 3e-3;
    const Sensor device = true_device({sensor}, 0, 5);
    EXPECT_EQ(device.k, sensor.k);
    for (const auto& [a, b] :
         {std::pair(sensor.projector.pose, device.projector.pose), std::pair(sensor.laser.pose, device.laser.pose)}) {
      const Pose before = sensor.pose->inverse() * *a, after = device.pose->inverse() * *b;
      EXPECT_LT((before.position - after.position).norm(), 1e-12);
      EXPECT_LT(before.orientation.angularDistance(after.orientation), 1e-7);
    }
    EXPECT_GT((device.pose->position - sensor.pose->position).norm(), 1e-4);
    for (const Pair& p : pairs(sensor, [&](Sensor& d) {
           d.pose = device.pose, d.projector.pose = device.projector.pose, d.laser.pose = device.laser.pose;
         })) {
      // The carriage of a laser goes as it did: the true device is turned against its way.
      Vec3 carriage = Vec3::Zero();
      if (std::string(model) == "laser_line") carriage.x() = (static_cast<double>(p.row) - 29.5) * sensor.scan.step;
      ASSERT_LT((p.reported - carriage - (p.exact - device.pose->orientation.conjugate() * carriage)).norm(), 1e-6)
          << model;
    }
  }
}

TEST(Calibration, DimensionTruenessIsTheShareOfTheBaseline) {
  for (const char* model : {"structured_light", "stereo"}) {
    Sensor sensor = exact(model);
    const double without = measure_sensor(sensor).dimension_trueness;
    const bool stereo = std::string(model) == "stereo";
    const double b = stereo ? StereoSettings().baseline : 0.15;
    sensor.settings.of<CalibrationSettings>().baseline = 0.01 * b;
    const Sensor device = true_device({resolved(sensor, no_bin())}, 0, 0);  // seed 0, as measure_sensor()
    const double longer =
        (stereo ? device.settings.of<StereoSettings>().baseline : device.projector.pose->position.norm()) / b - 1.0;
    ASSERT_GT(std::abs(longer), 1e-3);
    EXPECT_LT(without, 0.1 * std::abs(longer)) << model;
    // All lengths err by the same share, but for what the quiet sensor errs by and the second order.
    EXPECT_NEAR(measure_sensor(sensor).dimension_trueness, std::abs(longer), 2.0 * without + 2.0 * longer * longer)
        << model;
  }
}

TEST(Calibration, ErrorsHaveTheirSigmaAndStayOverScenes) {
  Sensor sensor = resolved(exact("structured_light"), no_bin());
  sensor.settings.of<CalibrationSettings>() = {2.0, 0.5, 3e-4, 1e-3, 2e-3, 4e-3};
  constexpr int draws = 4000;
  Eigen::Array<double, 11, 1> sum = Eigen::Array<double, 11, 1>::Zero(), square = sum;
  for (std::uint64_t seed = 0; seed < draws; ++seed) {
    const Sensor d = true_device({sensor}, 0, seed);
    const Pose moved = sensor.pose->inverse() * *d.pose;
    const Eigen::AngleAxisd turn(moved.orientation);
    const Vec3 turned = turn.angle() * turn.axis();
    Eigen::Array<double, 11, 1> e;
    e << (d.k[0] - sensor.k[0]) / 2.0, (d.k[2] - sensor.k[2]) / 0.5, (d.k[5] - sensor.k[5]) / 0.5,
        ((d.projector.pose->position - d.pose->position).norm() - 0.15) / 3e-4, moved.position.x() / 1e-3,
        moved.position.y() / 1e-3, moved.position.z() / 1e-3, turned.x() / 2e-3, turned.y() / 2e-3, turned.z() / 2e-3,
        d.settings.of<CalibrationSettings>().range / 4e-3;
    EXPECT_NEAR(d.k[4] / sensor.k[4], d.k[0] / sensor.k[0], 1e-12);
    sum += e;
    square += e * e;
  }
  for (int i = 0; i < 11; ++i) {  // four standard errors
    EXPECT_LT(std::abs(sum[i] / draws), 4.0 / std::sqrt(draws)) << i;
    EXPECT_NEAR(square[i] / draws, 1.0, 4.0 * std::sqrt(2.0 / draws)) << i;
  }
}

TEST(Calibration, ViewsShareTheLensAndSensorsDoNot) {
  Sensor sensor = resolved(exact("structured_light"), no_bin());
  sensor.settings.of<CalibrationSettings>() = {2.0, 0.5, 3e-4, 1e-3, 2e-3};
  std::vector<Sensor> sensors(4, sensor);
  sensors[1].view_of = sensors[3].view_of = "dome";
  std::vector<Sensor> devices;
  for (std::size_t i = 0; i < 4; ++i) devices.push_back(true_device(sensors, i, 7));
  EXPECT_EQ(devices[1].k, devices[3].k);
  EXPECT_NE(devices[1].pose->position, devices[3].pose->position);
  EXPECT_NE(devices[0].k, devices[2].k);
  EXPECT_NE(devices[0].k, devices[1].k);
  EXPECT_EQ(true_device(sensors, 0, 7).k, devices[0].k);
  EXPECT_NE(true_device(sensors, 0, 8).k, devices[0].k);
}

TEST(Calibration, OfARigMovesTheCloudFromTheTruth) {
  test::Stage stage;
  stage.place(stage.model(test::box_mesh({0.4, 0.4, 0.02})), test::at(0, 0, 1.0));
  Sensor sensor = exact("structured_light");
  const auto shot = [&] {
    stage.scene.sensors = {resolved(sensor, stage.request.bin)};
    return SensorRig().render(stage.scene, {stage.request, stage.models}).front();
  };
  const RangeImage good = shot();
  sensor.settings.of<CalibrationSettings>().baseline = 1e-3;
  const RangeImage bad = shot();
  const Sensor device = true_device(stage.scene.sensors, 0, stage.scene.seed);
  const double scale = 0.15 / device.projector.pose->position.norm();
  ASSERT_GT(std::abs(scale - 1.0), 1e-4);
  std::size_t both = 0;
  for (std::size_t i = 0; i < good.depth.size(); ++i) {
    if (std::isnan(good.depth[i]) || std::isnan(bad.depth[i])) continue;
    ++both;
    ASSERT_NEAR(bad.depth[i], scale * good.depth[i], 1e-6);
    ASSERT_EQ(bad.truth_depth[i], good.truth_depth[i]);
  }
  EXPECT_GT(both, 3000u);
  EXPECT_EQ(bad.sensor.projector.pose->position, sensor.projector.pose->position) << "what is believed is told";
}

TEST(Calibration, IsReadAndWrittenBackIfGiven) {
  const auto written = [](const std::string& keys) {
    return write_request(
        read_request_text("parts: [{model: bolt_hex.stl, unit: mm}]\nsensors: [{model: stereo" + keys + "}]",
                          std::getenv("BIN_SCENES_MODELS")));
  };
  const std::string text = written(", calibration: {focal: 0.5, baseline: 5.0e-5}");
  EXPECT_NE(text.find("    calibration:\n      focal: 0.5\n"), std::string::npos) << text;
  EXPECT_NE(text.find("      baseline: 5"), std::string::npos) << text;
  EXPECT_EQ(written("").find("calibration"), std::string::npos);
}

TEST(Calibration, PresetsErrAsTheirMakersState) {
  const auto preset = [](const std::string& name) {
    return read_request_text("parts: [{model: bolt_hex.stl, unit: mm}]\nsensors: [{preset: " + name + "}]",
                             std::getenv("BIN_SCENES_MODELS"))
        .sensors[0];
  };
  const auto sigma = [&](const std::string& name) { return preset(name).settings.of<CalibrationSettings>(); };
  // A longer baseline shortens all lengths by its share. Two sigmas where a limit is stated.
  const auto stated = [&](const std::string& name, double baseline, double share) {
    EXPECT_NEAR(sigma(name).baseline / baseline, share, 0.02 * share) << name;
  };
  stated("structured_light_0.7m_750mm", 0.1112, 0.5 * 0.002);
  stated("structured_light_0.65m_590mm", 0.35, 0.2 / (0.5 * (870.0 + 2150.0)));
  stated("stereo_0.7m_1200mm", 0.05, 0.5 * 0.02);
  stated("stereo_1m_750mm", 0.16, 0.001);
  // The mean length of a vector of three normal errors is sqrt(8 / pi) sigmas.
  const CalibrationSettings fringes = sigma("structured_light_0.7m_750mm");
  EXPECT_NEAR(std::sqrt(8.0 / M_PI) * fringes.position, 0.328e-3, 0.01e-3);
  EXPECT_NEAR(std::sqrt(8.0 / M_PI) * fringes.rotation, 0.050 * M_PI / 180.0, 0.02e-3);
  EXPECT_TRUE(sigma("laser_line_0.5m_350mm").any());
  EXPECT_NEAR(2.0 * sigma("time_of_flight_1m_1500mm").range, 0.011 + 0.001 * 1.0, 1e-12);
  EXPECT_FALSE(sigma("ideal").any());
}

TEST(Calibration, MistakesAreTold) {
  Sensor sensor = exact("ideal");
  sensor.settings.of<CalibrationSettings>().focal = 1.0;
  try {
    check_sensors({sensor});
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("sensors[0].calibration"), std::string::npos) << e.what();
  }
  sensor.model = "stereo";
  sensor.settings.of<CalibrationSettings>().focal = -1.0;
  EXPECT_THROW(check_sensors({sensor}), Error);
  sensor.settings.of<CalibrationSettings>() = {};
  sensor.settings.of<CalibrationSettings>().range = 1e-3;
  EXPECT_THROW(check_sensors({sensor}), Error);  // it triangulates
  sensor.model = "time_of_flight";
  check_sensors({sensor});
}

}  // namespace
}  // namespace bin_scenes
