/// The stages of a stereo camera in whole images: steps of disparity, unit of depth, filters, keys.
#include "bin_scenes/sensor/stereo_pipeline.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "raster/stage.hpp"
#include "sensor/models/disparity_filters.hpp"
#include "sensor/models/stereo.hpp"
#include "sensor/shot.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(DepthUnit, ProfilesKeepXAndY) {
  Sensor sensor = sensor_of("laser_line");
  sensor.scan.profiles = 60;
  sensor.scan.step = 0.003;
  TwoBoxes scene;
  const RangeImage fine = scene.shot(sensor);
  sensor.settings.of<DepthFormat>().unit = 0.0005;
  const RangeImage coarse = scene.shot(sensor);
  ASSERT_GT(valid_pixels(coarse), 3000u);
  for (std::size_t i = 0; i < coarse.depth.size(); ++i) {
    if (std::isnan(coarse.depth[i])) continue;
    ASSERT_NEAR(coarse.depth[i] / 0.0005, std::round(coarse.depth[i] / 0.0005), 1e-3);
    ASSERT_EQ(coarse.points[i][2], coarse.depth[i]);
    ASSERT_EQ(coarse.points[i][0], fine.points[i][0]);
    ASSERT_EQ(coarse.points[i][1], fine.points[i][1]);
    ASSERT_NEAR(coarse.depth[i], fine.depth[i], 0.00025 + 1e-6);
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

/// A plate at 1 m before a camera of 320 x 240 pixels.
test::Shot plate_shot(const Stereo::Setup& setup, bool decoded, std::uint64_t seed = 1) {
  Targets targets;
  targets.add(box_target({6.0, 6.0, 0.02}), {Vec3(0, 0, 1.01), Quat::Identity()}, {0.6, 0.0, 0.4});
  return test::shoot<Stereo>(targets, Lens::from_fov(320, 240, 0.7), setup, decoded, seed);
}

Stereo::Setup plate_setup() {
  Stereo::Setup setup;
  setup.settings.baseline = 0.1;
  setup.settings.disparities = 64;
  setup.settings.min_texture = 0.0;
  setup.settings.speckle_size = 0;
  setup.projector = Lens::from_fov(260, 200, 0.9);
  setup.projector_pose.position = Vec3(0.05, 0.0, 0.0);
  setup.near = 0.5, setup.far = 5.0;
  setup.pipeline.matcher = StereoMatcher::census;
  setup.pipeline.disparity_step = 0.0;
  return setup;
}

/// Standard deviation of the difference of two images over the square root of 2 (m): what differs from image to image.
double temporal_noise(const Stereo::Setup& setup, bool decoded) {
  const test::Shot a = plate_shot(setup, decoded, 1), b = plate_shot(setup, decoded, 2);
  double square = 0.0, n = 0.0;
  for (int y = 30; y < 210; ++y) {
    for (int x = 70; x < 290; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * 320 + x;
      const double difference = a.measured.depth[i] - b.measured.depth[i];
      if (std::isnan(difference) || std::abs(difference) > 0.05) continue;  // another disparity
      square += 0.5 * difference * difference;
      n += 1.0;
    }
  }
  EXPECT_GT(n, 20000.0);
  return std::sqrt(square / n);
}

TEST(StereoPipeline, SuccessiveImagesAreAveraged) {
  for (const bool decoded : {false, true}) {
    SCOPED_TRACE(decoded);
    Stereo::Setup setup = plate_setup();
    setup.pipeline.temporal.delta = 10.0;
    const double one = temporal_noise(setup, decoded);
    setup.pipeline.temporal.frames = 6;
    const double six = temporal_noise(setup, decoded);
    EXPECT_NEAR(six / one, temporally_filtered_noise(setup.pipeline.temporal), 0.05);
    setup.noise = false;
    const test::Shot still = plate_shot(setup, decoded);
    setup.pipeline.temporal.frames = 1;
    const test::Shot single = plate_shot(setup, decoded);
    for (std::size_t i = 0; i < still.measured.depth.size(); ++i) {
      const double a = still.measured.depth[i], b = single.measured.depth[i];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST(StereoPipeline, SpreadDotsLeaveFewerHoles) {
  Stereo::Setup setup = plate_setup();
  setup.settings.dots = 0.03;  // about one in a window
  std::size_t holes[2];
  for (const DotLayout layout : {DotLayout::random, DotLayout::spread}) {
    setup.pipeline.layout = layout;
    const test::Shot shot = plate_shot(setup, true);
    std::size_t& count = holes[layout == DotLayout::spread] = 0;
    for (int y = 30; y < 210; ++y)
      for (int x = 70; x < 290; ++x)
        count += shot.measured.validity[static_cast<std::size_t>(y) * 320 + x] != Validity::valid;
  }
  EXPECT_GT(holes[0], 100u);
  EXPECT_LT(holes[1], holes[0] / 2);
}

TEST(StereoPipeline, SpreadDotsLeaveNoSquareEmpty) {
  // A square of 6 x 6 pixels holds a whole one of the grid, whose squares have an edge of 1 / sqrt(0.12) = 2.9 pixels.
  // Of random dots 0.88^36 = 1 % of them are empty.
  for (const DotLayout layout : {DotLayout::random, DotLayout::spread}) {
    const std::vector<float> pattern = dot_pattern(258, 162, 0.12, layout, 1e-6);
    int empty = 0;
    for (int y = 0; y + 6 <= 162; y += 6) {
      for (int x = 0; x + 6 <= 258; x += 6) {
        float brightest = 0.0f;
        for (int k = 0; k < 36; ++k)
          brightest = std::max(brightest, pattern[static_cast<std::size_t>(y + k / 6) * 258 + x + k % 6]);
        empty += brightest < 0.1f;
      }
    }
    if (layout == DotLayout::spread)
      EXPECT_EQ(empty, 0);
    else
      EXPECT_GT(empty, 0);  // blur from outside lights most of the 12 that are expected
  }
}

TEST(StereoPipeline, ADecimatedImageIsSmallerAndUnbiased) {
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    for (const int factor : {2, 4}) {
      SCOPED_TRACE(factor);
      TwoBoxes scene;
      Sensor sensor = sensor_of("stereo");
      sensor.fidelity = fidelity;
      sensor.projector.width = 640, sensor.projector.height = 480;
      StereoPipeline& pipeline = sensor.settings.of<StereoPipeline>();
      pipeline.decimation = factor;
      const RangeImage image = scene.shot(sensor);
      ASSERT_EQ(image.width, 160);
      ASSERT_EQ(image.depth.size(), image.seen_depth().size());
      double error = 0.0, n = 0.0;
      std::size_t seen = 0;
      for (std::size_t i = 0; i < image.depth.size(); ++i) {
        seen += !std::isnan(image.seen_depth()[i]);
        const double difference = static_cast<double>(image.depth[i]) - image.seen_depth()[i];
        if (std::isnan(difference) || std::abs(difference) > 0.02) continue;
        error += difference, n += 1.0;
      }
      EXPECT_GT(n, 0.6 * static_cast<double>(seen));
      EXPECT_NEAR(error / n, 0.0, 3e-4);  // matching draws disparities to whole pixels by up to 0.1, here 3 mm
    }
  }
}

TEST(StereoPipeline, NothingIsReportedOutsideOfNearAndFar) {
  for (const bool decoded : {false, true}) {
    Stereo::Setup setup = plate_setup();
    setup.near = 0.9, setup.far = 1.2;
    Targets targets;  // a plate that is turned by 45 degrees: depths of 0.7 to 1.7 m
    targets.add(box_target({6.0, 6.0, 1e-4}), {Vec3(0, 0, 1.0), Quat(Eigen::AngleAxisd(0.785, Vec3::UnitY()))},
                {0.6, 0.0, 0.4});
    const test::Shot shot = test::shoot<Stereo>(targets, Lens::from_fov(320, 240, 0.7), setup, decoded);
    std::size_t valid = 0;
    for (const double z : shot.measured.depth) {
      if (std::isnan(z)) continue;
      ASSERT_GE(z, setup.near);
      ASSERT_LE(z, setup.far);
      ++valid;
    }
    EXPECT_GT(valid, 3000u);
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
  const std::string more = written(
      ", stereo: {pattern: spread, decimation: 2, temporal: {frames: 5, persistence: 8_of_8}, hole_filling: farthest}");
  EXPECT_NE(more.find("      pattern: spread\n"), std::string::npos) << more;
  EXPECT_NE(more.find("      decimation: 2\n"), std::string::npos) << more;
  EXPECT_NE(more.find("        frames: 5\n"), std::string::npos) << more;
  EXPECT_NE(more.find("        persistence: 8_of_8\n"), std::string::npos) << more;
  EXPECT_NE(more.find("      hole_filling: farthest\n"), std::string::npos) << more;
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
