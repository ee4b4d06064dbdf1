/// A camera at the origin that looks along z, and what it is shown.
#pragma once

#include "bin_scenes/scene/request.hpp"
#include "bin_scenes/sensor/view.hpp"
#include "sensor/models/measurement.hpp"
#include "sensor/targets.hpp"

#include <string>
#include <vector>

namespace bin_scenes::bench {

/// With K and poses filled in; projector and laser are turned towards the point at `distance` (m) on the optical axis.
Sensor sensor_of(const std::string& model, double distance);

/// A large plate through (0, 0, z), turned about the camera's x: incidence of light and of sight alike.
Targets plate(double z, double degrees, double albedo);
/// A white ball and a dark block on a plate, about 1 m away.
Targets still_life();

/// An image by structured light or stereo, beside the truth and the standard deviation of depth that the model's
/// formula predicts for each pixel (m).
struct Shot {
  View view;
  Measurement measured{0};
  std::vector<double> sigma;
};
Shot shoot(Targets& targets, const Sensor& sensor, std::uint64_t seed);

/// |error| of depth of all valid pixels (m), sorted.
std::vector<double> sorted_errors(const Shot& shot);
/// Value at a share of a sorted list; NaN of an empty one.
double quantile(const std::vector<double>& sorted, double share);

}  // namespace bin_scenes::bench
