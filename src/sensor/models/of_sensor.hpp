/// Functions that the files *_model.cpp share: they convert the sensor of a request to the parameters of a model, and
/// the measurement of a model to an image.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "light/indirect_field.hpp"
#include "sensor/models/measurement.hpp"
#include "sensor/targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace bin_scenes {

extern const Names<MixedPixels> mixed_pixels;

/// Throws an input Error for a baseline of 0.
void check_baseline(const std::string& key, double baseline);

IndirectField::Setup indirect_of(const Sensor& sensor);
Random random_of(const Draw& draw);
/// The key of the random samples of indirect light.
Random rays_of(const Draw& draw);
/// Takes over the truth of the view.
void add_truth(RangeImage& image, View&& view);
RangeImage image_of(View&& view, Measurement&& measured);
/// Adds the grey image of a measurement with light, if it is wanted.
/// @param noise  whether the camera's noise is added
RangeImage image_with_gray(View&& view, Measurement&& measured, const Sensor& sensor, bool noise, const Draw& draw);
/// Measures with a model that supports both fidelities.
template <class Model>
RangeImage image_by(const Model& model, const Sensor& sensor, View&& view, const Draw& draw) {
  const Random random = random_of(draw);
  const bool decoded = sensor.fidelity == Fidelity::decoded;
  return image_with_gray(std::move(view), decoded ? model.decoded(random) : model.analytic(random), sensor,
                         sensor.noise, draw);
}

/// A plate large enough for any view, that far along the sensor's optical axis, turned about the camera's x.
struct Plate {
  Plate(const Sensor& sensor, double distance, double incidence, double albedo);
  /// Returns the view of the plate's centre, with as many pixels as the surroundings of one pixel need.
  View seen_at_center() const;

  Targets targets;
  const Scenery scenery;
  const Surfaces surfaces;

 private:
  const Sensor& sensor_;
};

}  // namespace bin_scenes
