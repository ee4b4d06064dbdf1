/// From what a camera sees to what a sensor reports; src/sensor/models has one file a model.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"
#include "bin_scenes/sensor/view.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

struct Surfaces {
  std::vector<Surface> lines;  ///< by part line
  Surface bin;
  const Surface& of(std::int32_t line) const { return line < 0 ? bin : lines[static_cast<std::size_t>(line)]; }
};
Surfaces surfaces_of(const Request& request);

/// The key of all random numbers of a sensor in a scene.
struct Draw {
  std::uint64_t seed = 0;
  std::size_t scene = 0;   ///< index
  std::size_t sensor = 0;  ///< number in the request
};

/// Measured and true images; counts and silhouettes are the caller's. @param sensor  resolved()
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
