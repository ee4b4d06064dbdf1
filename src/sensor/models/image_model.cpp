/// A grey or colour camera as a SensorModel: keys, checks, and the image made from a sensor. Its lamps are in
/// sensor_keys.hpp.
#include "bin_scenes/core/error.hpp"
#include "sensor/models/image.hpp"
#include "sensor/models/image_optics.hpp"
#include "sensor/models/of_sensor.hpp"

namespace bin_scenes {

namespace {

void visit_table(KeyVisitor& v, Tabletop::Settings& table) {
  v.field({"albedo", "", "mean over the table; 0 = no table", at_least(0.0, 1.0)}, table.albedo);
  v.field({"height", "m", "z in the bin frame; a box bin ends its wall thickness below 0", at_least(-100.0, 100.0)},
          table.height);
  v.field({"mottle", "", "largest deviation of the albedo / albedo, in patches that differ between scenes",
           at_least(0.0, 1.0)},
          table.mottle);
  v.field({"patch", "m", "size of the largest patches", above(0.0, 100.0)}, table.patch);
  v.field({"gloss", "", "share of light that is mirrored", at_least(0.0, 1.0)}, table.gloss);
  v.field({"roughness", "", "of the mirrored share", at_least(0.0, 1.0)}, table.roughness);
}

void visit_optics(KeyVisitor& v, ImageOptics& s) {
  v.field({"f_number", "", "of the lens: what is out of focus blurs; 0 = a pinhole, sharp everywhere",
           at_least(0.0, 1000.0)},
          s.f_number);
  v.field({"focal_length", "m", "of the lens; with f_number it gives the aperture", above(0.0, 10.0)}, s.focal_length);
  v.field({"focus", "m", "depth that is sharp; 0 = the median depth of the image", at_least(0.0, 1000.0)}, s.focus);
  v.field({"bevel", "m", "radius of the fillets by which convex edges of parts are shaded; outlines and depth stay",
           at_least(0.0, 0.1)},
          s.bevel);
  v.field({"reflected_roughness", "",
           "least roughness of mirrors that are seen in mirrors; lower = sharper, with more grain", at_least(0.0, 1.0)},
          s.soft);
  v.section({"table", "", "an endless table below the bin, which pictures alone see: it has no depth and no label"},
            [&](KeyVisitor& keys) { visit_table(keys, s.table); });
}

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  ImageSettings& s = settings.of<ImageSettings>();
  v.field({"samples", "", "paths a pixel, a power of two; more = less grain, slower", at_least(1.0, 65536.0)},
          s.samples);
  v.field({"denoise", "",
           "takes the grain of few samples out, with at least 4 of them; edges stay, faint scratches go, too"},
          s.denoise);
  v.field({"colour", "", "RGB instead of grey"}, s.colour);
  visit_optics(v, settings.of<ImageOptics>());
  v.field({"bits", "", "of a count, 8 or 16, of which BOP has the upper 8", at_least(8.0, 16.0)}, s.bits);
}

/// Paths of one image, some 3 million of which a core traces a second.
constexpr double most_paths = 4e9;

void check_picture(const ImageLamp& lamp, const std::string& key) {
  if (lamp.type != ImageLamp::Type::dome)
    throw input_error("applies only to lamps of type dome", key, "give type: dome, or leave it out");
  try {
    if (!(Sky(read_panorama(lamp.picture), Rgb::Ones(), 0.0).flux() > 0.0))
      throw input_error("is black", lamp.picture, "give a picture that shines");
  } catch (const Error& error) {
    throw input_error("'" + lamp.picture + "' " + error.problem(), key, error.remedy());
  }
}

void check(const Sensor& sensor, const std::string& key) {
  const auto& s = sensor.settings.of<ImageSettings>();
  if (s.bits != 8 && s.bits != 16)
    throw input_error("is " + std::to_string(s.bits), key + ".image.bits", "give 8 or 16");
  if ((s.samples & (s.samples - 1)) != 0)
    throw input_error(std::to_string(s.samples) + " is no power of two", key + ".image.samples",
                      "give 4, 8, 16, 32, ...");
  if (s.denoise && s.samples < 4)
    throw input_error("needs at least 4 samples", key + ".image.denoise", "give more samples, or denoise: false");
  const double paths = static_cast<double>(sensor.width) * sensor.height * s.samples;
  if (sensor.model == "image" && paths > most_paths) {
    throw input_error(std::to_string(s.samples) + " for each of " + std::to_string(sensor.width) + " x " +
                          std::to_string(sensor.height) + " pixels are " +
                          std::to_string(static_cast<int>(paths / 1e9)) +
                          " billion paths; 4 billion are the most, some 20 minutes of a core",
                      key + ".image.samples", "give fewer samples or pixels");
  }
  for (std::size_t i = 0; i < s.lamps.size(); ++i) {
    const ImageLamp& lamp = s.lamps[i];
    if (lamp.type == ImageLamp::Type::ring && !(lamp.inner < lamp.outer))
      throw input_error("is not below the outer radius", key + ".lamps[" + std::to_string(i) + "].inner",
                        "m; 0 = a disk");
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
  SensorModel m{"image", "a grey or colour image; depth beside it is exact", visit_keys, check, nullptr, measured,
                sigma};
  m.imager = m.indirect = true;
  m.bounces = 1;
  return m;
}

}  // namespace

extern const SensorModel image_model = model();

}  // namespace bin_scenes
