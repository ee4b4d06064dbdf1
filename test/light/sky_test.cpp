#include "light/sky.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "sensor/models/image_stage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <string>

namespace bin_scenes {
namespace {

using namespace test;

/// A Radiance file, each row in runs as wide as they go or, of odd rows, pixel by pixel.
std::string written(const std::string& name, int width, int height,
                    const std::function<std::array<int, 4>(int x, int y)>& rgbe) {
  const std::string path = ::testing::TempDir() + name;
  std::ofstream file(path, std::ios::binary);
  file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << height << " +X " << width << "\n";
  const auto put = [&](int byte) { file.put(static_cast<char>(byte)); };
  for (int y = 0; y < height; ++y) {
    if (y % 2 == 1) {
      for (int x = 0; x < width; ++x)
        for (const int byte : rgbe(x, y)) put(byte);
      continue;
    }
    put(2), put(2), put(width / 256), put(width % 256);
    for (std::size_t channel = 0; channel < 4; ++channel) {
      for (int x = 0; x < width;) {
        int end = x + 1;
        while (end < width && end - x < 127 && rgbe(end, y)[channel] == rgbe(x, y)[channel]) ++end;
        put(end - x == 1 ? 1 : 128 + end - x), put(rgbe(x, y)[channel]);
        x = end;
      }
    }
  }
  return path;
}

ImageLamp sky(const std::string& picture, double radiance = 1.0) {
  ImageLamp lamp = dome(radiance);
  lamp.picture = picture;
  return lamp;
}

/// A plate whose normal is the bin's vertical, seen from above.
Mean plate_under(const ImageLamp& lamp, const Surface& surface, By by = By::both) {
  Sensor above = camera({lamp});
  above.pose = Pose{Vec3(0.0, 0.0, 1.0), Quat(0.0, 1.0, 0.0, 0.0)};
  Targets targets;
  targets.add(box_target({20.0, 20.0, 0.1}), {Vec3(0.0, 0.0, -0.05), Quat::Identity()}, surface);
  return radiance(targets, above, 256, 0, by);
}

TEST(Sky, APictureOfOneColourIsTheEvenDome) {
  const std::string grey = written("grey.hdr", 64, 32, [](int, int) { return std::array<int, 4>{128, 128, 128, 129}; });
  // 128 / 256 * 2^(129 - 128) = 1.
  for (const Surface& surface : {Surface{0.25, 0.0, 0.4}, Surface{0.8, 1.0, 0.3}}) {
    const double even = plate_under(dome(3.0), surface).value;
    EXPECT_NEAR(plate_under(sky(grey, 3.0), surface, By::lobe).value, even, 1e-9 * even) << "the same directions";
    const Mean seen = plate_under(sky(grey, 3.0), surface);
    EXPECT_NEAR(seen.value, 3.0 * surface.albedo, 0.01 * 3.0 * surface.albedo + 4.0 * seen.error) << surface.gloss;
  }
  EXPECT_EQ(plate_under(sky(grey, 3.0), {0.25, 0.0, 0.4}, By::lamps).value,
            plate_under(sky(grey, 3.0), {0.25, 0.0, 0.4}).value);
}

/// One bright pixel lights a matte plate as its cosine integrates over the pixel: width of the pixel times half the
/// difference of sin^2 at its rows. Its direction is that in which it is seen.
TEST(Sky, ABrightPixelIsADirectionalLamp) {
  constexpr int width = 64, height = 32, column = 40, row = 7;
  const std::string sun = written("sun.hdr", width, height, [](int x, int y) {
    return x == column && y == row ? std::array<int, 4>{200, 200, 200, 138} : std::array<int, 4>{0, 0, 0, 0};
  });
  const double bright = 200.0 / 256.0 * 1024.0, step = M_PI / height;
  const double cosines = 0.5 * (std::pow(std::sin((row + 1) * step), 2) - std::pow(std::sin(row * step), 2));
  const double closed_form = 0.5 * bright * cosines * (2.0 * M_PI / width) / M_PI;
  const Mean seen = plate_under(sky(sun), {0.5, 0.0, 0.4});
  EXPECT_NEAR(seen.value, closed_form, 0.002 * closed_form);
  EXPECT_LT(seen.error, 0.001 * closed_form) << "drawn where it shines";

  // Where it is: the picture's middle lies towards x, columns to its right turn clockwise.
  const Lamps lamps = lamps_of(camera({sky(sun)}));
  const double down = (row + 0.5) * step, turn = -2.0 * M_PI * ((column + 0.5) / width - 0.5);
  const Vec3 way(std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn), std::cos(down));
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(lamps.met(Vec3::Zero(), way, infinite, Lamps::Met::all, 1.0).mean(), bright, 1e-9);
  EXPECT_EQ(lamps.met(Vec3::Zero(), -way, infinite, Lamps::Met::all, 1.0).mean(), 0.0);
  EXPECT_EQ(lamps.met(Vec3::Zero(), way, 2.0, Lamps::Met::all, 1.0).mean(), 0.0) << "something stands before it";
  ImageLamp turned = sky(sun);
  turned.turn = -turn;
  const Vec3 ahead(std::sin(down), 0.0, std::cos(down));
  EXPECT_NEAR(lamps_of(camera({turned})).met(Vec3::Zero(), ahead, infinite, Lamps::Met::all, 1.0).mean(), bright, 1e-9);
}

/// What points of the sky find and what lobes find is the same, and so is what both share.
TEST(Sky, AllWaysFindTheSamePicture) {
  const std::string bands = written("bands.hdr", 32, 16, [](int x, int y) {
    return std::array<int, 4>{128 + 3 * x, 130 + 2 * y, 200, 126 + (x / 8) % 3};
  });
  for (const Surface& surface : {Surface{0.5, 0.0, 0.4}, Surface{0.9, 0.9, 0.5}}) {
    const auto seen = [&](By by) {
      ImageLamp lamp = sky(bands);
      Sensor above = camera({lamp});
      above.pose = Pose{Vec3(0.0, 0.0, 1.0), Quat(0.0, 1.0, 0.0, 0.0)};
      Targets targets;
      targets.add(box_target({20.0, 20.0, 0.1}), {Vec3(0.0, 0.0, -0.05), Quat::Identity()}, surface);
      const Scenery scenery = targets.scenery();
      const Lamps lamps = lamps_of(above);
      PathTracer::Setup setup;
      setup.samples = 256, setup.bounces = 0, setup.by = by;
      const PathTracer tracer(scenery, lens_of(above), *above.pose, targets.surfaces(), lamps, setup,
                              Random(3, 0, Stream::sensor));
      Rgb sum = Rgb::Zero();
      for (int row = 0; row < above.height; ++row)
        for (const Rgb& rgb : tracer.row(static_cast<std::size_t>(row))) sum += rgb;
      return Rgb(sum / (above.width * above.height));
    };
    const Rgb both = seen(By::both);
    for (const By by : {By::lamps, By::lobe}) {
      const Rgb other = seen(by);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(other[c], both[c], 0.01 * both[c]) << surface.gloss << " " << c;
    }
  }
}

TEST(Sky, AChangedPictureIsReadAgainAndAnOldOneIsForgotten) {
  const auto of_shade = [](int shade) { return [shade](int, int) { return std::array<int, 4>{shade, 9, 9, 129}; }; };
  const std::string path = written("changes.hdr", 16, 8, of_shade(64));
  std::weak_ptr<const Panorama> first = read_panorama(path);
  EXPECT_EQ(read_panorama(path), first.lock()) << "not read twice";
  written("changes.hdr", 16, 8, of_shade(128));
  std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) + std::chrono::seconds(2));
  EXPECT_EQ(read_panorama(path)->radiance[0][0], 1.0f);
  for (int i = 0; i < 8; ++i) read_panorama(written("sky" + std::to_string(i) + ".hdr", 16, 8, of_shade(i)));
  EXPECT_TRUE(first.expired());
}

