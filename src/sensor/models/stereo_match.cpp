#include "sensor/models/stereo.hpp"

#include <opencv2/calib3d.hpp>

#include <cmath>

namespace bin_scenes {

std::vector<float> match(const Stereo::Pair& images, int width, int height, const StereoSettings& s,
                         int least_disparity) {
  const auto as_matrix = [&](const std::vector<std::uint8_t>& bytes) {
    return cv::Mat(height, width, CV_8UC1, const_cast<std::uint8_t*>(bytes.data()));  // read only, but for its type
  };
  // Penalties for a change of disparity by one and by more, as OpenCV's documentation advises for one channel.
  const int area = s.window * s.window;
  const cv::Ptr<cv::StereoSGBM> matcher = cv::StereoSGBM::create(
      least_disparity, s.disparities, s.window, 8 * area, 32 * area, static_cast<int>(std::lround(s.max_difference)), 31,
      s.uniqueness, s.speckle_size, 1, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat found;
  matcher->compute(as_matrix(images.first), as_matrix(images.second), found);
  std::vector<float> disparities(images.first.size());
  for (int y = 0; y < height; ++y) {
    const short* const in = found.ptr<short>(y);
    for (int x = 0; x < width; ++x) {
      const bool good = in[x] >= 16 * least_disparity && in[x] > 0;
      disparities[static_cast<std::size_t>(y) * width + x] =
          good ? static_cast<float>(in[x]) / 16.0f : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return disparities;
}

}  // namespace bin_scenes
