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
    double blur;   ///< pixel, standard deviation of the lens's blur
    double sheet;  ///< m, standard deviation across the sheet
  };
  /// A point where a ray of the fan hit a surface.
  struct Source {
    SeenPoint point;
    double flux;  ///< light of the sheet between this ray and the next: signal of a white surface that faces the laser,
                  ///< times m^2
    double apart;  ///< m, to where the next ray passes
  };
  SheetGlow(const Scenery& scenery, const Surfaces& surfaces, const Camera& camera);

  /// Adds light of `count` rays from all sources.
  /// @param view     of the camera
  /// @param laser    from where the sources are lit
  /// @param bounces  other surfaces that light meets after the first one, at most
  void follow(const Pose& view, const Vec3& laser, const std::vector<Source>& sources, std::size_t count, int bounces,
              Random key);

  /// Signal of a pixel (integers: its centre); 0 outside the image.
  double at(int sample, int across) const;
  /// The brightest pixel of a sample that lies in no range [first, second] of `taken`; -1: none has `least`.
  int brightest(int sample, double least, const std::vector<std::pair<int, int>>& taken) const;

 private:
  /// Signals in cells of the image, as tents between them.
  class Grid {
   public:
    Grid(int samples, int across, int tall, int wide);
    /// @param along, across  half widths of the spot (pixel)
    void add(double sample, double place, double along, double across, double light);
    double at(double sample, double place) const;
    double most(double sample) const;  ///< no pixel of the sample has more

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
  Grid fine_, coarse_;  ///< light of narrow and of wide spots
};

}  // namespace bin_scenes
