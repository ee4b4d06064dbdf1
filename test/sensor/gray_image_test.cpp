/// Grey images of range sensors: exposed for the parts, whatever their albedo, and without what makes depth err.
#include "bin_scenes/sensor/gray_image.hpp"
#include "bin_scenes/config/presets.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "raster/stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace bin_scenes {
namespace {

/// Settings of a sensor, with so few pixels that tests are fast, and its distance.
struct Device {
  const char* settings;
  double distance;
};
const Device structured_light{"preset: structured_light_0.65m_590mm, width: 172, height: 128", 0.65},
    decoded_light{"preset: structured_light_0.65m_590mm, width: 172, height: 128, fidelity: decoded", 0.65},
    time_of_flight{"preset: time_of_flight_1m_1500mm, width: 320, height: 288", 0.8},
    stereo{"preset: stereo_0.7m_1300mm, width: 320, height: 180, fidelity: analytic", 0.7},
    decoded_stereo{"preset: stereo_0.7m_1300mm, width: 640, height: 360, fidelity: decoded", 0.7},
    ideal{"preset: ideal, width: 320, height: 240, fov: 0.7", 0.7};

Request request_of(const Device& device, const std::string& more, const std::string& surface,
                   const std::string& bin = "plastic_black") {
  return read_request_text("parts: [{model: bolt_hex.stl, unit: mm, surface: {material: " + surface +
                               "}}]\nbin: {surface: {material: " + bin + "}}\nsensors: [{" + device.settings + more +
                               "}]",
                           std::getenv("BIN_SCENES_MODELS"));
}

RangeImage seen(test::Stage& stage, const Request& request, double distance, const PartModelPtr& bin = nullptr) {
  Sensor sensor = request.sensors.front();
  sensor.pose = Pose{Vec3(0, 0, distance), Quat(0, 1, 0, 0)};
  for (PartLine& line : stage.request.parts) line.surface = request.parts.front().surface;
  stage.request.bin.surface = request.bin.surface;
  if (bin) stage.request.bin.kind = Bin::Kind::mesh;
  stage.scene.sensors = {resolved(sensor, stage.request.bin)};
  return SensorRig().render(stage.scene, {stage.request, stage.models, bin}).front();
}

void add(Mesh& mesh, const Mesh& more) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Triangle& t : more.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

/// Rings, balls and blocks at random in a bin of 0.3 x 0.2 m.
RangeImage heap_seen(const Device& device, const std::string& surface, const std::string& more = "",
                     const std::string& bin = "plastic_black") {
  Mesh tray = test::box_mesh({0.31, 0.21, 0.005}, {0, 0, -0.0025});
  for (const double side : {-1.0, 1.0}) {
    add(tray, test::box_mesh({0.005, 0.21, 0.1}, {side * 0.1525, 0, 0.05}));
    add(tray, test::box_mesh({0.31, 0.005, 0.1}, {0, side * 0.1025, 0.05}));
  }
  test::Stage stage;
  const std::size_t shapes[] = {stage.model(test::torus_mesh(0.02, 0.006, 32, 16)),
                                stage.model(test::sphere_mesh(0.014, 4)),
                                stage.model(test::box_mesh({0.05, 0.02, 0.012}))};
  Random draw(5, 0, Stream::pour);
  for (int i = 0; i < 60; ++i) {
    const Vec3 place(draw.uniform(-0.12, 0.12), draw.uniform(-0.07, 0.07), draw.uniform(0.015, 0.06));
    stage.place(shapes[i % 3], {place, draw.orientation()});
  }
  return seen(stage, request_of(device, more, surface, bin), device.distance, PartModel::from_mesh(tray, "tray"));
}

struct Exposure {
  int median;
  double saturated;
};
Exposure exposure_of_parts(const RangeImage& image) {
  const std::vector<std::uint8_t> gray = gray_of(image);
  std::vector<int> levels;
  for (std::size_t i = 0; i < gray.size(); ++i) {
    if (image.seen_label()[i] != 0) levels.push_back(gray[i]);
  }
  EXPECT_GT(levels.size(), 1000u);
  std::sort(levels.begin(), levels.end());
  return {levels.at(levels.size() / 2),
          static_cast<double>(std::count(levels.begin(), levels.end(), 255)) / static_cast<double>(levels.size())};
}

/// Parts of each material, in a dark bin and in a bright one.
void expect_well_exposed(const Device& device) {
  for (const std::string& surface : materials()) {
    for (const char* const bin : {"plastic_black", "plastic_white"}) {
      const Exposure parts = exposure_of_parts(heap_seen(device, surface, "", bin));
      const std::string name = device.settings + (", " + surface) + " in " + bin;
      std::printf("%s: median %d, saturated %.2f %%\n", name.c_str(), parts.median, 100.0 * parts.saturated);
      EXPECT_GE(parts.median, 80) << name;
      EXPECT_LE(parts.median, 170) << name;
      EXPECT_LT(parts.saturated, 0.01) << name;
    }
  }
}

TEST(GrayImage, StructuredLightIsExposedForTheParts) {
  expect_well_exposed(structured_light);
}
TEST(GrayImage, DecodedStructuredLightIsExposedForTheParts) {
  expect_well_exposed(decoded_light);
}
TEST(GrayImage, TimeOfFlightIsExposedForTheParts) {
  expect_well_exposed(time_of_flight);
}
TEST(GrayImage, StereoIsExposedForTheParts) {
  expect_well_exposed(stereo);
}
TEST(GrayImage, DecodedStereoIsExposedForTheParts) {
  expect_well_exposed(decoded_stereo);
}
TEST(GrayImage, TheIdealSensorIsExposedForTheParts) {
  expect_well_exposed(ideal);
}

/// Depth errs by noise, the light of a pixel does not.
TEST(GrayImage, NoiseOfDepthDoesNotReachTheAmplitudeOfTimeOfFlight) {
  const RangeImage noisy = heap_seen(time_of_flight, "zinc"),
                   exact = heap_seen(time_of_flight, "zinc", ", noise: false");
  EXPECT_NE(noisy.depth, exact.depth);
  EXPECT_EQ(gray_of(noisy), gray_of(exact));
}

/// Two plates that face the camera and meet below it, without light that met another surface.
RangeImage two_plates_seen(const Device& device, double left, double right, const std::string& more, bool gray = true) {
  test::Stage stage;
  const std::size_t line = stage.model(test::box_mesh({2.0, 4.0, 0.02}));
  stage.models.push_back(stage.models.back());
  stage.request.parts.push_back(stage.request.parts.back());
  stage.place(line, test::at(-1.0, 0, -0.01));
  stage.place(line + 1, test::at(1.0, 0, -0.01));
  Request request = request_of(device, ", bounces: 0" + more, "zinc");
  Sensor sensor = request.sensors.front();
  sensor.pose = Pose{Vec3(0, 0, device.distance), Quat(0, 1, 0, 0)};
  stage.request.parts[line].surface.albedo = left;
  stage.request.parts[line + 1].surface.albedo = right;
  stage.scene.sensors = {resolved(sensor, stage.request.bin)};
  return SensorRig().render(stage.scene, {stage.request, stage.models}, gray).front();
}

/// Levels are 255 * signal^(1 / 2.2): with twice the albedo, they are 2^(1 / 2.2) times as high, up to rounding.
TEST(GrayImage, LevelsGoWithTheRootOfTheLight) {
  const RangeImage image = two_plates_seen(time_of_flight, 0.2, 0.4, ", noise: false");
  const std::vector<std::uint8_t> gray = gray_of(image);
  const int width = image.width, y = image.height / 2;
  for (int x = 20; x < width / 2 - 2; x += 20) {
    const int first = gray[static_cast<std::size_t>(y) * width + x];
    const int second = gray[static_cast<std::size_t>(y) * width + (width - 1 - x)];
    const double dark = std::min(first, second), bright = std::max(first, second);
    ASSERT_GT(dark, 50);
    EXPECT_NEAR(bright, dark * std::pow(2.0, 1.0 / 2.2), 0.5 + 0.5 * std::pow(2.0, 1.0 / 2.2)) << x;
  }
}

/// The median of the parts is at level 120.
TEST(GrayImage, TheMedianOfMattePartsIsAtTheMiddleLevel) {
  for (const double albedo : {0.02, 0.9}) {
    const RangeImage image = two_plates_seen(time_of_flight, albedo, albedo, "");
    EXPECT_EQ(exposure_of_parts(image).median, 120) << albedo;
  }
}

/// Noise of depth neither: between neighbours there is a rounding at most.
TEST(GrayImage, APlateInFrontOfTimeOfFlightIsSmooth) {
  const RangeImage image = two_plates_seen(time_of_flight, 0.5, 0.5, "");
  const std::vector<std::uint8_t> gray = gray_of(image);
  for (int y = 1; y < image.height - 1; ++y) {
    for (int x = 2; x < image.width - 1; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
      ASSERT_LE(std::abs(gray[i] - gray[i - 1]), 1) << x << " " << y;
    }
  }
}

/// Shot noise is that of the full well at the exposure of the grey image: a level's standard deviation is its slope
/// over the signal times sqrt(signal / full_well), beside a rounding.
TEST(GrayImage, NoiseOfStructuredLightIsThatOfTheExposure) {
  const std::string well = ", imager: {full_well: 2000, read_noise: 0, bits: 12}";
  const RangeImage noisy = two_plates_seen(structured_light, 0.5, 0.5, well),
                   exact = two_plates_seen(structured_light, 0.5, 0.5, well + ", noise: false");
  const std::vector<std::uint8_t> gray = gray_of(noisy), mean = gray_of(exact);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < gray.size(); ++i) {
    if (mean[i] < 60) continue;
    const double signal = std::pow(mean[i] / 255.0, 2.2), slope = mean[i] / (2.2 * signal);
    const double variance = slope * slope * signal / 2000.0 + 2.0 / 12.0;  // each of the two levels is rounded
    sum += std::pow(gray[i] - mean[i], 2) / variance;
    ++count;
  }
  ASSERT_GT(count, 20000.0);
  EXPECT_NEAR(sum / count, 1.0, 0.03);  // 1 % for each of rounding's share, the curve's bend, and 3 sigma of the count
}

