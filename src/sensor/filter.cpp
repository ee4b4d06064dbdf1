/// Filters of drivers: which pixels are removed, and the median of those that are left.
#include "bin_scenes/sensor/filter.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/in_parallel.hpp"
#include "sensor/smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bin_scenes {

namespace {

void take_away(RangeImage& image, std::size_t pixel, Validity code) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  image.validity[pixel] = static_cast<std::uint8_t>(code);
  image.depth[pixel] = nan;
  image.label[pixel] = 0;
  image.snr[pixel] = 0.0f;
  if (!image.points.empty()) image.points[pixel] = {nan, nan, nan};
}

void take_all(RangeImage& image, const std::vector<char>& out) {
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i]) take_away(image, i, Validity::outlier);
}

/// Pixels of the window that have nearly the depth of its centre, which does not count.
int neighbours_of(const RangeImage& image, int column, int row, const OutlierFilter& settings) {
  const int reach = settings.window / 2;
  const auto depth = [&](int x, int y) { return image.depth[static_cast<std::size_t>(y) * image.width + x]; };
  const float own = depth(column, row);
  int found = -1;
  for (int y = std::max(0, row - reach); y <= std::min(image.height - 1, row + reach); ++y)
    for (int x = std::max(0, column - reach); x <= std::min(image.width - 1, column + reach); ++x)
      found += std::abs(static_cast<double>(depth(x, y)) - own) <= settings.step;
  return found;
}

void take_outliers(const OutlierFilter& settings, RangeImage& image) {
  std::vector<char> out(image.depth.size(), 0);
  const auto width = static_cast<std::size_t>(image.width);
  in_parallel(static_cast<std::size_t>(image.height), [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      if (std::isnan(image.depth[y * width + x])) continue;
      out[y * width + x] =
          neighbours_of(image, static_cast<int>(x), static_cast<int>(y), settings) < settings.neighbours;
    }
  });
  take_all(image, out);
}

void take_steep(double incidence, RangeImage& image) {
  const std::vector<std::array<float, 3>> points = points_of(image), normals = normals_of(image, points);
  std::vector<char> out(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Map<const Eigen::Vector3f> point(points[i].data()), normal(normals[i].data());
    out[i] = -point.normalized().dot(normal) < std::cos(incidence);  // a pixel without normal stays
  }
  take_all(image, out);
}

/// Calls step(i, k) for each pair of measured neighbours in a row or column.
template <class Step>
void for_each_pair(const RangeImage& image, const Step& step) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (std::isnan(image.depth[i])) continue;
    if ((i + 1) % width != 0 && !std::isnan(image.depth[i + 1])) step(i, i + 1);
    if (i + width < image.depth.size() && !std::isnan(image.depth[i + width])) step(i, i + width);
  }
}

/// A pixel is near a step if one in the square around it is at the step.
void take_edges(const EdgeFilter& settings, RangeImage& image) {
  std::vector<char> out(image.depth.size(), 0);
  const int reach = settings.reach - 1, width = image.width, height = image.height;
  for_each_pair(image, [&](std::size_t a, std::size_t b) {
    if (std::abs(static_cast<double>(image.depth[a]) - image.depth[b]) <= settings.step) return;
    for (const std::size_t at : {a, b}) {
      const int x = static_cast<int>(at) % width, y = static_cast<int>(at) / width;
      for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
          out[static_cast<std::size_t>(v) * width + u] = 1;
    }
  });
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = out[i] && !std::isnan(image.depth[i]);
  take_all(image, out);
}

/// Regions as sets of which each pixel names another one, the first pixel itself.
void take_clusters(const ClusterFilter& settings, RangeImage& image) {
  std::vector<std::size_t> parent(image.depth.size()), size(image.depth.size(), 0);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto first_of = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for_each_pair(image, [&](std::size_t a, std::size_t b) {
    if (std::abs(static_cast<double>(image.depth[a]) - image.depth[b]) > settings.step) return;
    const std::size_t one = first_of(a), other = first_of(b);
    parent[std::max(one, other)] = std::min(one, other);
  });
  for (std::size_t i = 0; i < parent.size(); ++i) ++size[first_of(i)];
  for (std::size_t i = 0; i < parent.size(); ++i)
    if (!std::isnan(image.depth[i]) && size[first_of(i)] < static_cast<std::size_t>(settings.pixels))
      take_away(image, i, Validity::outlier);
}

/// Replaces each depth by the median of the window; of an even number of depths, the smaller one of the central two.
void take_medians(const MedianFilter& settings, RangeImage& image) {
  const int reach = settings.window / 2, width = image.width, height = image.height;
  const std::vector<float> depth = image.depth;
  in_parallel(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    std::vector<float> found;
    for (int x = 0; x < width; ++x) {
      const std::size_t i = row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (std::isnan(depth[i])) continue;
      found.clear();
      for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
          if (const float z = depth[static_cast<std::size_t>(v) * width + u]; !std::isnan(z)) found.push_back(z);
      const auto median = found.begin() + static_cast<std::ptrdiff_t>((found.size() - 1) / 2);
      std::nth_element(found.begin(), median, found.end());
      image.depth[i] = *median;
    }
  });
}

/// Whether exactly the valid pixels have a depth.
bool validity_agrees(const RangeImage& image) {
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if ((image.validity[i] == 0) != !std::isnan(image.depth[i])) return false;
  return true;
}

}  // namespace

void filter(const FilterSettings& settings, RangeImage& image) {
  if (!settings.any()) return;
  BIN_SCENES_ASSERT(image.depth.size() ==
                    static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  BIN_SCENES_ASSERT(image.label.size() == image.depth.size() && image.snr.size() == image.depth.size());
  BIN_SCENES_ASSERT(image.validity.size() == image.depth.size());
  // An exact image is its own truth until something is taken from it.
  if (image.truth_depth.empty()) image.truth_depth = image.depth;
  if (image.truth_label.empty()) image.truth_label = image.label;
  for (std::size_t i = 0; i < image.depth.size(); ++i)
    if (!std::isnan(image.depth[i]) && image.snr[i] < settings.snr) take_away(image, i, Validity::dark);
  if (settings.outlier.neighbours > 0) take_outliers(settings.outlier, image);
  if (settings.incidence > 0.0) take_steep(settings.incidence, image);
  if (settings.edge.reach > 0) take_edges(settings.edge, image);
  if (settings.cluster.pixels > 0) take_clusters(settings.cluster, image);
  if (settings.median.window > 0) take_medians(settings.median, image);
  if (settings.smoothing.sigma > 0.0) smooth(settings.smoothing, image);
  for (std::size_t i = 0; i < image.points.size(); ++i)  // of those beside the rays of their pixels z was filtered
    if (!std::isnan(image.depth[i])) image.points[i][2] = image.depth[i];
  BIN_SCENES_ASSERT(validity_agrees(image));
}

}  // namespace bin_scenes
