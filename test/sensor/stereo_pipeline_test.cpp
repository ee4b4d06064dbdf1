/// The stages of a stereo camera in whole images: steps of disparity, unit of depth, filters, keys.
#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "sensor/models/stereo.hpp"
#include "sensor/shot.hpp"
#include "sensor/stage.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace bin_scenes {
namespace {

/// A plate and a box on it.
struct TwoBoxes {
  test::Stage stage;
  TwoBoxes() {
    stage.place(stage.model(test::box_mesh({0.8, 0.8, 0.02})), test::at(0, 0, 0.5));
    stage.place(stage.model(test::box_mesh({0.1, 0.1, 0.05})), test::at(0, 0, 0.535));
  }
  RangeImage shot(Sensor sensor) {
    sensor.pose = Pose{Vec3(0, 0, 1.0), Quat(0, 1, 0, 0)};
    stage.scene.sensors = {resolved(sensor, stage.request.bin)};
    return SensorRig().render(stage.scene, {stage.request, stage.models}).front();
  }
};

Sensor sensor_of(const std::string& model) {
  Sensor sensor;
  sensor.model = model;
  sensor.width = 160;
  sensor.height = 120;
  sensor.fov = 0.6;
  sensor.near = 0.2;
  sensor.far = 2.0;
  sensor.settings.of<StereoSettings>().baseline = 0.05;
  return sensor;
}

std::size_t valid_pixels(const RangeImage& image) {
  std::size_t count = 0;
  for (const float z : image.depth) count += !std::isnan(z);
  return count;
}

TEST(DepthUnit, MeasuredDepthIsAMultipleAndTheTruthIsNot) {
  for (const char* model : {"stereo", "time_of_flight", "structured_light"}) {
    SCOPED_TRACE(model);
    TwoBoxes scene;
    Sensor sensor = sensor_of(model);
    const RangeImage fine = scene.shot(sensor);
    constexpr double unit = 0.001;
    sensor.settings.of<DepthFormat>().unit = unit;
    const RangeImage coarse = scene.shot(sensor);
    ASSERT_GT(valid_pixels(coarse), 5000u);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < coarse.depth.size(); ++i) {
      ASSERT_EQ(std::isnan(coarse.depth[i]), std::isnan(fine.depth[i]));
      if (std::isnan(coarse.depth[i])) continue;
      const double count = coarse.depth[i] / unit;
      ASSERT_NEAR(count, std::round(count), 1e-4);
      ASSERT_NEAR(coarse.depth[i], fine.depth[i], 0.5 * unit + 1e-6);
      moved += coarse.depth[i] != fine.depth[i];
    }
    EXPECT_GT(moved, 1000u);
    ASSERT_EQ(coarse.seen_depth().size(), fine.seen_depth().size());
    for (std::size_t i = 0; i < fine.seen_depth().size(); ++i) {
      const float a = fine.seen_depth()[i], b = coarse.seen_depth()[i];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST(DepthUnit, ImagesOfFilesStoreItsMultiples) {
  Sensor sensor;
  sensor.pose = Pose{Vec3(0, 0, 1.0), Quat(0, 1, 0, 0)};
  for (const double unit : {1e-3, 1.25e-4, 3.3e-4}) {
    sensor.settings.of<DepthFormat>().unit = unit;
    const double scale = resolved(sensor, Bin()).depth_scale;
    EXPECT_LE(scale, 2e-5 * (1.0 + 1e-9)) << "as finely as without a unit";
    EXPECT_NEAR(unit / scale, std::round(unit / scale), 1e-9);
  }
}

TEST(StereoPipeline, WithoutNoiseTheAnalyticFormIsExact) {
  TwoBoxes scene;
  Sensor sensor = sensor_of("stereo");
  sensor.noise = false;
  StereoPipeline& pipeline = sensor.settings.of<StereoPipeline>();
  pipeline.matcher = StereoMatcher::census;
  pipeline.spatial = {0.4, 4.0, 3};
  pipeline.disparity_step = 0.5;
  sensor.settings.of<DepthFormat>().unit = 0.01;
  const RangeImage image = scene.shot(sensor);
  ASSERT_GT(valid_pixels(image), 5000u);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (std::isnan(image.depth[i])) continue;
    ASSERT_EQ(image.depth[i], image.seen_depth()[i]);
  }
}

TEST(StereoPipeline, DisparitiesAreMultiplesOfTheStep) {
  for (const bool decoded : {false, true}) {
    for (const StereoMatcher matcher : {StereoMatcher::semi_global, StereoMatcher::census}) {
      Targets targets;
      targets.add(box_target({6.0, 6.0, 0.02}), {Vec3(0, 0, 1.01), Quat::Identity()}, {0.6, 0.0, 0.4});
      const Lens camera = Lens::from_fov(320, 240, 0.7);
      Stereo::Setup setup;
      setup.settings.baseline = 0.1;
      setup.settings.disparities = 64;
      setup.projector = Lens::from_fov(800, 600, 0.9);
      setup.projector_pose.position = Vec3(0.05, 0.0, 0.0);
      setup.near = 0.5, setup.far = 5.0;
      setup.pipeline.matcher = matcher;
      setup.pipeline.disparity_step = 1.0 / 32.0;
      const test::Shot shot = test::shoot<Stereo>(targets, camera, setup, decoded);
      std::size_t odd = 0, all = 0;
      for (const double z : shot.measured.depth) {
        if (std::isnan(z)) continue;
        const double steps = 32.0 * camera.fx * 0.1 / z;
        ASSERT_NEAR(steps, std::round(steps), 1e-6);
        odd += std::lround(steps) % 2 != 0;
        ++all;
      }
      EXPECT_GT(all, 20000u);
      EXPECT_GT(odd, all / 10) << "finer than sixteenths";
    }
  }
}

TEST(StereoPipeline, TheSpatialFilterLowersNoiseAsPredicted) {
  for (const StereoMatcher matcher : {StereoMatcher::semi_global, StereoMatcher::census}) {
    double rms[2], predicted[2];
    for (const int iterations : {0, 2}) {
      Targets targets;
      targets.add(box_target({6.0, 6.0, 0.02}), {Vec3(0, 0, 1.01), Quat::Identity()}, {0.6, 0.0, 0.4});
      Stereo::Setup setup;
      setup.settings.baseline = 0.1;
      setup.settings.window = 7;
      setup.settings.dots = 0.5;
      setup.projector = Lens::from_fov(800, 600, 0.9);
      setup.near = 0.5, setup.far = 5.0;
      setup.pipeline.matcher = matcher;
      setup.pipeline.disparity_step = 0.0;
      setup.pipeline.spatial = {0.5, 10.0, iterations};
      const test::Shot shot = test::shoot<Stereo>(targets, Lens::from_fov(320, 240, 0.7), setup, false);
      double square = 0.0, expected = 0.0, n = 0.0;
      for (int y = 30; y < 210; ++y) {
        for (int x = 70; x < 290; ++x) {
          const std::size_t i = static_cast<std::size_t>(y) * 320 + x;
          if (shot.measured.validity[i] != Validity::valid) continue;
          square += std::pow(shot.measured.depth[i] - shot.view.depth[i], 2);
          expected += shot.sigma[i] * shot.sigma[i];
          n += 1.0;
        }
      }
      ASSERT_GT(n, 30000.0);
      rms[iterations > 0] = std::sqrt(square / n), predicted[iterations > 0] = std::sqrt(expected / n);
    }
    EXPECT_NEAR(rms[0] / predicted[0], 1.0, 0.06);  // 40,000 pixels are some 800 windows
    EXPECT_NEAR(rms[1] / predicted[1], 1.0, 0.12);  // and 200 wider ones
    EXPECT_LT(rms[1], 0.8 * rms[0]);
  }
}

std::string written(const std::string& keys) {
  return write_request(
      read_request_text("parts: [{model: bolt_hex.stl, unit: mm}]\nsensors: [{model: stereo" + keys + "}]",
                        std::getenv("BIN_SCENES_MODELS")));
}

TEST(StereoPipeline, IsReadAndWrittenBack) {
  const std::string text = written(
      ", depth_unit: 0.001, stereo: {matcher: census, second_peak: 0.05, spatial: {alpha: 0.4, iterations: 3}}");
  EXPECT_NE(text.find("    depth_unit: 0.001\n"), std::string::npos) << text;
  EXPECT_NE(text.find("      matcher: census\n"), std::string::npos) << text;
  EXPECT_NE(text.find("      second_peak: 0.05"), std::string::npos) << text;
  EXPECT_NE(text.find("      spatial:\n        alpha: 0.4\n"), std::string::npos) << text;
  EXPECT_NE(text.find("        iterations: 3\n"), std::string::npos) << text;
  EXPECT_EQ(written(text.empty() ? "" : ", stereo: {spatial: {alpha: 0.4}}").find("iterations: 3"), std::string::npos);
}

TEST(StereoPipeline, MistakesNameTheirKey) {
  const auto error = [](const std::string& keys) -> std::string {
    try {
      written(keys);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error(", stereo: {matcher: census, window: 9, census: 5}"), "");
  EXPECT_NE(error(", stereo: {census: 6}").find("stereo.census"), std::string::npos);
  EXPECT_EQ(error(", stereo: {window: 51}"), "") << "semi_global has no such limit";
  EXPECT_NE(error(", stereo: {matcher: census, window: 51}").find("at most 35"), std::string::npos);
  EXPECT_NE(error(", stereo: {matcher: censu}").find("did you mean 'census'?"), std::string::npos);
  EXPECT_NE(error(", stereo: {spatial: {alfa: 0.5}}").find("alpha"), std::string::npos);
  EXPECT_NE(error(", stereo: {spatial: {alpha: 0}}").find("stereo.spatial.alpha"), std::string::npos);
  EXPECT_NE(error(", depth_unit: -1").find("depth_unit"), std::string::npos);
}

}  // namespace
}  // namespace bin_scenes
