/// From the view of a camera to the report of a sensor. src/sensor/models has one file for each model.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "bin_scenes/sensor/view.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

struct Surfaces {
  std::vector<Surface> lines;  ///< by part line
  Surface bin;
  /// What distinguishes the surface of one part from that of another part of its line.
  struct Place {
    Pose to_part;       ///< from the bin frame to the part's
    Vec3 longest;       ///< unit, axis in the part's frame
    std::uint64_t key;  ///< of its texture
  };
  std::vector<Place> places = {};  ///< by label; none: no texture, and Surface::along is in the bin frame

  const Surface& of(std::int32_t line) const { return line < 0 ? bin : lines[static_cast<std::size_t>(line)]; }
  /// The surface at a point, its `along` in the bin frame.
  /// @param own  room for it where it differs from of(line)
  const Surface& at(std::int32_t line, std::uint16_t label, const Vec3& point, Surface& own) const {
    const Surface& even = of(line);
    if ((!even.texture.any() && even.anisotropy <= 0.0) || label >= places.size()) return even;
    own = own_surface(even, places[label], point);
    return own;
  }

 private:
  static Surface own_surface(const Surface& even, const Place& place, const Vec3& point);
};
/// Surfaces of the request's lines, without the textures of single parts.
Surfaces surfaces_of(const Request& request);
/// The same with the texture of each part of the scene, which is the same for all sensors.
Surfaces surfaces_of(const Scene& scene, const LoadedRequest& loaded);

/// The key from which all random numbers of a sensor in a scene are drawn.
struct Draw {
  std::uint64_t seed = 0;
  std::size_t scene = 0;   ///< index
  std::size_t sensor = 0;  ///< number in the request
};

/// Makes the measured and the true images; the caller fills in counts and silhouettes. @param sensor  resolved()
/// @param view  of the sensor's camera, near to far; its images may be taken over
RangeImage measure(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                   const Draw& draw);

/// Standard deviation of the depth (m) of a matte plate on the optical axis; 0 of `ideal`, NaN where nothing is
/// measured.
/// @param sensor     resolved()
/// @param distance   m along the optical axis
/// @param incidence  rad, by which the plate is turned about the camera's x
double predicted_sigma(const Sensor& sensor, double distance, double incidence, double albedo);

}  // namespace bin_scenes
