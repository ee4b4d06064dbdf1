/// The part of the sensor model `structured_light` that sees pixels near edges: it divides them into cells of a
/// sixteenth of a pixel and sums the light over these. Pixels that see one face in even light do not need it
/// (structured_light.hpp).
#pragma once

#include "core/in_parallel.hpp"
#include "sensor/models/cells.hpp"
#include "sensor/models/structured_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace bin_scenes {

/// Some rows of the image, and what their pixels near edges see. A pixel is *uneven* if a neighbour is off its face, is
/// lit differently or has another surface, and if rays through its corners confirm it. If these rays meet an edge, all
/// cells of the pixel are sampled by rays. If they meet faces that bend gently, the cells are interpolated between
/// centre and corners. If an edge runs just between two pixels, the cells are on the pixel's face. The cells of
/// neighbours within the reach of the blur follow from their faces.
class StructuredLight::Strip {
 public:
  static constexpr int per_pixel = cells::per_pixel;
  using Values = Eigen::Array<float, per_pixel, 1, Eigen::DontAlign>;  ///< one value for each cell
  /// White light of each cell, times the cosine and the sine of the phase of a fringe.
  struct Phasors {
    Values cosine, sine;
  };
  /// Light and depth of the cells of one pixel. White is 0 in cells that the projector does not light.
  struct Cells {
    Values column, white, depth;
    Phasors phasors;
    int brightest = 0;     ///< index of the brightest cell
    float diffuse = 0.0f;  ///< mean share of ambient light that is reflected
    bool outside = false;  ///< whether some of the pixel is outside the projector's field
  };

  /// Prepares the rows from `first` to last - 1 of the image.
  Strip(const StructuredLight& model, int first, int last);

  /// Whether the light of a pixel in the rows of this strip has to be summed over cells.
  bool near_edge(std::size_t index) const { return near_[index - origin_] != 0; }
  /// Returns the weighted sum over the cells within reach of the blur; calls use(cells, weights) for each lit pixel.
  template <class Use>
  Blend blend(const Pixel& pixel, const Use& use) const;

 private:
  struct Place {
    std::size_t index;  ///< pixel
    int cell;           ///< index of the cell in its pixel
  };
  struct Seen {
    double depth;
    Lit lit;
    std::int32_t line;
    double diffuse;  ///< share of ambient light that is reflected
  };

  std::vector<char> uniform(int first, int last) const;
  float off_face(const Pixel& pixel, int right, int down, const Cells& cells, const Values& weight) const;
  void alike(std::size_t a, std::size_t b, int count, char* out) const;
  bool differ(std::size_t a, std::size_t b) const;
  bool differs(int x, int y) const;
  double hidden_step(const Pixel& pixel) const;
  void first_hits(const std::vector<Place>& places, const std::vector<Ray>& rays, std::vector<Hit>& hits) const;
  std::vector<Seen> cast(const std::vector<Place>& places) const;
  /// even: corners on the pixel's face; beside: edge next to it; bent: gentle bend; mixed: removed; crossed: edge.
  enum class Kind { even, beside, bent, mixed, crossed };
  struct Uneven {
    std::size_t index;  ///< pixel
    Kind kind;
    std::array<Seen, 4> corners;
  };
  Kind kind_of(const Pixel& pixel, const Seen* corners) const;
  std::vector<Uneven> uneven_pixels() const;
  void add_beside(int from, int to, const std::vector<Uneven>& even, std::vector<Uneven>& uneven) const;
  bool edge_between(std::size_t a, std::size_t b) const;
  void add_crossed(const std::vector<const Uneven*>& pixels);
  void add_mixed(const Uneven& pixel);
  void add_seen(std::size_t index, const std::array<Seen, per_pixel>& seen);
  Cells flat(const Pixel& pixel, const Vec2& slope) const;
  void add_flat(std::size_t index);
  void add_bent(const Uneven& pixel);
  void add(std::size_t index, Cells& cells);
  Phasors phasors(const Cells& cells, double turn) const;