TEST(Sky, MistakesOfPicturesAreTold) {
  const auto refused = [](const ImageLamp& lamp, const std::string& problem) {
    try {
      check_sensors({camera({lamp})});
      ADD_FAILURE() << problem;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(problem), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("sensors[0].lamps[0].picture"), std::string::npos) << e.what();
    }
  };
  const auto black = [](int, int) { return std::array<int, 4>{0, 0, 0, 0}; };
  refused(sky(written("black.hdr", 16, 8, black)), "is black");
  refused(sky(written("square.hdr", 16, 16, black)), "16 x 16");
  refused(sky(::testing::TempDir() + "none.hdr"), "cannot be read");
  refused(sky(::testing::TempDir()), "not a regular file");
  std::ofstream(::testing::TempDir() + "text.hdr") << "P5 3 3\n";
  refused(sky(::testing::TempDir() + "text.hdr"), "no Radiance picture");
  std::ofstream(::testing::TempDir() + "cut.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\nab";
  refused(sky(::testing::TempDir() + "cut.hdr"), "ends before");
  ImageLamp area = flat(ImageLamp::Type::area, Vec3::Zero());
  area.picture = "sky.hdr";
  refused(area, "applies only to lamps of type dome");
}

}  // namespace
}  // namespace bin_scenes