/// Where neither the pixel nor one within two pixels of it is lit.
TEST(GrayImage, ShadowsOfTheProjectorStayDark) {
  const Device fine{"preset: structured_light_0.65m_590mm, width: 1032, height: 772, bounces: 0, noise: false", 0.65};
  const RangeImage image = heap_seen(fine, "zinc", ", imager: {ambient: 0}");
  const std::vector<std::uint8_t> gray = gray_of(image);
  const auto in_shadow = [&](int x, int y) {
    return image.validity[static_cast<std::size_t>(y) * image.width + x] == static_cast<std::uint8_t>(Validity::shadow);
  };
  int count = 0;
  for (int y = 2; y < image.height - 2; ++y) {
    for (int x = 2; x < image.width - 2; ++x) {
      bool whole = true;
      for (int k = 0; k < 25; ++k) whole = whole && in_shadow(x + k % 5 - 2, y + k / 5 - 2);
      if (!whole) continue;
      EXPECT_EQ(gray[static_cast<std::size_t>(y) * image.width + x], 0) << x << " " << y;
      ++count;
    }
  }
  EXPECT_GT(count, 1000);
}

/// Without it, all else is the same, bit for bit, and who needs it is told.
TEST(GrayImage, IsMadeOnDemand) {
  for (const Device& device : {structured_light, decoded_light, time_of_flight, stereo, decoded_stereo}) {
    const RangeImage with = two_plates_seen(device, 0.2, 0.5, ""),
                     without = two_plates_seen(device, 0.2, 0.5, "", false);
    const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(float) * a.size()) == 0;  // NaN, too
    };
    EXPECT_TRUE(same(with.depth, without.depth) && same(with.intensity, without.intensity)) << device.settings;
    EXPECT_TRUE(same(with.snr, without.snr)) << device.settings;
    EXPECT_EQ(with.validity, without.validity);
    EXPECT_FALSE(with.gray.empty());
    EXPECT_THROW(gray_of(without), Error);
  }
}

}  // namespace
}  // namespace bin_scenes
