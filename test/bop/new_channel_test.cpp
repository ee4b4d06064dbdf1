/// A new channel of a sensor's images as a worked example: how steeply each pixel sees its surface. This file is all
/// that it takes in a program of its own. In this tree it would be two: an entry of src/output/image_channel.cpp and
/// its row in docs/use/outputs.md. A channel that a sensor model measures takes five more: the member of RangeImage
/// (range_image.hpp) and of Measurement (measurement.hpp), of_sensor.cpp between them, the file of the model, and the
/// array of Python (module.cpp) if counts do not do.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/image_channel.hpp"
#include "bin_scenes/raster/lens.hpp"
#include "bop/samples.hpp"
#include "bop/writer.hpp"
#include "output/output_fixture.hpp"
#include "output/read_png.hpp"

#include <cmath>

namespace bin_scenes {
namespace {

/// Cosine between the true normal and the ray of the pixel, in 255ths; 0 where nothing is.
Picture incidence(const RangeImage& image) {
  const Lens lens = lens_of(image.true_sensor());
  Picture counts{1, 8, {}};
  for (std::size_t i = 0; i < image.seen_normal().size(); ++i) {
    const auto& n = image.seen_normal()[i];
    const auto width = static_cast<std::size_t>(lens.width);
    const Vec3 ray = lens.ray(static_cast<double>(i % width), static_cast<double>(i / width)).normalized();
    const double cosine = -ray.dot(Vec3(n[0], n[1], n[2]));
    counts.counts.push_back(static_cast<std::uint16_t>(std::isnan(cosine) ? 0.0 : std::round(255.0 * cosine)));
  }
  return counts;
}

class NewChannel : public OutputTest {
 protected:
  static void SetUpTestSuite() {
    if (!find_image_channel("incidence"))
      register_image_channel({"incidence", incidence, 1, true, true, "incidence/image_raw"});
  }
  /// Plates that face the camera of focal length 10 pixels, and nothing in the last column.
  void expect_incidence(const Png& read) const {
    ASSERT_EQ(read.width, 8);
    ASSERT_EQ(read.height, 6);
    EXPECT_EQ(read.depth, 8);
    for (int row = 0; row < 6; ++row) {
      EXPECT_EQ(read.at(7, row), 0);
      for (int column = 0; column < 7; ++column) {
        const double x = column - 3.5, y = row - 2.5;
        EXPECT_EQ(read.at(column, row), std::round(2550.0 / std::sqrt(x * x + y * y + 100.0))) << column << " " << row;
      }
    }
  }
};

TEST_F(NewChannel, IsAPngOfEachSensor) {
  write_pngs(dir.string(), small_image());
  expect_incidence(read_png(path("left_incidence.png")));
}

TEST_F(NewChannel, IsInShards) {
  const std::vector<RangeImage> images = {small_image()};
  Scene scene = small_scene();
  scene.parts.clear();
  write_bop_samples(dir.string(), 3, bop_images(scene, {}, images, {}));
  expect_incidence(read_png(path("000003_000000.incidence.png")));
}

TEST_F(NewChannel, HasANameOfItsOwn) {
  EXPECT_THROW(register_image_channel({"depth", incidence}), Error);
}

TEST_F(NewChannel, EqualImagesHaveEqualBytesAndOthersDoNot) {
  RangeImage image = small_image();
  write_pngs(dir.string(), image);
  EXPECT_EQ(text("left_depth.png"), text("left_truth_depth.png")) << "an exact sensor measures the truth";
  image.truth_depth = image.depth;
  image.truth_depth[3] += 0.01f;
  write_pngs(dir.string(), image);
  EXPECT_NE(text("left_depth.png"), text("left_truth_depth.png"));
  EXPECT_EQ(read_png(path("left_truth_depth.png")).at(3, 0), read_png(path("left_depth.png")).at(3, 0) + 100);
}

}  // namespace
}  // namespace bin_scenes
