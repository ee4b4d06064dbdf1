/// A grey or colour camera as a SensorModel: keys, checks, and the image made from a sensor. Its lamps are in
/// sensor_keys.hpp.
#include "bin_scenes/core/error.hpp"
#include "sensor/models/image.hpp"
#include "sensor/models/image_optics.hpp"
#include "sensor/models/of_sensor.hpp"

namespace bin_scenes {

namespace {

void visit_optics(KeyVisitor& v, ImageOptics& s) {
  v.field({"f_number", "",
           "Focal length of the lens divided by the diameter of its aperture. Surfaces that are out of focus are "
           "blurred. With 0, the camera is a pinhole, and everything is sharp.",
           at_least(0.0, 1000.0)},
          s.f_number);
  v.field({"focal_length", "m",
           "Focal length of the lens, which determines the diameter of the aperture together with `f_number`. The "
           "field of view does not depend on it.",
           above(0.0, 10.0)},
          s.focal_length);
  v.field({"focus", "m", "Depth at which surfaces are sharp. With 0, it is the median depth of the image.",
           at_least(0.0, 1000.0)},
          s.focus);
  v.field({"bevel", "m",
           "Radius of the fillets with which convex edges of parts are shaded, so that edges shine. Outlines and depth "
           "do not change.",
           at_least(0.0, 0.1)},
          s.bevel);
  v.field({"reflected_roughness", "",
           "Smallest roughness of a shiny surface that is seen by reflection in another shiny surface. Smaller values "
           "give sharper reflections with more Monte Carlo noise.",
           at_least(0.0, 1.0)},
          s.soft);
}

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  ImageSettings& s = settings.of<ImageSettings>();
  v.field({"samples", "",
           "Number of light paths for each pixel, a power of two. More paths give less Monte Carlo noise and take more "
           "time.",
           at_least(1.0, 65536.0)},
          s.samples);
  v.field({"denoise", "",
           "If true, the Monte Carlo noise that remains with few samples is removed; at least 4 samples are needed. "
           "Edges are preserved, but faint scratches disappear."},
          s.denoise);
  v.field({"colour", "", "If true, the image is in colour (RGB) instead of grey."}, s.colour);
  visit_optics(v, settings.of<ImageOptics>());
  v.field({"bits", "", "Number of bits of a pixel, 8 or 16. Files in the layout of BOP contain the upper 8 bits.",
           at_least(8.0, 16.0)},
          s.bits);
}

/// Paths of one image, some 0.6 million of which a core traces a second.
constexpr double most_paths = 4e9;

void check_picture(const ImageLamp& lamp, const std::string& key) {
  if (lamp.type != ImageLamp::Type::dome)
    throw input_error("applies only to lamps of type dome", key,
                      "set the type of the lamp to dome, or remove this key");
  try {
    if (!(Sky(read_panorama(lamp.picture), Rgb::Ones(), 0.0).flux() > 0.0))
      throw input_error("is black", lamp.picture, "use a picture with pixels that are not black");
  } catch (const Error& error) {
    throw input_error("'" + lamp.picture + "' " + error.problem(), key, error.remedy());
  }
}

void check(const Sensor& sensor, const std::string& key) {
  const auto& s = sensor.settings.of<ImageSettings>();
  if (s.bits != 8 && s.bits != 16)
    throw input_error("is " + std::to_string(s.bits), key + ".image.bits", "give 8 or 16");
  if ((s.samples & (s.samples - 1)) != 0)
    throw input_error(std::to_string(s.samples) + " is not a power of two", key + ".image.samples",
                      "give 4, 8, 16, 32, ...");
  if (s.denoise && s.samples < 4)
    throw input_error("needs at least 4 samples", key + ".image.denoise",
                      "increase `samples`, or set `denoise: false`");
  const double paths = static_cast<double>(sensor.width) * sensor.height * s.samples;
  if (sensor.model == "image" && paths > most_paths) {
    throw input_error(std::to_string(s.samples) + " for each of " + std::to_string(sensor.width) + " x " +
                          std::to_string(sensor.height) + " pixels are " +
                          std::to_string(static_cast<int>(paths / 1e9)) +
                          " billion paths; at most 4 billion are allowed, which take about 20 minutes on one core",
                      key + ".image.samples", "give fewer samples or pixels");
  }
  for (std::size_t i = 0; i < s.lamps.size(); ++i) {
    const ImageLamp& lamp = s.lamps[i];
    if (lamp.type == ImageLamp::Type::ring && !(lamp.inner < lamp.outer))
      throw input_error("is not below the outer radius", key + ".lamps[" + std::to_string(i) + "].inner",
                        "give a radius (m) below `outer`, or 0 for a disk");
    if (!lamp.picture.empty()) check_picture(lamp, key + ".lamps[" + std::to_string(i) + "].picture");
  }
}

RangeImage measured(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                    const Draw& draw) {
  Picture picture;
  Measurement seen = take_image(scenery, view, sensor, surfaces, rays_of(draw), random_of(draw), picture);
  RangeImage image = image_of(std::move(view), std::move(seen));
  image.picture = std::move(picture);
  return image;
}

/// Its depth is the truth.
double sigma(const Sensor&, double, double, double) {
  return 0.0;
}

constexpr SensorModel model() {
  SensorModel m{"image",    "Settings of the model `image`: a grey or colour camera, whose depth is exact.",
                visit_keys, check,
                nullptr,    measured,
                sigma};
  m.imager = m.indirect = true;
  m.bounces = 1;
  return m;
}

}  // namespace

extern const SensorModel image_model = model();

}  // namespace bin_scenes
