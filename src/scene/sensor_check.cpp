#include "scene/sensor_check.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bin_scenes {

namespace {

struct Bound {
  const char* name;
  double value, least, most;
  const char* remedy;
};

void check_bounds(const std::string& section, std::initializer_list<Bound> bounds) {
  for (const Bound& b : bounds) {
    if (b.value >= b.least && b.value <= b.most) continue;
    std::ostringstream what;
    what << "must be from " << b.least << " to " << b.most << ", is " << b.value;
    throw input_error(what.str(), section + "." + b.name, b.remedy);
  }
}

constexpr const char* deviation = "a standard deviation; 0 = none";
constexpr double tiny = 1e-9;

void check_stereo(const std::string& key, const Sensor& sensor) {
  const StereoSettings& s = sensor.stereo;
  check_bounds(key + ".stereo", {{"baseline", std::abs(s.baseline), 1e-4, 100.0, "m along the camera's x"},
                                 {"disparities", double(s.disparities), 16, 4096, "pixels, a multiple of 16"},
                                 {"window", double(s.window), 1, 51, "pixels, odd"},
                                 {"dots", s.dots, 0.0, 0.9, "share of the projector's pixels; 0 = passive"},
                                 {"uniqueness", double(s.uniqueness), 0, 100, "%"},
                                 {"max_difference", s.max_difference, 0.0, 100.0, "pixels"},
                                 {"min_texture", s.min_texture, 0.0, 255.0, "grey levels"},
                                 {"speckle_size", double(s.speckle_size), 0, 100000, "pixels; 0 = none removed"},
                                 {"disparity_noise", s.disparity_noise, 0.0, 10.0, deviation},
                                 {"min_signal", s.min_signal, tiny, 1.0, "share of the full well, above 0"}});
  if (s.baseline < 0.0) {
    throw input_error("is negative", key + ".stereo.baseline", "the second camera stands on the right");
  }
  if (s.disparities % 16 != 0) {
    throw input_error("is no multiple of 16", key + ".stereo.disparities", "the matcher wants one: 64, 128, 256");
  }
  if (s.window % 2 == 0) throw input_error("is even", key + ".stereo.window", "5, 7 or 9 is usual");
  if (sensor.model == SensorModel::stereo &&
      std::any_of(sensor.distortion.begin(), sensor.distortion.end(), [](double d) { return d != 0.0; })) {
    throw input_error("a stereo camera delivers rectified images, which have no distortion", key + ".distortion",
                      "leave it out");
  }
}

void check_structured_light(const std::string& key, const Sensor& sensor) {
  const StructuredLightSettings& s = sensor.structured_light;
  const std::string section = key + ".structured_light";
  check_bounds(section, {{"steps", double(s.steps), 3, 64, "images of the phase shift"},
                         {"period", s.period, 4.0, 4096.0, "projector pixels a fringe"},
                         {"gray_bits", double(s.gray_bits), 0, 14, "0 = as many as needed"},
                         {"contrast", s.contrast, 0.01, 1.0, "(white - black) / (white + black)"},
                         {"defocus", s.defocus, 0.0, 0.5 * s.period, "projector pixels; 0 = sharp"},
                         {"gamma", s.gamma, 0.1, 10.0, "1 = linear"},
                         {"min_modulation", s.min_modulation, tiny, 1.0, "share of the full well, above 0"},
                         {"edge_step", s.edge_step, tiny, 10.0, "m"}});
  if (sensor.model != SensorModel::structured_light || s.gray_bits == 0) return;
  int needed = 1;  // the code counts half periods: models/fringes.hpp
  while (std::ldexp(1.0, needed) < 2.0 * std::ceil(sensor.projector.width / s.period)) ++needed;
  if (s.gray_bits < needed) {
    throw input_error(std::to_string(s.gray_bits) + " images are too few for a projector of " +
                          std::to_string(sensor.projector.width) + " columns",
                      section + ".gray_bits",
                      "give " + std::to_string(needed) + ", 0 for as many as needed, or a longer period");
  }
}

void check_bounces(const std::string& key, const Sensor& sensor) {
  const int bounces = sensor.bounces.value_or(0);
  check_bounds(key, {{"bounces", double(bounces), 0, 2, "0 = direct light only, 1 is usual, 2 adds little"},
                     {"indirect_samples", double(sensor.indirect_samples), 4, 4096, "rays; 24 is usual"}});
  const bool sees = sensor.model == SensorModel::structured_light || sensor.model == SensorModel::stereo;
  if (bounces == 0 || sees) return;
  throw input_error("indirect light is no part of model " + std::string(name_of(sensor.model)), key + ".bounces",
                    "leave it out; structured_light and stereo see such light");
}

}  // namespace

void check_sensor_models(const std::string& key, const Sensor& sensor) {
  check_bounces(key, sensor);
  const ImagerSettings& i = sensor.imager;
  check_bounds(key + ".imager", {{"exposure", i.exposure, tiny, 1000.0, "above 0; 0.8 leaves white unsaturated"},
                                 {"reference_distance", i.reference_distance, 0.0, 1000.0, "m; 0 = automatic"},
                                 {"ambient", i.ambient, 0.0, 10.0, "share of the full well"},
                                 {"full_well", i.full_well, 1.0, 1e9, "electrons"},
                                 {"read_noise", i.read_noise, 0.0, 1e6, deviation},
                                 {"blur", i.blur, 0.0, 3.0, "pixels; 0 = sharp, 0.5 to 0.7 is usual"},
                                 {"bits", double(i.bits), 1, 16, "8 to 12 is usual"}});
  check_structured_light(key, sensor);
  const LaserLineSettings& l = sensor.laser_line;
  check_bounds(key + ".laser_line", {{"fan", l.fan, 1e-3, 3.0, "rad"},
                                     {"power", l.power, tiny, 1000.0, "above 0"},
                                     {"blur", l.blur, 0.2, 100.0, "pixels; a sharper line falls between two rows"},
                                     {"speckle", l.speckle, 0.0, 1.0, "contrast; 0 = none"},
                                     {"min_signal", l.min_signal, tiny, 1.0, "share of the full well, above 0"}});
  check_stereo(key, sensor);
  const TimeOfFlightSettings& t = sensor.time_of_flight;
  check_bounds(key + ".time_of_flight", {{"axial", t.axial, 0.0, 10.0, deviation},
                                         {"axial_growth", t.axial_growth, 0.0, 10.0, "1/m; 0 = none"},
                                         {"axial_distance", t.axial_distance, 0.0, 1000.0, "m"},
                                         {"axial_angle", t.axial_angle, 0.0, 10.0, "m^1.5; 0 = none"},
                                         {"lateral", t.lateral, 0.0, 100.0, deviation},
                                         {"lateral_angle", t.lateral_angle, 0.0, 100.0, deviation},
                                         {"albedo", t.albedo, 0.0, 1.0, "0 = the same noise for all surfaces"},
                                         {"min_signal", t.min_signal, tiny, 1.0, "above 0"},
                                         {"edge_step", t.edge_step, tiny, 10.0, "m"}});
}

}  // namespace bin_scenes
