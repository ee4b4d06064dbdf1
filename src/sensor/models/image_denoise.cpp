/// Passes over the image whose taps lie ever farther apart: each doubles the width of what is averaged.
#include "sensor/models/image_denoise.hpp"

#include "core/in_parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bin_scenes {

namespace {

using Vec3f = Eigen::Vector3f;

constexpr int passes = 4;      ///< the last one reaches 16 pixels far
constexpr float grain = 3.0f;  ///< standard deviations by which two pixels of the same light may differ
constexpr std::array<float, 3> tap{0.375f, 0.25f, 0.0625f};  ///< by the distance from the centre; a cubic spline

struct Pixel {
  Vec3f point, normal;  ///< m, bin frame
  float off;            ///< m, how far from its face's plane another pixel's point may lie beside it
  std::uint16_t label;
  bool whole = false;  ///< it sees one face
};

/// What each pixel sees.
class Faces {
 public:
  Faces(const View& view, const std::vector<PathTracer::Grain>& grains)
      : width_(view.lens.width), height_(view.lens.height), pixels_(view.depth.size()) {
    in_parallel(static_cast<std::size_t>(height_), [&](std::size_t row) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t i = at(x, static_cast<int>(row));
        const double z = view.depth[i];
        if (std::isnan(z)) continue;
        Pixel& p = pixels_[i];
        p.point = (view.pose * Vec3(z * view.lens.ray(x, static_cast<double>(row)))).cast<float>();
        const auto& normal = view.normal[i];
        p.normal = view.pose.orientation.cast<float>() * Vec3f(normal[0], normal[1], normal[2]);
        p.off = static_cast<float>(z / view.lens.fx);
        p.label = view.label[i];
        p.whole = grains[i].one_face();
      }
    });
  }

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  bool whole(std::size_t i) const { return pixels_[i].whole; }
  int width() const { return width_; }
  int height() const { return height_; }

  bool sees(std::size_t i, const PathTracer::Side& side) const {
    const Pixel& p = pixels_[i];
    return side.takes(p.point, p.normal, p.label, 2.0f * p.off);
  }
  /// 0 to 1: how much two pixels, `step` apart, see of one face.
  float likeness(std::size_t i, std::size_t k, int step) const {
    const Pixel &p = pixels_[i], &q = pixels_[k];
    if (!q.whole || p.label != q.label) return 0.0f;
    constexpr auto bends = static_cast<float>(PathTracer::bends);
    const float turn = (p.normal.dot(q.normal) - bends) / (1.0f - bends);
    const float off = p.normal.dot(q.point - p.point) / (p.off * static_cast<float>(step));
    return std::max(turn, 0.0f) * std::max(1.0f - off * off, 0.0f);
  }

 private:
  int width_, height_;
  std::vector<Pixel> pixels_;
};

struct Image {
  std::vector<Eigen::Array3f> light;
  std::vector<float> variance;
};

/// How far light that lies `apart` from that of a pixel may replace it: 1 where they are equal, 0 where they differ by
/// more than noise of this variance explains.
float close(float apart, float variance) {
  const float share = std::max(1.0f - apart * apart / std::max(grain * grain * variance, 1e-30f), 0.0f);
  return share * share;
}

