#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace bin_scenes {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// Depths in rows, NaN = nothing; SNR 10, labels 1.
RangeImage image_of(int width, const std::vector<float>& depths) {
  RangeImage image;
  image.width = width;
  image.height = static_cast<int>(depths.size()) / width;
  image.depth = depths;
  for (const float z : depths) {
    const bool valid = !std::isnan(z);
    image.validity.push_back(static_cast<std::uint8_t>(valid ? Validity::valid : Validity::shadow));
    image.label.push_back(valid ? 1 : 0);
    image.snr.push_back(valid ? 10.0f : 0.0f);
    image.intensity.push_back(0.5f);
  }
  image.truth_depth = image.depth;
  image.truth_label = image.label;
  return image;
}

/// One letter a pixel: v valid, s shadow, d dark, o outlier.
std::string codes(const RangeImage& image) {
  std::string text;
  for (std::size_t i = 0; i < image.validity.size(); ++i) {
    const auto code = static_cast<Validity>(image.validity[i]);
    const bool valid = code == Validity::valid;
    EXPECT_EQ(valid, !std::isnan(image.depth[i])) << i;
    EXPECT_EQ(valid, image.label[i] == 1) << i;
    EXPECT_EQ(valid, image.snr[i] > 0.0f) << i;
    if (!image.points.empty()) {
      EXPECT_EQ(valid, !std::isnan(image.points[i][0])) << i;
    }
    text += valid ? 'v' : code == Validity::dark ? 'd' : code == Validity::outlier ? 'o' : 's';
  }
  return text;
}

TEST(Filter, IsOffByDefault) {
  RangeImage image = image_of(3, {1.0f, 5.0f, none});
  image.snr = {0.001f, 1.0f, 0.0f};
  filter({}, image);
  EXPECT_EQ(codes(image), "vvs");
}

TEST(Filter, TakesWhatIsBelowTheSnr) {
  RangeImage image = image_of(4, {1.0f, 1.0f, 1.0f, none});
  image.points.assign(4, {0.0f, 0.0f, 1.0f});
  image.points[3] = {none, none, none};
  image.snr = {4.99f, 5.0f, 5.01f, 0.0f};
  FilterSettings settings;
  settings.snr = 5.0;
  filter(settings, image);
  EXPECT_EQ(codes(image), "dvvs");
  EXPECT_EQ(image.intensity[0], 0.5f) << "the grey image stays";
  EXPECT_EQ(image.truth_label[0], 1);
}

TEST(Filter, TakesWhatHasTooFewNeighbours) {
  // A flying point (2.0), a pair (3.0), a slope of 0.1 a pixel.
  RangeImage image = image_of(5, {1.0f, 1.0f, 1.0f, 1.0f, 3.0f,  //
                                  1.0f, 2.0f, 1.0f, none, 3.0f,  //
                                  1.0f, 1.0f, 1.0f, 1.1f, 1.2f});
  FilterSettings settings;
  settings.outlier = {2, 3, 0.05};
  filter(settings, image);
  // 1.1 has no neighbour within 0.05, nor has 1.2; each 3.0 has one.
  EXPECT_EQ(codes(image),
            "vvvvo"
            "vovso"
            "vvvoo");

  image = image_of(5, {1.0f, 1.0f, 1.0f, 1.0f, 3.0f,  //
                       1.0f, 2.0f, 1.0f, none, 3.0f,  //
                       1.0f, 1.0f, 1.0f, 1.1f, 1.2f});
  settings.outlier = {1, 3, 0.1001};
  filter(settings, image);
  EXPECT_EQ(codes(image),
            "vvvvv"
            "vovsv"
            "vvvvv");
}

TEST(Filter, TellsAllOutliersAtOnce) {
  // In a row each end has one neighbour: ends go, and what is left by them stays.
  RangeImage image = image_of(5, {1.0f, 1.0f, 1.0f, 1.0f, 1.0f});
  FilterSettings settings;
  settings.outlier = {2, 3, 0.01};
  filter(settings, image);
  EXPECT_EQ(codes(image), "ovvvo");
}

