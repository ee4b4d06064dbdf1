/// Random points of the unit square for the paths of an image. Paths of one pixel, and of neighbouring pixels, get
/// points that fill the square evenly, so that their mean has less noise than that of independent points.
///
/// The points are a Sobol sequence. It runs through the pixels of a tile along a Z-shaped curve, so that a pixel and
/// any square of 2 x 2, 4 x 4, ... pixels gets a run of the sequence that is a net (Ahmed, Wonka 2020, "Screen-space
/// blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels"). Sequence and points are
/// scrambled, which keeps the nets (Owen 1995, "Randomly permuted (t,m,s)-nets and (t,s)-sequences"). A path needs
/// several points, one for each decision. Each decision has a sequence scrambled by itself, so that its points do not
/// depend on those of the other decisions (Burley 2020, "Practical hash-based Owen scrambling").
#pragma once

#include "bin_scenes/core/random.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes {

class EvenPoints {
 public:
  /// @param decisions  number of decisions of a path
  EvenPoints(const Random& key, int decisions) : key_(key), decisions_(decisions) {}

  /// The points of one row of pixels.
  class Row {
   public:
    /// Returns a point of the unit square.
    /// @param number  number of the point, below `count`
    /// @param count   number of points of each pixel for this decision, a power of two below 2^22
    Eigen::Vector2d at(std::size_t column, int decision, std::uint32_t number, std::uint32_t count) const;

   private:
    friend class EvenPoints;
    struct Scramble {
      std::uint32_t order, x, y;
    };
    int decisions_ = 0;
    std::vector<std::uint32_t> places_;  ///< by column: number of the pixel in its tile
    std::vector<Scramble> scrambles_;    ///< by tile of the row and decision
  };
  /// Fills in the points of a row with so many pixels. @param row  keeps its memory from call to call
  void begin(Row& row, std::size_t index, std::size_t width) const;

 private:
  Random key_;
  int decisions_;
};

}  // namespace bin_scenes
