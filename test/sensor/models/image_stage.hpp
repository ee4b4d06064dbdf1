/// A camera of the model `image` before a plate, and the radiance that it sees.
#pragma once

#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "light/path_tracer.hpp"
#include "sensor/targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bin_scenes::test {

using By = PathTracer::Setup::By;

/// A camera at the origin that looks along z at what lies around there.
inline Sensor camera(const std::vector<ImageLamp>& lamps, int width = 9, int height = 9, double fov = 0.02) {
  Sensor sensor;
  sensor.model = "image";
  sensor.width = width, sensor.height = height;
  sensor.fov = fov;
  sensor.pose = Pose();
  sensor.near = 0.01;
  sensor.settings.of<ImageSettings>().lamps = lamps;
  sensor.imager.ambient = 0.0;
  Bin bin;
  bin.kind = Bin::Kind::none;
  return resolved(sensor, bin);
}

inline Lamps lamps_of(const Sensor& sensor) {
  return Lamps(sensor.settings.of<ImageSettings>().lamps, sensor);
}

inline ImageLamp dome(double radiance) {
  ImageLamp lamp;
  lamp.type = ImageLamp::Type::dome;
  lamp.radiance = radiance;
  lamp.horizon = 1.0;
  return lamp;
}

inline ImageLamp flat(ImageLamp::Type type, const Vec3& middle, const Quat& turn = Quat::Identity()) {
  ImageLamp lamp;
  lamp.type = type;
  lamp.pose = Pose{middle, turn};
  return lamp;
}

/// A plate that faces the camera a metre away.
inline Targets plate(const Surface& surface, double size = 20.0) {
  Targets targets;
  targets.add(box_target({size, size, 0.1}), {Vec3(0.0, 0.0, 1.05), Quat::Identity()}, surface);
  return targets;
}

struct Mean {
  double value = 0.0, error = 0.0;  ///< and its standard error
};

/// Over all pixels, which see the same but for a hair.
inline Mean radiance(Targets& targets, const Sensor& sensor, int samples, int bounces, By by = By::both) {
  const Scenery scenery = targets.scenery();
  const Lamps lamps = lamps_of(sensor);
  PathTracer::Setup setup;
  setup.samples = samples, setup.bounces = bounces, setup.by = by;
  const PathTracer tracer(scenery, lens_of(sensor), *sensor.pose, targets.surfaces(), lamps, setup,
                          Random(3, 0, Stream::sensor));
  double sum = 0.0, square = 0.0, count = 0.0;
  for (int row = 0; row < sensor.height; ++row) {
    for (const Rgb& rgb : tracer.row(static_cast<std::size_t>(row))) {
      EXPECT_EQ(rgb.minCoeff(), rgb.maxCoeff());
      sum += rgb.mean(), square += rgb.mean() * rgb.mean(), count += 1.0;
    }
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(square / count - mean * mean, 0.0) / (count - 1.0))};
}

}  // namespace bin_scenes::test
