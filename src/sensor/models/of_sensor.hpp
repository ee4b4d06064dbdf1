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

/// Throws an input Error that names `key` if the baseline (m) is 0.
void check_baseline(const std::string& key, double baseline);

IndirectField::Setup indirect_of(const Sensor& sensor);
Random random_of(const Draw& draw);
/// Returns the random numbers for the samples of indirect light.
Random rays_of(const Draw& draw);
/// Copies the true depth of the view to the image, and moves its true labels there.
void add_truth(RangeImage& image, View&& view);
RangeImage image_of(View&& view, Measurement&& measured);
/// Returns the image of a measurement. If Draw::gray is set, it has a grey image, made from Measurement::light.
/// @param noise  whether the grey image has the noise of the camera
RangeImage image_with_gray(View&& view, Measurement&& measured, const Sensor& sensor, bool noise, const Draw& draw);
/// Measures with a model that supports both fidelities, in the fidelity that the sensor requests.
template <class Model>
RangeImage image_by(const Model& model, const Sensor& sensor, View&& view, const Draw& draw) {
  const Random random = random_of(draw);
  const bool decoded = sensor.fidelity == Fidelity::decoded;
  return image_with_gray(std::move(view), decoded ? model.decoded(random) : model.analytic(random), sensor,
                         sensor.noise, draw);
}

/// A plate that fills any view: `distance` (m) along the optical axis, turned by `incidence` (rad) about camera x.
struct Plate {
  Plate(const Sensor& sensor, double distance, double incidence, double albedo);
  /// Returns a view of 9 x 9 pixels around the centre of the image, as many as measuring the central pixel requires.
  View seen_at_center() const;

  Targets targets;
  const Scenery scenery;
  const Surfaces surfaces;

 private:
  const Sensor& sensor_;
};

}  // namespace bin_scenes
