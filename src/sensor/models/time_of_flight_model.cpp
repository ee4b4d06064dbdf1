/// A time-of-flight camera as a SensorModel: keys, and the model made from a sensor.
#include "sensor/models/of_sensor.hpp"
#include "sensor/models/time_of_flight.hpp"
#include "sensor/models/time_of_flight_noise.hpp"

namespace bin_scenes {

namespace {

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  TimeOfFlightSettings& s = settings.of<TimeOfFlightSettings>();
  v.field({"axial", "m",
           "Smallest standard deviation of the depth. It is reached on a surface that faces the camera at the depth "
           "`axial_distance`.",
           at_least(0.0, 10.0)},
          s.axial);
  v.field({"axial_growth", "1/m",
           "Growth of the noise with the depth z: this value * (z - axial_distance)^2 is added to the standard "
           "deviation of the depth.",
           at_least(0.0, 10.0)},
          s.axial_growth);
  v.field({"axial_distance", "m", "Depth at which the noise is smallest.", at_least(0.0, 1000.0)}, s.axial_distance);
  v.field({"axial_angle", "m^-0.5",
           "Growth of the noise with the angle of incidence t (rad): this value * z^1.5 * t^2 / (pi/2 - t)^2 is added "
           "to the standard deviation of the depth z.",
           at_least(0.0, 10.0)},
          s.axial_angle);
  v.field({"lateral", "pixel",
           "Standard deviation of a random deviation of the ray of a pixel. It displaces edges, but adds no noise to "
           "planes.",
           at_least(0.0, 100.0)},
          s.lateral);
  v.field({"lateral_angle", "pixel",
           "Growth of `lateral` with the angle of incidence t (rad): this value * t / (pi/2 - t) is added to it.",
           at_least(0.0, 100.0)},
          s.lateral_angle);
  v.field({"albedo", "",
           "Albedo for which the noise of the depth is stated. For other surfaces, it is multiplied by sqrt(albedo / "
           "signal). With 0, it is the same for all surfaces.",
           at_least(0.0, 1.0)},
          s.albedo);
  v.field({"modulation", "MHz",
           "Modulation frequency of the light. Depth repeats after 150 m divided by this value in MHz; devices resolve "
           "this ambiguity by further frequencies.",
           at_least(0.1, 10000.0)},
          s.modulation);
  v.field({"min_signal", "",
           "Smallest signal at which a pixel is measured, divided by the signal of a white surface that faces the "
           "camera at 1 m. Darker pixels are missing (validity code 4).",
           above(0.0, 1.0)},
          s.min_signal);
  v.field({"mixed", "",
           "Treatment of pixels that see both foreground and background. `keep`: they have a depth between both "
           "(flying points). `remove`: they are invalid (validity code 6)."},
          s.mixed, mixed_pixels);
  v.field({"edge_step", "m", "Smallest step of depth inside a pixel that makes it a mixed pixel.", above(0.0, 10.0)},
          s.edge_step);
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
  SensorModel m{"time_of_flight",
                "Settings of the model `time_of_flight`: noise along the ray of a pixel and across it.",
                visit_keys,
                nullptr,
                nullptr,
                measured,
                sigma};
  m.indirect = m.gray = true;
  m.bounces = 1;
  return m;
}

}  // namespace

extern const SensorModel time_of_flight_model = model();

}  // namespace bin_scenes
