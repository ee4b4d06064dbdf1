/// The optical surfaces of a scene, with the texture of each part. How much light a surface reflects from one direction
/// into another is computed in src/light.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/raster/scenery.hpp"
#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The optical surfaces of a scene.
struct Surfaces {
  std::vector<Surface> lines;  ///< surfaces of the part lines
  Surface bin;
  /// The pose of a part, and the random key of its texture. By these two, its surface differs from the surfaces of
  /// other parts of the same line.
  struct Place {
    Pose to_part;       ///< from the bin frame to the frame of the part
    Vec3 longest;       ///< unit vector, longest axis of the part in the part's frame
    std::uint64_t key;  ///< key of the random numbers of its texture
  };
  /// One entry for each label. Empty: surfaces have no texture, and Surface::along is in the bin frame.
  std::vector<Place> places = {};
  Table table = {};
  std::uint64_t table_key = 0;  ///< key of the random numbers of the table's patches

  /// Returns the surface of a part line, of the bin if `line` is -1, or of the table if it is Scenery::table_line.
  const Surface& of(std::int32_t line) const {
    if (line >= 0) return lines[static_cast<std::size_t>(line)];
    return line == Scenery::table_line ? table.surface : bin;
  }
  /// Whether at() differs from of() in albedo at some points.
  bool vary() const;
  /// Returns the surface at a point (bin frame), with `along` in the bin frame.
  /// @param own  storage for the surface if it differs from of(line)
  const Surface& at(std::int32_t line, std::uint16_t label, const Vec3& point, Surface& own) const {
    const Surface& even = of(line);
    const bool patched = line == Scenery::table_line && table.mottle > 0.0;
    const bool own_place = (even.texture.any() || even.anisotropy > 0.0) && label < places.size();
    if (!patched && !own_place) return even;
    own = patched ? table_at(point) : even;
    if (own_place) own = own_surface(own, places[label], point);
    return own;
  }

 private:
  Surface table_at(const Vec3& point) const;
  static Surface own_surface(const Surface& even, const Place& place, const Vec3& point);
};
/// Returns the surfaces of the part lines, without the textures of single parts.
Surfaces surfaces_of(const Request& request);
/// Returns the surfaces with the texture of each part of the scene. The texture is the same for all sensors.
Surfaces surfaces_of(const Scene& scene, const LoadedRequest& loaded);

}  // namespace bin_scenes
