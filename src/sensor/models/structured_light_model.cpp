/// Fringe projection as a SensorModel: keys, checks, and the model made from a sensor.
#include "bin_scenes/core/error.hpp"
#include "sensor/models/of_sensor.hpp"
#include "sensor/models/structured_light.hpp"
#include "sensor/report_points.hpp"

namespace bin_scenes {

namespace {

/// Kept in Sensor::settings.
struct IndirectSettings {
  double error = IndirectField::Setup().error;
};

IndirectField::Setup indirect_light_of(const Sensor& s) {
  IndirectField::Setup setup = indirect_of(s);
  setup.error = s.settings.of<IndirectSettings>().error;
  return setup;
}

/// @param s  resolved()
StructuredLight::Setup structured_light_setup(const Sensor& s) {
  StructuredLight::Setup setup;
  setup.projector = lens_of(s.projector);
  setup.projector_pose = *s.projector.pose;
  setup.settings = s.settings.of<StructuredLightSettings>();
  setup.imager = s.imager;
  setup.noise = s.noise;
  setup.near = s.near, setup.far = s.far;
  setup.indirect = indirect_light_of(s);
  setup.only_analytic = s.fidelity == Fidelity::analytic;
  setup.reflection = s.settings.of<FilterSettings>().reflection;
  return setup;
}

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  StructuredLightSettings& s = settings.of<StructuredLightSettings>();
  v.field({"steps", "", "Number of images of the phase shift. The noise is proportional to 1 / sqrt(steps).",
           at_least(3.0, 64.0)},
          s.steps);
  v.field({"period", "pixel",
           "Period of the fringes, in pixels of the projector. A shorter period gives less noise, but needs more "
           "Gray-code images and is blurred sooner.",
           at_least(4.0, 4096.0)},
          s.period);
  v.field(
      {"gray_bits", "", "Number of Gray-code images. With 0, there are as many as the width of the projector needs.",
       at_least(0.0, 14.0)},
      s.gray_bits);
  v.field({"contrast", "", "Contrast of the projector: (white - black) / (white + black).", at_least(0.01, 1.0)},
          s.contrast);
  v.field({"defocus", "pixel",
           "Standard deviation of the blur of the projector, in pixels of the projector. With 0, the pattern is sharp.",
           at_least(0.0)},
          s.defocus);
  v.field({"gamma", "",
           "Only with `fidelity: decoded`: exponent of the projector's response that remains after calibration. With "
           "1, the response is linear.",
           at_least(0.1, 10.0)},
          s.gamma);
  v.field({"min_modulation", "",
           "Smallest amplitude of the fringes at which a pixel is measured, divided by the full well. Darker pixels "
           "are missing (validity code 4).",
           above(0.0, 1.0)},
          s.min_modulation);
  v.field({"mixed", "",
           "Treatment of pixels that see both foreground and background. `remove`: they are invalid (validity code 6). "
           "`keep`: they have a depth between both (flying points)."},
          s.mixed, mixed_pixels);
  v.field({"edge_step", "m", "Smallest step of depth inside a pixel that makes it a mixed pixel.", above(0.0, 10.0)},
          s.edge_step);
  v.field({"indirect_error", "",
           "Largest standard error of the light that other surfaces reflect, as a share of the mean direct light. "
           "Where it would be larger, more than `indirect_samples` rays are used, but at most 1024. Smaller values "
           "give less noise and take more time. With 0, no place gets more rays.",
           at_least(0.0, 1.0)},
          settings.of<IndirectSettings>().error);
}

void check_reflection(const Sensor& sensor, const std::string& key) {
  const auto& s = sensor.settings.of<StructuredLightSettings>();
  const ReflectionFilter& filter = sensor.settings.of<FilterSettings>().reflection;
  if (filter.step == 0.0) return;
  if (sensor.model != "structured_light")
    throw input_error("compares fringes, but model " + sensor.model + " does not project fringes", key,
                      "remove this key, or use the model structured_light");
  const double ratio = filter.period / s.period;
  if (ratio > 0.8 && ratio < 1.25)
    throw input_error("is nearly the period of the first fringe, so that indirect light shifts both equally",
                      key + ".period", "give a shorter period, usually at most a third of structured_light.period");
  if (s.defocus > 0.5 * filter.period)
    throw input_error("is less than twice structured_light.defocus, so that the blur would remove the fringe",
                      key + ".period", "give a longer period");
}

void check(const Sensor& sensor, const std::string& key) {
  const auto& s = sensor.settings.of<StructuredLightSettings>();
  check_baseline(key + ".projector.baseline", sensor.projector.baseline);
  check_reflection(sensor, key + ".filter.reflection");
  const std::string section = key + ".structured_light";
  if (s.defocus > 0.5 * s.period)
    throw input_error("is more than half a period", section + ".defocus",
                      "give fewer projector pixels, or 0 for a sharp pattern");
  if (sensor.model != "structured_light" || s.gray_bits == 0) return;
  int needed = 1;  // the code counts half periods: models/fringes.hpp
  while (std::ldexp(1.0, needed) < 2.0 * std::ceil(sensor.projector.width / s.period)) ++needed;
  if (s.gray_bits < needed) {
    throw input_error(std::to_string(s.gray_bits) + " images are too few for a projector of " +
                          std::to_string(sensor.projector.width) + " columns",
                      section + ".gray_bits",
                      "give " + std::to_string(needed) + ", 0 for as many as needed, or a longer period");
  }
}

void check_places(const Sensor& sensor, const std::string& where) {
  if ((sensor.projector.pose->position - sensor.pose->position).norm() < 1e-6)
    throw input_error(
        "the projector is at the position of the camera, so that nothing can be measured by triangulation", where,
        "move the projector sideways, or give a baseline");
}

RangeImage measured(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                    const Draw& draw) {
  StructuredLight::Setup setup = structured_light_setup(sensor);
  setup.gray = draw.gray;
  const StructuredLight model(scenery, view, surfaces, setup, rays_of(draw));
  return image_by(model, sensor, std::move(view), draw);
}

/// The column of the true projector, met with what is believed of it.
void report(RangeImage& image, const Sensor& device, const Sensor& believed) {
  const Lens eye = lens_of(device), read = lens_of(believed), projector = lens_of(device.projector);
  const Pose to_projector = device.projector.pose->inverse() * *device.pose;
  const Triangulation triangle(lens_of(believed.projector), believed.pose->inverse() * *believed.projector.pose);
  report_depths(image, [&](double column, double row, double depth) {
    const auto lit = projector.project(to_projector * (depth * eye.ray(column, row)));
    return lit ? triangle.depth(read.ray(column, row), lit->x()) : std::numeric_limits<double>::quiet_NaN();
  });
}

double sigma(const Sensor& sensor, double distance, double incidence, double albedo) {
  Plate plate(sensor, distance, incidence, albedo);
  const View view = plate.seen_at_center();
  return StructuredLight(plate.scenery, view, plate.surfaces, structured_light_setup(sensor))
      .depth_sigma(view.depth.size() / 2);
}

constexpr SensorModel model() {
  SensorModel m{"structured_light",
                "Settings of the model `structured_light`: fringe projection by phase shift and Gray code.",
                visit_keys,
                check,
                check_places,
                measured,
                sigma};
  m.imager = m.projector = m.fidelity = m.indirect = m.gray = true;
  m.bounces = 1;
  m.report = report;
  return m;
}

}  // namespace

extern const SensorModel structured_light_model = model();

}  // namespace bin_scenes