TEST(Filter, WhatIsTooDarkIsNoNeighbour) {
  RangeImage image = image_of(3, {1.0f, 1.0f, 1.0f});
  image.snr = {10.0f, 1.0f, 10.0f};
  FilterSettings settings{5.0, {1, 3, 0.01}};
  filter(settings, image);
  EXPECT_EQ(codes(image), "odo");
}

TEST(Filter, AnExactImageKeepsItsTruth) {
  RangeImage image = image_of(3, {1.0f, 2.0f, 1.0f});
  image.truth_depth.clear();
  image.truth_label.clear();
  FilterSettings settings;
  settings.outlier = {1, 5, 0.01};
  filter(settings, image);
  EXPECT_EQ(codes(image), "vov");
  EXPECT_EQ(image.seen_depth()[1], 2.0f);
  EXPECT_EQ(image.seen_label()[1], 1);
}

TEST(Filter, BelongsToASensor) {
  // Of two plates in one view the darker one is below the threshold, and it alone.
  Targets targets;
  targets.add(box_target({2.0, 2.0, 0.02}), {Vec3(0, -1.0, 1.01), Quat::Identity()}, {0.8, 0.0, 0.4});
  targets.add(box_target({2.0, 2.0, 0.02}), {Vec3(0, 1.0, 1.01), Quat::Identity()}, {0.1, 0.0, 0.4});
  const Scenery scenery = targets.scenery();
  Sensor sensor;
  sensor.model = "structured_light";
  sensor.width = 60;
  sensor.height = 40;
  sensor.fov = 0.3;
  sensor.near = 0.5;
  sensor.far = 2.0;
  sensor.pose = Pose();
  Bin nothing;
  nothing.kind = Bin::Kind::none;
  sensor = resolved(sensor, nothing);
  const auto shot = [&](double snr) {
    sensor.settings.of<FilterSettings>().snr = snr;
    return measure(scenery, render(scenery, lens_of(sensor), *sensor.pose, sensor.near, sensor.far), sensor,
                   targets.surfaces(), {1, 0, 0});
  };
  const RangeImage all = shot(0.0);
  const double bright = all.snr[10 * 60 + 30], dim = all.snr[30 * 60 + 30];
  ASSERT_GT(bright, 1.5 * dim);
  ASSERT_GT(dim, 0.0);
  const RangeImage some = shot(0.5 * (bright + dim));
  for (const int row : {5, 10, 30, 35}) {
    EXPECT_EQ(some.validity[static_cast<std::size_t>(row) * 60 + 30], row < 20 ? 0 : 4) << row;
  }
}

TEST(Filter, IsReadAndWrittenBackIfGiven) {
  const auto written = [](const std::string& keys) {
    return write_request(
        read_request_text("parts: [{model: bolt_hex.stl, unit: mm}]\nsensors: [{model: stereo" + keys + "}]",
                          std::getenv("BIN_SCENES_MODELS")));
  };
  const std::string text = written(", filter: {snr: 8, outlier: {neighbours: 6}, smoothing: {sigma: 1.5}}");
  EXPECT_NE(text.find("    filter:\n      snr: 8\n"), std::string::npos) << text;
  EXPECT_NE(text.find("        neighbours: 6\n"), std::string::npos) << text;
  EXPECT_NE(text.find("      smoothing:\n        sigma: 1.5\n"), std::string::npos) << text;
  EXPECT_EQ(written("").find("filter"), std::string::npos);
}

TEST(Filter, MistakesAreTold) {
  const auto error = [](const OutlierFilter& outlier) -> std::string {
    Sensor sensor;
    sensor.settings.of<FilterSettings>().outlier = outlier;
    try {
      check_sensors({sensor});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error({24, 5, 0.01}), "");
  EXPECT_NE(error({25, 5, 0.01}).find("sensors[0].filter.outlier.neighbours"), std::string::npos);
  EXPECT_NE(error({25, 5, 0.01}).find("24"), std::string::npos);
  EXPECT_NE(error({2, 4, 0.01}).find("sensors[0].filter.outlier.window"), std::string::npos);
  EXPECT_NE(error({-1, 5, 0.01}).find("at least 0"), std::string::npos);
}

}  // namespace
}  // namespace bin_scenes
