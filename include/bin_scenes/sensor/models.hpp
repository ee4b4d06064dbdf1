/// From the view of a camera to the image that a sensor reports. This header contains the inputs that all sensor models
/// share, and measure(), which calls the model of a sensor. src/sensor/models has one file for each model.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "bin_scenes/sensor/view.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// The optical surfaces of a scene.
struct Surfaces {
  std::vector<Surface> lines;  ///< by part line
  Surface bin;
  /// The position of a part, and the key of its texture: they distinguish its surface from those of other parts of the
  /// same line.
  struct Place {
    Pose to_part;       ///< from the bin frame to the frame of the part
    Vec3 longest;       ///< unit vector, longest axis of the part in the part's frame
    std::uint64_t key;  ///< key of the random numbers of its texture
  };
  /// By label. Empty: surfaces have no texture, and Surface::along is in the bin frame.
  std::vector<Place> places = {};

  /// Returns the surface of a part line, or of the bin if `line` is -1.
  const Surface& of(std::int32_t line) const { return line < 0 ? bin : lines[static_cast<std::size_t>(line)]; }
  /// Returns the surface at a point (bin frame), with `along` in the bin frame.
  /// @param own  storage for the surface if it differs from of(line)
  const Surface& at(std::int32_t line, std::uint16_t label, const Vec3& point, Surface& own) const {
    const Surface& even = of(line);
    if ((!even.texture.any() && even.anisotropy <= 0.0) || label >= places.size()) return even;
    own = own_surface(even, places[label], point);
    return own;
  }

 private:
  static Surface own_surface(const Surface& even, const Place& place, const Vec3& point);
};
/// Returns the surfaces of the part lines, without the textures of single parts.
Surfaces surfaces_of(const Request& request);
/// Returns the surfaces with the texture of each part of the scene. The texture is the same for all sensors.
Surfaces surfaces_of(const Scene& scene, const LoadedRequest& loaded);

/// The key from which all random numbers of a sensor in a scene are derived.
struct Draw {
  std::uint64_t seed = 0;
  std::size_t scene = 0;   ///< index
  std::size_t sensor = 0;  ///< index in the request
};

/// Makes the measured and the true images. The caller fills in pixel counts and silhouettes afterwards.
/// @param view  view of the sensor's camera from near to far; its images may be moved out of it
/// @param sensor  as returned by resolved()
RangeImage measure(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                   const Draw& draw);

/// Returns the predicted standard deviation of the depth (m) of a matte plate on the optical axis: 0 for the model
/// `ideal`, NaN if nothing is measured.
/// @param sensor     as returned by resolved()
/// @param distance   m along the optical axis
/// @param incidence  rad, angle by which the plate is turned about the camera's x axis
double predicted_sigma(const Sensor& sensor, double distance, double incidence, double albedo);

}  // namespace bin_scenes
