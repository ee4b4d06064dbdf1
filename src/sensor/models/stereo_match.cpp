#include "sensor/models/census.hpp"
#include "sensor/models/stereo.hpp"

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

/// 8-bit image with a dark rim on the left. Without it the matcher leaves out every pixel whose disparity could reach
/// beyond the second image, whether it does or not.
cv::Mat with_rim(const std::vector<std::uint8_t>& bytes, int width, int height, int rim) {
  cv::Mat image(height, width + rim, CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < height; ++y) {
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(y) * width, width, image.ptr<std::uint8_t>(y) + rim);
  }
  return image;
}

constexpr double white = 255.0;  // grey level of the full well
constexpr float no_match = std::numeric_limits<float>::quiet_NaN();

}  // namespace

std::vector<char> textured(const std::vector<std::uint8_t>& image, int width, int height, const StereoSettings& s,
                           const Imager& imager) {
  const int wide = width + 1, reach = s.window / 2;
  std::vector<double> sum(static_cast<std::size_t>(wide) * (height + 1), 0.0), square = sum;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t at = static_cast<std::size_t>(y + 1) * wide + x + 1;
      const double v = image[static_cast<std::size_t>(y) * width + x];
      sum[at] = v + sum[at - 1] + sum[at - wide] - sum[at - wide - 1];
      square[at] = v * v + square[at - 1] + square[at - wide] - square[at - wide - 1];
    }
  }
  std::vector<char> good(image.size());
  for (int y = 0; y < height; ++y) {
    const int top = std::max(0, y - reach), bottom = std::min(height, y + reach + 1);
    for (int x = 0; x < width; ++x) {
      const int left = std::max(0, x - reach), right = std::min(width, x + reach + 1);
      const auto total = [&](const std::vector<double>& s) {
        const auto at = [&](int column, int row) { return s[static_cast<std::size_t>(row) * wide + column]; };
        return at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top);
      };
      const double n = static_cast<double>(right - left) * (bottom - top), mean = total(sum) / n;
      // Noise alone varies by its variance, and that of a window by sqrt(2 / n) of it.
      const double noise = white * white * imager.variance(mean / white) + 1.0 / 12.0;
      const double least = s.min_texture > 0.0 ? noise * (1.0 + 6.0 * std::sqrt(2.0 / n)) : 0.0;
      good[static_cast<std::size_t>(y) * width + x] =
          total(square) / n - mean * mean >= least + s.min_texture * s.min_texture;
    }
  }
  return good;
}

namespace {

/// By OpenCV, in sixteenths of a pixel that are drawn to whole ones, then refined.
std::vector<float> match_semi_globally(const Stereo::Pair& images, int width, int height, const StereoSettings& s,
                                       int least_disparity, const std::vector<char>& good) {
  // Penalties for a change of disparity by one and by more, as OpenCV's documentation advises for one channel.
  const int area = s.window * s.window, rim = least_disparity + s.disparities;
  const cv::Ptr<cv::StereoSGBM> matcher = cv::StereoSGBM::create(
      least_disparity, s.disparities, s.window, 8 * area, 32 * area, static_cast<int>(std::lround(s.max_difference)),
      31, s.uniqueness, s.speckle_size, 1, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat found;
  matcher->compute(with_rim(images.first, width, height, rim), with_rim(images.second, width, height, rim), found);
  std::vector<float> disparities(images.first.size());
  for (int y = 0; y < height; ++y) {
    const short* const in = found.ptr<short>(y) + rim;
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      const float disparity = static_cast<float>(in[x]) / 16.0f;
      // What would be in the rim of the second image was not seen.
      const bool seen = in[x] > 0 && in[x] >= 16 * least_disparity && disparity <= static_cast<float>(x);
      disparities[i] = seen && good[i] ? disparity : no_match;
    }
  }
  refine(images, width, height, s.window, disparities);
  return disparities;
}

/// Removes islands of fewer than `size` pixels, each within a pixel of disparity from the next.
void remove_speckles(int width, int height, int size, std::vector<float>& disparities) {
  cv::Mat sixteenths(height, width, CV_16SC1);
  short* const first = sixteenths.ptr<short>();
  for (std::size_t i = 0; i < disparities.size(); ++i)
    first[i] = static_cast<short>(std::isnan(disparities[i]) ? -16 : std::lround(16.0f * disparities[i]));
  cv::filterSpeckles(sixteenths, -16, size, 16);
  for (std::size_t i = 0; i < disparities.size(); ++i)
    if (first[i] == -16) disparities[i] = no_match;
}

}  // namespace

std::vector<float> match(const Stereo::Pair& images, int width, int height, const StereoSettings& s,
                         const StereoPipeline& pipeline, const Imager& imager, int least_disparity) {
  const std::vector<char> good = textured(images.first, width, height, s, imager);
  if (pipeline.matcher == StereoMatcher::semi_global)
    return match_semi_globally(images, width, height, s, least_disparity, good);
  std::vector<float> disparities = match_census(images, width, height, s, pipeline, least_disparity);
  for (std::size_t i = 0; i < disparities.size(); ++i)
    if (!good[i]) disparities[i] = no_match;
  if (s.speckle_size > 0) remove_speckles(width, height, s.speckle_size, disparities);
  return disparities;
}

}  // namespace bin_scenes
