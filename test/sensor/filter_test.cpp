#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
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

TEST(Filter, TakesBothSidesOfAStep) {
  const auto steps = [] {
    return image_of(6, {1.0f, 1.0f, 1.0f, 1.5f, 1.5f, 1.5f,  //
                        1.0f, 1.0f, 1.0f, 1.5f, 1.5f, 1.5f,  //
                        1.0f, none, 2.0f, 1.5f, 1.51f, 1.52f});
  };
  RangeImage image = steps();
  FilterSettings settings;
  settings.edge = {1, 0.1};
  filter(settings, image);
  EXPECT_EQ(codes(image),
            "vvoovv"
            "vvoovv"
            "vsoovv");
  image = steps();
  settings.edge = {2, 0.1};
  filter(settings, image);
  EXPECT_EQ(codes(image),
            "voooov"
            "voooov"
            "vsooov");
}

TEST(Filter, TakesSmallRegions) {
  // Regions of 5, 3 and 2 pixels; a slope of 0.01 a pixel connects, a missing pixel and a corner do not.
  const auto regions = [] {
    return image_of(5, {1.00f, 1.01f, none, 3.0f, 3.0f,  //
                        1.01f, 1.02f, none, 3.0f, none,  //
                        none, 1.03f, 2.0f, none, 2.0f});
  };
  FilterSettings settings;
  settings.cluster = {3, 0.015};
  RangeImage image = regions();
  filter(settings, image);
  EXPECT_EQ(codes(image),
            "vvsvv"
            "vvsvs"
            "svoso");
  settings.cluster.pixels = 4;
  image = regions();
  filter(settings, image);
  EXPECT_EQ(codes(image),
            "vvsoo"
            "vvsos"
            "svoso");
}

TEST(Filter, TheMedianKeepsStepsAndHoles) {
  RangeImage image = image_of(7, {1, 1, 1, 2, 2,    2, 2,  //
                                  1, 5, 1, 2, none, 2, 2,  //
                                  1, 1, 1, 2, 2,    9, 2,  //
                                  1, 1, 1, 2, 2,    2, 2});
  FilterSettings settings;
  settings.median.window = 3;
  filter(settings, image);
  for (int i = 0; i < 28; ++i) {
    if (i == 11)
      EXPECT_TRUE(std::isnan(image.depth[i]));
    else
      EXPECT_EQ(image.depth[i], i % 7 < 3 ? 1.0f : 2.0f) << i;
  }
}

TEST(Filter, TheMedianOfProfilesMovesZOnly) {
  RangeImage image = image_of(3, {1, 1, 1, 1, 4, 1, 1, 1, 1});
  image.points.assign(9, {0.3f, 0.4f, 1.0f});
  image.points[4] = {0.5f, 0.6f, 4.0f};
  FilterSettings settings;
  settings.median.window = 3;
  filter(settings, image);
  EXPECT_EQ(image.points[4], (std::array<float, 3>{0.5f, 0.6f, 1.0f}));
}

TEST(Filter, WhiteNoiseHasTheVarianceOfItsMedian) {
  std::vector<float> depths(200 * 200);
  Random random(4, 0, Stream::noise);
  for (float& z : depths) z = static_cast<float>(1.0 + 0.001 * random.normal());
  RangeImage image = image_of(200, depths);
  FilterSettings settings;
  settings.median.window = 3;
  filter(settings, image);
  double square = 0.0;
  for (int y = 1; y < 199; ++y)
    for (int x = 1; x < 199; ++x)
      square += std::pow((image.depth[static_cast<std::size_t>(y) * 200 + x] - 1.0) / 0.001, 2);
  EXPECT_NEAR(square / (198.0 * 198.0), 0.1661, 0.01);  // of nine (Teichroew 1956); 4 sigma of some 9000 squares
}

TEST(Filter, TakesSteepFaces) {
  // Two planes that are turned by 50 and 70 degrees about the camera's y.
  RangeImage image;
  image.sensor.model = "stereo";
  image.width = 40, image.height = 20;
  image.sensor.width = 40, image.sensor.height = 20;
  image.sensor.k = {400, 0, 19.5, 0, 400, 9.5, 0, 0, 1};
  for (int i = 0; i < 800; ++i) {
    const double u = (i % 40 - 19.5) / 400.0, slope = std::tan((i / 40 < 10 ? 50.0 : 70.0) * 3.14159265 / 180.0);
    image.depth.push_back(static_cast<float>(1.0 / (1.0 - slope * u)));  // of z = 1 + slope x
  }
  image.validity.assign(800, 0);
  image.label.assign(800, 1);
  image.snr.assign(800, 10.0f);
  FilterSettings settings;
  settings.incidence = 60.0 * 3.14159265 / 180.0;
  filter(settings, image);
  for (const int row : {3, 7, 12, 16})
    for (int x = 5; x < 35; ++x)
      EXPECT_EQ(image.validity[static_cast<std::size_t>(row) * 40 + x], row < 10 ? 0 : 9) << row << " " << x;
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
  const std::string more =
      written(", filter: {incidence: 1.2, edge: {reach: 2}, cluster: {pixels: 50}, median: {window: 5}}");
  for (const char* line :
       {"      incidence: 1.2\n", "        reach: 2\n", "        pixels: 50\n", "        window: 5\n"})
    EXPECT_NE(more.find(line), std::string::npos) << more;
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
  Sensor sensor;
  sensor.settings.of<FilterSettings>().median.window = 4;
  EXPECT_THROW(check_sensors({sensor}), Error);
}

}  // namespace
}  // namespace bin_scenes
