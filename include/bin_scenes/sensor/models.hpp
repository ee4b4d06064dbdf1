/// From the view of a camera to the image that a sensor reports. This header contains the inputs that all sensor models
/// share, and measure(), which calls the model of a sensor. src/sensor/models has one file for each model.
#pragma once

#include "bin_scenes/light/surfaces.hpp"
#include "bin_scenes/raster/view.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <cstddef>
#include <cstdint>

namespace bin_scenes {

/// What is made of a view of a sensor: the key from which all its random numbers in a scene are derived, and whether a
/// grey image is made as well.
struct Draw {
  std::uint64_t seed = 0;
  std::size_t scene = 0;   ///< index of the scene
  std::size_t sensor = 0;  ///< index of the sensor in the request
  bool gray = true;        ///< whether RangeImage::gray is made; nothing else depends on it
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
