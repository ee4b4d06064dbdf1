/// The light of a laser sheet that reaches the camera via other surfaces. Where a shiny surface reflects the line
/// onto another surface, the camera sees a second line.
///
/// Light is followed from the line: rays of the fan continue from the surface that they meet, in random directions of
/// the surface's lobe, and light a spot on the next surface. Spots are large enough to touch each other (Schjoth et al.
/// 2007, "Photon differentials"), so that the line reflected by a mirror stays sharp while light from a matte surface
/// is smooth.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "light/illumination.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace bin_scenes {

class SheetGlow {
 public:
  struct Camera {
    Lens lens;
    bool upright;  ///< the line is vertical in the image, with one sample for each row
    double near, far;
    double blur;   ///< pixels, standard deviation of the blur of the lens
    double sheet;  ///< m, standard deviation of the thickness of the sheet of light
  };
  /// A point where a ray of the fan hit a surface.
  struct Source {
    SeenPoint point;
    double flux;   ///< light of the sheet between this ray and the next, in the unit signal of a white surface that
                   ///< faces the laser * m^2
    double apart;  ///< m, distance at which the next ray passes
  };
  SheetGlow(const Scenery& scenery, const Surfaces& surfaces, const Camera& camera);

  /// Follows `count` rays of reflected light from the sources, and adds the light that the camera sees of them.
  /// @param view     pose of the camera
  /// @param laser    position of the laser, which lights the sources
  /// @param bounces  largest number of further surfaces that the light meets after its source
  void follow(const Pose& view, const Vec3& laser, const std::vector<Source>& sources, std::size_t count, int bounces,
              Random key);

  /// Returns the signal of the reflected light in a pixel, along and across the line; 0 outside the image.
  double at(int sample, int across) const;
  /// Returns the brightest pixel of a sample outside the ranges [first, second] of `taken`; -1: none reaches `least`.
  int brightest(int sample, double least, const std::vector<std::pair<int, int>>& taken) const;

 private:
  /// Signals at the corners of cells of the image, with linear interpolation between them.
  class Grid {
   public:
    Grid(int samples, int across, int tall, int wide);
    /// Adds a spot of light. @param along, across  half widths of the spot (pixels)
    void add(double sample, double place, double along, double across, double light);
    double at(double sample, double place) const;
    double most(double sample) const;  ///< returns an upper limit of at() for all pixels of a sample

   private:
    int tall_, wide_, rows_, columns_;
    std::vector<float> cells_, most_;
    std::vector<double> shares_;
  };
  struct Flight;
  std::vector<Flight> take_off(const Vec3& laser, const std::vector<Source>& sources, std::size_t count,
                               double shift) const;
  void turn(std::vector<Flight>& flights, int bounce, const Eigen::Vector2d& shift) const;
  void fly(std::vector<Flight>& flights) const;
  void show(const Pose& view, const std::vector<Flight>& flights);

  const Scenery& scenery_;
  const Surfaces& surfaces_;
  Camera camera_;
  int samples_, across_;
  Grid fine_, coarse_;  ///< grids with small cells for narrow spots, and with large cells for wide spots
};

}  // namespace bin_scenes