/// One pass. @param by_light  false: only variance is averaged, whatever the light
void average(const Faces& faces, int step, bool by_light, const Image& from, Image& to) {
  in_parallel(static_cast<std::size_t>(faces.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < faces.width(); ++x) {
      const std::size_t i = faces.at(x, y);
      to.light[i] = from.light[i], to.variance[i] = from.variance[i];
      if (!faces.whole(i)) continue;
      Eigen::Array3f light = Eigen::Array3f::Zero();
      float weights = 0.0f, variance = 0.0f;
      for (int v = -2; v <= 2; ++v) {
        for (int u = -2; u <= 2; ++u) {
          const int column = x + u * step, line = y + v * step;
          if (column < 0 || column >= faces.width() || line < 0 || line >= faces.height()) continue;
          const std::size_t k = faces.at(column, line);
          float weight = tap[static_cast<std::size_t>(std::abs(u))] * tap[static_cast<std::size_t>(std::abs(v))] *
                         faces.likeness(i, k, 2 * step);
          if (weight <= 0.0f) continue;
          if (by_light) {
            const float apart = from.light[k].mean() - from.light[i].mean();
            if (k != i) weight *= close(apart, from.variance[i] + from.variance[k]);
          }
          weights += weight;
          light += weight * from.light[k];
          variance += (by_light ? weight * weight : weight) * from.variance[k];
        }
      }
      to.variance[i] = variance / (by_light ? weights * weights : weights);
      if (by_light) to.light[i] = light / weights;
    }
  });
}

/// Mean of the pixels around, because the difference of two halves of the paths says little about a single pixel.
float variance_around(const Faces& faces, int x, int y, const std::vector<float>& variance) {
  float sum = 0.0f, count = 0.0f;
  for (int v = std::max(y - 2, 0); v <= std::min(y + 2, faces.height() - 1); ++v)
    for (int u = std::max(x - 2, 0); u <= std::min(x + 2, faces.width() - 1); ++u)
      sum += variance[faces.at(u, v)], count += 1.0f;
  return sum / count;
}

/// Light of a pixel across which faces meet: that of each on the pixels around that see it alone, by its share.
/// @return false  there are none of one of them, or it sees more than two
bool mix(const Faces& faces, int x, int y, const PathTracer::Grain& grain, const Image& image, Eigen::Array3f& light) {
  light = Eigen::Array3f::Zero();
  float shares = 0.0f;
  for (const PathTracer::Side& side : grain.sides) {
    if (side.share == 0.0f) continue;
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    float count = 0.0f;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, faces.height() - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, faces.width() - 1); ++u) {
        const std::size_t k = faces.at(u, v);
        if (faces.whole(k) && faces.sees(k, side)) sum += image.light[k], count += 1.0f;
      }
    }
    if (count == 0.0f) return false;
    light += side.share / count * sum;
    shares += side.share;
  }
  if (shares < 0.9f) return false;  // a third face, or nothing, takes a tenth and more
  light /= shares;
  return true;
}

}  // namespace

void denoise(const View& view, const std::vector<PathTracer::Grain>& grain, std::vector<Rgb>& radiance) {
  const Faces faces(view, grain);
  Image image;
  for (const PathTracer::Grain& g : grain) image.variance.push_back(g.variance);
  for (const Rgb& rgb : radiance) image.light.push_back(rgb.cast<float>());
  Image next = image;
  // Of two halves of the paths variance is only known roughly: it is averaged first. A grain that is brighter than
  // those around keeps its own, or none of them would be like it.
  const std::vector<float> own = image.variance;
  for (const int step : {1, 2}) average(faces, step, false, image, next), std::swap(image, next);
  for (std::size_t i = 0; i < own.size(); ++i) image.variance[i] = std::max(image.variance[i], own[i]);
  for (int pass = 0; pass < passes; ++pass) average(faces, 1 << pass, true, image, next), std::swap(image, next);
  in_parallel(static_cast<std::size_t>(faces.height()), [&](std::size_t row) {
    for (int x = 0; x < faces.width(); ++x) {
      const std::size_t i = faces.at(x, static_cast<int>(row));
      Eigen::Array3f mixed;
      if (faces.whole(i))
        radiance[i] = image.light[i].cast<double>();
      else if (const int y = static_cast<int>(row); mix(faces, x, y, grain[i], image, mixed)) {
        // A small facet of polished metal may have no like beside it: there, the pixel's own light is the better one.
        const float share = close(mixed.mean() - image.light[i].mean(), variance_around(faces, x, y, own));
        radiance[i] = ((1.0f - share) * image.light[i] + share * mixed).cast<double>();
      }
    }
  });
}

}  // namespace bin_scenes
