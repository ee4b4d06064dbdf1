/// Errors of a sensor's calibration: what its software believes of lens, baseline and pose is the request; the true
/// device is drawn around it, once a seed. What a pixel sees is the true device's; the point that it reports is the
/// believed one's.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

#include <cstdint>
#include <vector>

namespace bin_scenes {

/// Standard deviations; 0 = exact. Kept in Sensor::settings.
struct CalibrationSettings {
  double focal = 0.0;     ///< pixel, of fx; fy errs by the same share
  double center = 0.0;    ///< pixel, of cx and of cy
  double baseline = 0.0;  ///< m, of the distance from the camera to projector, laser or second camera
  double position = 0.0;  ///< m, of the whole device along each axis of its optical frame
  double rotation = 0.0;  ///< rad, of the whole device about each
  double range = 0.0;     ///< m, of an offset of all ranges along their rays, where nothing is triangulated; of a
                          ///< true_device() the offset itself
  bool any() const {
    return focal > 0.0 || center > 0.0 || baseline > 0.0 || position > 0.0 || rotation > 0.0 || range > 0.0;
  }
};

/// sensors[number] as it truly is; a copy if it has no such errors. Views of one sensor share lens and baseline; each
/// has a pose of its own. @param sensors  resolved()
Sensor true_device(const std::vector<Sensor>& sensors, std::size_t number, std::uint64_t seed);

/// Turns the points that `device` measured into those that it reports, in its unit of depth (DepthFormat).
/// @param image  of `device`
void report_as_believed(RangeImage& image, const Sensor& device, const Sensor& believed);

}  // namespace bin_scenes
