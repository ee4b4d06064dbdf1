/// Errors of the calibration of a sensor. The request contains what the software of the sensor assumes about lens,
/// baseline and pose; the true device is drawn around these values, once for each seed. A pixel sees what the true
/// device sees, and the point that is reported is computed with the assumed values. The true images are not affected.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Standard deviations of the errors; 0 means exact. The struct is stored in Sensor::settings.
struct CalibrationSettings {
  double focal = 0.0;     ///< error of fx (pixels); fy has the same relative error
  double center = 0.0;    ///< error of cx and of cy (pixels)
  double baseline = 0.0;  ///< error of the distance (m) from the camera to the projector, laser or second camera
  double position = 0.0;  ///< error of the device's position (m) along each axis of its optical frame
  double rotation = 0.0;  ///< error of the device's rotation (rad) about each axis
  double range = 0.0;  ///< m, of a constant offset of all ranges along their rays, for sensors that do not triangulate;
                       ///< in the result of true_device() it is the offset itself
  bool any() const {
    return focal > 0.0 || center > 0.0 || baseline > 0.0 || position > 0.0 || rotation > 0.0 || range > 0.0;
  }
};

/// Returns sensors[number] as it truly is, or a copy if it has no such errors. The views of one sensor have the same
/// lens and baseline errors; each has its own pose error. @param sensors  as returned by resolved()
Sensor true_device(const std::vector<Sensor>& sensors, std::size_t number, std::uint64_t seed);

/// Converts the points that `device` measured into those that it reports, in its unit of depth (DepthFormat).
/// @param image  image that `device` measured
void report_as_believed(RangeImage& image, const Sensor& device, const Sensor& believed);

}  // namespace bin_scenes