  const StructuredLight& model_;
  int width_, height_, reach_;
  int first_, last_;    ///< rows whose pixels are read
  int top_, bottom_;    ///< rows whose cells the pixels of these rows need
  std::size_t origin_;  ///< index of the first pixel of row top_
  std::vector<char> near_;
  std::vector<std::int32_t> cells_of_;  ///< index into cells_ by pixel; -1: none
  std::vector<Cells> cells_;
  std::vector<Phasors> second_;  ///< phasors of the second fringe, by cells; empty: there is none
  Values across_, down_;         ///< positions of the cells in their pixel, -0.5 to 0.5
  std::vector<Values> weights_;  ///< weights of the cells of pixels from -reach_ to reach_, row-major; their sum is 1
  std::vector<float> shares_;    ///< for each element of weights_: the sum of its 16 weights
};

/// The light of a pixel near an edge.
struct StructuredLight::Blend {
  static constexpr double tolerated = 0.03;       ///< largest off_share of a pixel that is not mixed
  double white = 0.0;                             ///< mean of the projector's white light over the pixel's footprint
  double cosine = 0.0, sine = 0.0;                ///< phasor of the fringe
  double second_cosine = 0.0, second_sine = 0.0;  ///< phasor of the second fringe, if there is one
  double column = 0.0;                            ///< projector column of the brightest cell
  double diffuse = 0.0;                           ///< share of ambient light that is reflected
  double off_share = 0.0;  ///< share of the footprint on other faces, farther than edge_step from this one; the
                           ///< sum ends as soon as it exceeds `tolerated`
  bool outside = false;    ///< whether some of the footprint is outside the projector's field
};

template <class Use>
StructuredLight::Blend StructuredLight::Strip::blend(const Pixel& pixel, const Use& use) const {
  const int x = static_cast<int>(pixel.index) % width_, y = static_cast<int>(pixel.index) / width_;
  Blend out;
  float brightest = 0.0f, total = 0.0f;
  for (int v = std::max(0, y - reach_); v <= std::min(height_ - 1, y + reach_); ++v) {
    for (int u = std::max(0, x - reach_); u <= std::min(width_ - 1, x + reach_); ++u) {
      const std::int32_t at = cells_of_[static_cast<std::size_t>(v) * width_ + u - origin_];
      const auto place = static_cast<std::size_t>((v - y + reach_) * (2 * reach_ + 1) + u - x + reach_);
      const Values& weight = weights_[place];
      const float share = shares_[place];
      total += share;
      if (at < 0) {  // the pixel sees nothing
        out.off_share += share;
        continue;
      }
      const Cells& own = cells_[static_cast<std::size_t>(at)];
      out.diffuse += share * own.diffuse;
      out.outside = out.outside || (own.outside && share > 0.01f);
      const bool beside = std::abs(u - x) <= 1 && std::abs(v - y) <= 1;
      if (beside && out.off_share <= Blend::tolerated) out.off_share += off_face(pixel, u - x, v - y, own, weight);
      const float light = weight[own.brightest] * own.white[own.brightest];
      if (light <= 0.0f) continue;
      out.white += (weight * own.white).sum();
      out.cosine += (weight * own.phasors.cosine).sum();
      out.sine += (weight * own.phasors.sine).sum();
      if (!second_.empty()) {
        const Phasors& second = second_[static_cast<std::size_t>(at)];
        out.second_cosine += (weight * second.cosine).sum();
        out.second_sine += (weight * second.sine).sum();
      }
      if (light > brightest) {
        brightest = light;
        out.column = own.column[own.brightest];
      }
      use(own, weight);
    }
  }
  out.off_share /= total;
  return out;
}

/// Processes all rows in parallel, in strips: calls work(strip, first row, last row + 1) for each of them.
template <class Work>
void StructuredLight::in_strips(const Work& work) const {
  constexpr int rows = 32;
  const int height = view_.lens.height;
  in_parallel(static_cast<std::size_t>((height + rows - 1) / rows), [&](std::size_t k) {
    const int first = static_cast<int>(k) * rows, last = std::min(first + rows, height);
    work(Strip(*this, first, last), first, last);
  });
}

}  // namespace bin_scenes
