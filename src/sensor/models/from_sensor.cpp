#include "sensor/models/from_sensor.hpp"

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "core/in_parallel.hpp"
#include "sensor/models/time_of_flight.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace bin_scenes {

namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Random random_of(const Draw& draw) {
  return Random(draw.seed, draw.scene, Stream::noise).of_piece(draw.sensor);
}

/// Of the samples of indirect light.
Random rays_of(const Draw& draw) {
  return Random(draw.seed, draw.scene, Stream::sensor).of_piece(draw.sensor);
}

IndirectField::Setup indirect_of(const Sensor& sensor, int by_default) {
  return {sensor.bounces.value_or(by_default), sensor.indirect_samples};
}

void add_truth(RangeImage& image, View&& view) {
  image.truth_depth.resize(view.depth.size());
  const auto width = static_cast<std::size_t>(view.lens.width);
  in_parallel(static_cast<std::size_t>(view.lens.height),
              [&](std::size_t row) { std::copy_n(&view.depth[row * width], width, &image.truth_depth[row * width]); });
  image.truth_label = std::move(view.label);
}

RangeImage image_of(View&& view, Measurement&& measured) {
  RangeImage image;
  image.width = view.lens.width;
  image.height = view.lens.height;
  image.intensity = std::move(measured.intensity);
  const std::size_t pixels = view.depth.size();
  image.depth.resize(pixels);
  image.label.resize(pixels);
  image.normal = std::move(view.normal);
  image.validity.resize(pixels);
  add_truth(image, std::move(view));
  const auto width = static_cast<std::size_t>(image.width);
  in_parallel(static_cast<std::size_t>(image.height), [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      const bool valid = measured.validity[i] == Validity::valid;
      image.validity[i] = static_cast<std::uint8_t>(measured.validity[i]);
      image.depth[i] = static_cast<float>(measured.depth[i]);
      image.label[i] = valid ? image.truth_label[i] : std::uint16_t{0};
    }
  });
  return image;
}

}  // namespace

StructuredLight::Setup structured_light_setup(const Sensor& s) {
  return {lens_of(s.projector),
          *s.projector.pose,
          s.structured_light,
          s.imager,
          s.noise,
          s.near,
          s.far,
          indirect_of(s, 1),
          s.fidelity == Fidelity::analytic};
}

Stereo::Setup stereo_setup(const Sensor& s) {
  return {lens_of(s.projector), *s.projector.pose, s.stereo, s.imager, s.noise, s.near, s.far, indirect_of(s, 0)};
}

LaserLine::Setup laser_line_setup(const Sensor& s) {
  const Vec3 way = s.scan.step * s.scan.direction.normalized();
  return {lens_of(s), *s.pose, *s.laser.pose, 1e-3 * s.laser.width_mm, way, s.scan.profiles, s.laser_line, s.imager,
          s.noise,    s.near,  s.far};
}

RangeImage measure_structured_light(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                                    const Draw& draw) {
  const StructuredLight model(scenery, view, surfaces, structured_light_setup(sensor), rays_of(draw));
  const Random random = random_of(draw);
  Measurement measured = sensor.fidelity == Fidelity::decoded ? model.decoded(random) : model.analytic(random);
  return image_of(std::move(view), std::move(measured));
}

RangeImage measure_stereo(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                          const Draw& draw) {
  const Stereo model(scenery, view, surfaces, stereo_setup(sensor), rays_of(draw));
  const Random random = random_of(draw);
  Measurement measured = sensor.fidelity == Fidelity::decoded ? model.decoded(random) : model.analytic(random);
  return image_of(std::move(view), std::move(measured));
}

RangeImage measure_time_of_flight(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                                  const Draw& draw) {
  Measurement measured = time_of_flight(scenery, view, surfaces, sensor.time_of_flight, sensor.noise, sensor.near,
                                        sensor.far, random_of(draw));
  return image_of(std::move(view), std::move(measured));
}

RangeImage measure_laser_line(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                              const Draw& draw) {
  Profiles profiles = LaserLine(scenery, surfaces, laser_line_setup(sensor)).scanned(random_of(draw));
  RangeImage image;
  image.width = profiles.width;
  image.height = profiles.height;
  for (std::size_t i = 0; i < profiles.points.size(); ++i) {
    const bool valid = profiles.validity[i] == Validity::valid;
    image.validity.push_back(static_cast<std::uint8_t>(profiles.validity[i]));
    image.depth.push_back(profiles.points[i][2]);
    image.label.push_back(valid ? profiles.label[i] : std::uint16_t{0});
    image.normal.push_back(valid ? profiles.normals[i] : std::array<float, 3>{nan, nan, nan});
  }
  image.intensity = std::move(profiles.intensity);
  image.points = std::move(profiles.points);
  image.truth_normal = std::move(view.normal);  // the others are of profiles, not of the camera's image
  add_truth(image, std::move(view));
  return image;
}

}  // namespace bin_scenes
