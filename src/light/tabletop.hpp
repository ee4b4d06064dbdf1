/// The table on which a bin stands, as pictures show it: an endless plane below everything, with light and dark
/// patches. Only pictures see it. Depth and labels show nothing there.
#pragma once

#include "bin_scenes/raster/scenery.hpp"

#include <cstdint>

namespace bin_scenes {

class Tabletop {
 public:
  struct Settings {
    double albedo = 0.0;     ///< 0: there is no table
    double height = -0.005;  ///< m, z in the bin frame
    double mottle = 0.0;     ///< largest deviation of the albedo / albedo
    double patch = 0.05;     ///< m, size of the largest patches
    double roughness = 0.5;  ///< as Surface::roughness
    double gloss = 0.0;      ///< as Surface::gloss
  };
  static constexpr std::int32_t line = -2;  ///< Hit::line of the table

  Tabletop(const Settings& settings, std::uint64_t key) : settings_(settings), key_(key) {}
  bool there() const { return settings_.albedo > 0.0; }
  /// Replaces the hit of a ray if the table is nearer. @param nothing  hit of a ray that meets nothing
  void cover(const Ray& ray, const Hit& nothing, Hit& hit) const;
  /// Whether the table is between the ends of a ray.
  bool blocks(const Ray& ray) const;
  Surface surface(const Vec3& point) const;

 private:
  Settings settings_;
  std::uint64_t key_;
};

}  // namespace bin_scenes
