/// The radiance that reaches the pixels of a camera after up to two reflections at other surfaces (Kajiya 1986, "The
/// rendering equation"). Where a path meets a surface, a random point on a lamp is tested for visibility, and a
/// direction of the surface's lobe is followed. The results of both methods are weighted by how likely each was to find
/// the path (multiple importance sampling). On matte surfaces, only the points on lamps are used.
///
/// From the second surface on, mirrors are at least as rough as Setup::soft. Otherwise the few paths that find a lamp
/// via two mirrors would be bright grains (Kaplanyan, Dachsbacher 2013, "Path space regularization for holistic and
/// robust light transport").
///
/// At each surface, a path does both. The random points are distributed evenly over the paths of a pixel and of its
/// neighbours (even_points.hpp). Most of the noise of a heap comes from light that bounces, so that all paths of a
/// pixel continue to further surfaces.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "light/bevel.hpp"
#include "light/even_points.hpp"
#include "light/illumination.hpp"
#include "light/lamps.hpp"
#include "light/lobe.hpp"
#include "raster/spots.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace bin_scenes {

class PathTracer {
 public:
  struct Setup {
    int samples = 16;              ///< number of paths for each pixel, a power of two
    int bounces = 1;               ///< largest number of other surfaces that reflect light to the visible one
    double blur = 0.0;             ///< pixels, standard deviation of the blur of the lens
    double near = 0.0, far = 1e9;  ///< m, range of depths that the camera sees
    double aperture = 0.0;         ///< m, diameter of the lens's opening; 0: a pinhole
    double focus = 1.0;            ///< m, depth at which the image is sharp
    double soft = 0.5;             ///< smallest roughness of shiny surfaces from the second surface on
    const Bevels* bevels = nullptr;
    enum class By { both, lamps, lobe } by = By::both;  ///< how lamps are found; tests compare these methods
  };
  PathTracer(const Scenery& scenery, const Lens& lens, const Pose& pose, const Surfaces& surfaces, const Lamps& lamps,
             const Setup& setup, const Random& key);

  static constexpr double bends = 0.82;  ///< cosine of 35 degrees, the largest angle between faces of one side
  /// One side of an edge that crosses a pixel: a group of connected faces of one part that some paths of the pixel see.
  struct Side {
    Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = point;  ///< a point of it (m); unit normal; bin frame
    std::uint16_t label = 0;
    float share = 0.0f;  ///< share of the pixel's paths that see this side
    /// Whether a point with this normal and label is on this side. @param off  largest distance (m) from its plane
    bool takes(const Eigen::Vector3f& other, const Eigen::Vector3f& its_normal, std::uint16_t of, float off) const;
  };
  /// The uncertainty of the radiance of a pixel.
  struct Grain {
    /// Variance of the mean of red, green and blue if the paths were independent, estimated from the difference of two
    /// halves of them. Even points err by less, by an amount that the paths of one pixel do not show.
    float variance = 0.0f;
    std::array<Side, 2> sides = {};  ///< the first two sides that paths see; shares of further sides are missing
    bool one_face() const { return sides[0].share == 1.0f; }
  };
  /// Returns the mean radiance of each pixel of a row of the image.
  /// @param grain  output, unless null: the uncertainty of each pixel of the row
  std::vector<Rgb> row(std::size_t row, Grain* grain = nullptr) const;

 private:
  struct Vertex {
    Vec3 position = Vec3::Zero(), face = position, normal = position;  ///< `normal`: smooth normal, for shading
    Vec3 to_eye = Vec3::Zero();
    std::int32_t line = -1;
    std::uint16_t label = 0;
    std::uint32_t pixel = 0, sample = 0;  ///< index of the pixel in the block, and of the sample in the pixel
    Rgb weight = Rgb::Ones();
  };
  struct Row;
  struct Block;

  const Surface& surface_of(const Vertex& vertex, int bounce, Surface& own) const;
  /// Whether lamps found along the lobe and points drawn on lamps are weighted (multiple importance sampling).
  bool mirrors(const Surface& surface, int bounce) const {
    return surface.gloss > 0.0 && (bounce == 0 || setup_.soft < 0.5);
  }
  Eigen::Vector2d drawn(const Row& row, std::size_t column, int decision, std::uint32_t sample) const;
  Eigen::Vector2d drawn(const Block& block, const Vertex& vertex, int decision) const;
  void see(Row& row) const;
  void begin(Block& block, const Row& row, std::size_t first, std::size_t count) const;
  void add_seen(Block& block) const;
  std::array<Side, 2> sides_of(const Block& block, std::size_t pixel) const;
  void leave(Block& block, int bounce) const;
  void ask_lamp(Block& block, const Vertex& vertex, const Surface& surface, const Lobe* lobe, int bounce) const;
  void follow(Block& block, const Vertex& vertex, const Surface& surface, const Lobe& lobe, int bounce) const;
  void find_lit(Block& block, int bounce) const;
  void find_ends(Block& block) const;
  Lamps::Met weight_of(bool mirrors) const;
  void find_blocked(const std::vector<Ray>& rays, std::vector<std::uint8_t>& blocked, Scenery::Rays kind) const;
  Ray ray_of(const Row& row, std::size_t column, std::uint32_t sample) const;
  void add_vertex(std::vector<Vertex>& to, const Ray& ray, const Hit& hit, Vertex vertex) const;

  const Scenery& scenery_;
  Lens lens_;
  Pose pose_;
  Mat3 turn_;
  const Surfaces& surfaces_;
  Surfaces soft_;  ///< surfaces with at least the roughness Setup::soft, for hits that the camera does not see
  const Lamps& lamps_;
  Setup setup_;
  EvenPoints points_;
  SpotDrawing spots_;
};

}  // namespace bin_scenes
