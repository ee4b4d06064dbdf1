#include "output/output_fixture.hpp"
#include "output/read_png.hpp"

#include <cstring>

namespace bin_scenes {
namespace {

using Images = OutputTest;

TEST_F(Images, DepthIsInCountsOfItsScaleAndZeroWhereNothingIsValid) {
  RangeImage image = small_image();
  image.depth[0] = 7.0f;      // beyond what 16 bits hold
  image.depth[8] = 0.00001f;  // nearer than a step, but seen
  write_pngs(dir.string(), image);
  const Png depth = read_png(path("left_depth.png"));
  EXPECT_EQ(depth.width, 8);
  EXPECT_EQ(depth.height, 6);
  EXPECT_EQ(depth.depth, 16);
  EXPECT_EQ(depth.channels, 1);
  EXPECT_EQ(depth.at(0, 0), 65535);
  EXPECT_EQ(depth.at(0, 1), 1);
  EXPECT_EQ(depth.at(3, 0), 8300);
  EXPECT_EQ(depth.at(3, 5), 8305);
  EXPECT_EQ(depth.at(7, 2), 0);
  image.sensor.depth_scale = 5e-5;
  write_pngs(dir.string(), image);
  EXPECT_EQ(read_png(path("left_depth.png")).at(3, 0), 16600);
}

TEST_F(Images, SnrIsInTenths) {
  RangeImage image = small_image();
  image.snr[0] = std::numeric_limits<float>::infinity();
  image.snr[1] = 6553.4f;
  image.snr[2] = 0.01f;
  write_pngs(dir.string(), image);
  const Png snr = read_png(path("left_snr.png"));
  const std::vector<std::uint16_t> first(snr.samples.begin(), snr.samples.begin() + 8);
  EXPECT_EQ(first, (std::vector<std::uint16_t>{65535, 65534, 1, 123, 123, 123, 123, 0}));
  EXPECT_EQ(snr.at(3, 5), 173);
}

TEST_F(Images, APictureHasItsBitsAndChannels) {
  RangeImage image = small_image();
  write_pngs(dir.string(), image);
  EXPECT_FALSE(std::filesystem::exists(path("left_image.png"))) << "a range sensor takes none";
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  for (const int bits : {8, 16}) {
    for (const int channels : {1, 3}) {
      image.picture = {channels, bits, {}};
      for (std::size_t i = 0; i < pixels * static_cast<std::size_t>(channels); ++i)
        image.picture.counts.push_back(static_cast<std::uint16_t>(i * 811 % (bits == 16 ? 65536 : 256)));
      write_pngs(dir.string(), image);
      const Png read = read_png(path("left_image.png"));
      EXPECT_EQ(read.depth, bits);
      EXPECT_EQ(read.channels, channels);
      EXPECT_EQ(read.samples, image.picture.counts);
    }
  }
}

TEST_F(Images, TruthStandsBesideWhatWasMeasured) {
  RangeImage image = small_image();
  write_pngs(dir.string(), image);
  EXPECT_EQ(text("left_truth_depth.png"), text("left_depth.png")) << "an exact sensor tells the truth";
  image.truth_depth = image.depth;
  image.truth_depth[7] = 0.9f;  // what the sensor missed
  image.truth_label = image.label;
  image.truth_label[7] = 3;
  image.label[1] = 0;
  image.normal[7] = {0.28f, 0.0f, -0.96f};  // of what it missed, too
  image.normal[8] = {NAN, NAN, NAN};
  write_pngs(dir.string(), image);
  const Png normals = read_png(path("left_truth_normal.png"));
  EXPECT_EQ(normals.channels, 3);
  const std::vector<std::uint16_t> of_two(normals.samples.begin() + 21, normals.samples.begin() + 27);
  EXPECT_EQ(of_two, (std::vector<std::uint16_t>{163, 128, 5, 0, 0, 0}));  // 127.5 (n + 1), rounded; nothing there
  EXPECT_EQ(read_png(path("left_depth.png")).at(7, 0), 0);
  EXPECT_EQ(read_png(path("left_truth_depth.png")).at(7, 0), 9000);
  EXPECT_EQ(read_png(path("left_truth_labels.png")).samples, image.truth_label);
  EXPECT_EQ(read_png(path("left_labels.png")).samples, image.label) << "as topic and bag have them";
}

TEST_F(Images, ValidityIsItsCodeAndThePictureExplainsIt) {
  RangeImage image = small_image();
  image.validity[0] = 8;
  write_pngs(dir.string(), image);
  const Png validity = read_png(path("left_validity.png"));
  EXPECT_EQ(validity.depth, 8);
  EXPECT_EQ(validity.at(0, 0), 8);
  EXPECT_EQ(validity.at(1, 0), 0);
  EXPECT_EQ(validity.at(7, 0), 1);
  for (const char* picture : {"left_validity_picture.png", "left_depth_picture.png"}) {
    EXPECT_GT(read_png(path(picture)).width, 8) << "what the colours mean stands to the right of the image";
  }
}

TEST_F(Images, ThePictureWritesTheNameOfEveryCode) {
  RangeImage image = small_image();
  const int codes = static_cast<int>(Validity::last) + 1;
  image.height = image.sensor.height = 12 * codes + 12;
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  image.depth.resize(pixels, 1.0f);
  image.label.resize(pixels);
  image.intensity.resize(pixels);
  image.snr.resize(pixels);
  image.normal.resize(pixels);
  image.validity.resize(pixels);
  for (int code = 0; code < codes; ++code) image.validity[code] = static_cast<std::uint8_t>(code);
  write_pngs(dir.string(), image);
  const Png picture = read_png(path("left_validity_picture.png"));
  constexpr int ink = 1;                            // of the palette
  const auto written = [&](int code, int letter) {  // in cells of 6 x 12 pixels to the right of the patches of colour
    for (int y = 12 * code + 6; y < 12 * code + 18; ++y)
      for (int x = 0; x < 5; ++x)
        if (picture.at(image.width + 17 + 6 * letter + x, y) == ink) return true;
    return false;
  };
  const char* const names[] = {"valid", "nothing",  "shadow",    "outside", "dark",      "saturated",
                               "mixed", "decoding", "unmatched", "outlier", "reflection"};
  ASSERT_EQ(codes, static_cast<int>(std::size(names)));
  for (int code = 0; code < codes; ++code)
    for (int letter = 0; letter < 10; ++letter)
      EXPECT_EQ(written(code, letter), letter < static_cast<int>(std::strlen(names[code]))) << names[code] << letter;
}

TEST_F(Images, LabelsAreThoseOfTheImage) {
  const RangeImage image = small_image();
  write_pngs(dir.string(), image);
  const Png labels = read_png(path("left_labels.png"));
  EXPECT_EQ(labels.depth, 16);
  EXPECT_EQ(labels.samples, image.label);
}

TEST_F(Images, ThePictureTellsPartsBinAndNothingApart) {
  write_pngs(dir.string(), small_image());
  const Png picture = read_png(path("left.png"));
  EXPECT_EQ(picture.channels, 3);
  EXPECT_EQ(picture.depth, 8);
  const auto rgb = [&](int x, int y) {
    return std::array<int, 3>{picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
  };
  EXPECT_NE(rgb(1, 2), rgb(6, 2));
  const auto nothing = rgb(7, 2);
  EXPECT_GT(nothing[0] + nothing[1] + nothing[2], 3 * 230);
  // Two parts side by side differ in hue, not only in brightness.
  RangeImage two = small_image();
  for (std::size_t i = 0; i < two.label.size(); ++i) two.label[i] = 1 + (i % 8) / 4;
  write_pngs(dir.string(), two);
  const Png pair = read_png(path("left.png"));
  const auto red_per_blue = [&](int x) { return static_cast<double>(pair.at(x, 2, 0)) / pair.at(x, 2, 2); };
  EXPECT_GT(std::abs(red_per_blue(1) - red_per_blue(5)), 0.5);
  EXPECT_LT(pair.at(3, 2, 1), pair.at(1, 2, 1)) << "a dark line between them";
}

}  // namespace
}  // namespace bin_scenes
