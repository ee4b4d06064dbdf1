/// A time-of-flight camera as a SensorModel: keys, and the model made from a sensor.
#include "sensor/models/of_sensor.hpp"
#include "sensor/models/time_of_flight.hpp"
#include "sensor/models/time_of_flight_noise.hpp"

namespace bin_scenes {

namespace {

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  TimeOfFlightSettings& s = settings.of<TimeOfFlightSettings>();
  v.field({"axial", "m",
           "smallest standard deviation of depth, reached at axial_distance on a surface that faces the camera",
           at_least(0.0, 10.0)},
          s.axial);
  v.field(
      {"axial_growth", "1/m",
       "multiplied by (z - axial_distance)^2 and added to the standard deviation; z is the depth", at_least(0.0, 10.0)},
      s.axial_growth);
  v.field({"axial_distance", "m", "depth at which the noise is smallest", at_least(0.0, 1000.0)}, s.axial_distance);
  v.field({"axial_angle", "m^-0.5",
           "multiplied by z^1.5 t^2 / (pi/2 - t)^2 and added to the standard deviation; t is the angle of incidence",
           at_least(0.0, 10.0)},
          s.axial_angle);
  v.field({"lateral", "pixel", "jitter of the ray; moves edges, never a plane", at_least(0.0, 100.0)}, s.lateral);
  v.field({"lateral_angle", "pixel", "times t / (pi/2 - t)", at_least(0.0, 100.0)}, s.lateral_angle);
  v.field({"albedo", "", "for which the figures hold: noise goes with sqrt(albedo / signal); 0 = same for all",
           at_least(0.0, 1.0)},
          s.albedo);
  v.field({"modulation", "MHz",
           "of the light; depth repeats after 150 m / it, which devices resolve by further frequencies",
           at_least(0.1, 10000.0)},
          s.modulation);
  v.field({"min_signal", "", "share of a white facing surface's signal at 1 m below which nothing is measured (code 4)",
           above(0.0, 1.0)},
          s.min_signal);
  v.field({"mixed", "", "pixels of foreground and background: keep = flying points, remove = invalid (code 6)"},
          s.mixed, mixed_pixels);
  v.field({"edge_step", "m", "smallest depth step inside a mixed pixel", above(0.0, 10.0)}, s.edge_step);
}

RangeImage measured(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                    const Draw& draw) {
  const TimeOfFlightSetup setup{sensor.settings.of<TimeOfFlightSettings>(),
                                sensor.noise,
                                sensor.near,
                                sensor.far,
                                indirect_of(sensor),
                                draw.gray};
  Measurement measured = time_of_flight(scenery, view, surfaces, setup, random_of(draw), rays_of(draw));
  const bool noise = false;  // shot noise that fits noise of millimetres in depth is below a grey level
  return image_with_gray(std::move(view), std::move(measured), sensor, noise, draw);
}

double sigma(const Sensor& sensor, double distance, double incidence, double albedo) {
  const auto& s = sensor.settings.of<TimeOfFlightSettings>();
  const bool dark = albedo * std::cos(incidence) / (distance * distance) < s.min_signal;
  return dark ? std::numeric_limits<double>::quiet_NaN() : axial_sigma(s, distance, incidence, albedo);
}

constexpr SensorModel model() {
  SensorModel m{"time_of_flight", "noise along the ray and across it", visit_keys, nullptr, nullptr, measured, sigma};
  m.indirect = m.gray = true;
  m.bounces = 1;
  return m;
}

}  // namespace

extern const SensorModel time_of_flight_model = model();

}  // namespace bin_scenes
