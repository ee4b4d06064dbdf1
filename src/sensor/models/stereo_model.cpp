/// Two cameras as a SensorModel: keys, checks, and the model made from a sensor.
#include "bin_scenes/core/error.hpp"
#include "sensor/models/census.hpp"
#include "sensor/models/of_sensor.hpp"
#include "sensor/models/stereo.hpp"
#include "sensor/report_points.hpp"

#include <optional>

namespace bin_scenes {

namespace {

/// @param s  resolved()
Stereo::Setup stereo_setup(const Sensor& s) {
  Stereo::Setup setup;
  setup.projector = lens_of(s.projector);
  setup.projector_pose = *s.projector.pose;
  setup.settings = s.settings.of<StereoSettings>();
  setup.imager = s.imager;
  setup.noise = s.noise;
  setup.near = s.near, setup.far = s.far;
  setup.indirect = indirect_of(s);
  setup.pipeline = s.settings.of<StereoPipeline>();
  return setup;
}

const Names<StereoMatcher> matchers{{"semi_global", StereoMatcher::semi_global}, {"census", StereoMatcher::census}};
const Names<DotLayout> layouts{{"random", DotLayout::random}, {"spread", DotLayout::spread}};
const Names<HoleFilling> fillings{{"off", HoleFilling::off},
                                  {"left", HoleFilling::left},
                                  {"farthest", HoleFilling::farthest},
                                  {"nearest", HoleFilling::nearest}};
const Names<Persistence> persistences{
    {"off", Persistence::off},
    {"8_of_8", Persistence::eight_of_eight},
    {"2_of_3", Persistence::two_of_three},
    {"2_of_4", Persistence::two_of_four},
    {"2_of_8", Persistence::two_of_eight},
    {"1_of_2", Persistence::one_of_two},
    {"1_of_5", Persistence::one_of_five},
    {"1_of_8", Persistence::one_of_eight},
    {"always", Persistence::always},
};

void visit_spatial(KeyVisitor& v, SpatialFilter& s) {
  v.field({"alpha", "",
           "Weight of a pixel relative to the result of the pixel before it. Smaller values smooth more and make edges "
           "wider.",
           at_least(0.01, 1.0)},
          s.alpha);
  v.field({"delta", "pixel",
           "Difference of disparity from which neighbouring pixels do not influence each other. With larger values, "
           "steps of depth become ramps.",
           at_least(0.0, 1000.0)},
          s.delta);
  v.field({"iterations", "",
           "Number of iterations. Each consists of a pass to the right, to the left, down and up. With 0, the filter "
           "is off.",
           at_least(0.0, 10.0)},
          s.iterations);
}

void visit_temporal(KeyVisitor& v, TemporalFilter& s) {
  v.field({"frames", "",
           "Number of images of the scene at rest that are averaged. With 1, the filter is off. With `fidelity: "
           "decoded`, the computing time grows with it.",
           at_least(1.0, 1000.0)},
          s.frames);
  v.field({"alpha", "", "Weight of an image relative to the result before it. Smaller values smooth more.",
           at_least(0.01, 1.0)},
          s.alpha);
  v.field(
      {"delta", "pixel",
       "Difference of disparity between a pixel and its last result from which the average of the pixel starts again.",
       at_least(0.0, 1000.0)},
      s.delta);
  v.field({"persistence", "",
           "Only with `fidelity: decoded`: a missing pixel keeps its last result if it was measured in so many of the "
           "last images. For example, `2_of_4` means in at least 2 of the last 4 images."},
          s.persistence, persistences);
}

void visit_census(KeyVisitor& v, StereoPipeline& s) {
  v.field({"census", "pixel",
           "Only with `matcher: census`: edge length of the window from which a signature is computed, an odd number. "
           "A larger window gives less noise and wider edges.",
           at_least(3.0, 9.0)},
          s.census);
  v.field({"second_peak", "",
           "Only with `matcher: census`: share of all bits of the signatures in a window by which every other "
           "disparity must fit worse than the best one. Larger values cause wider gaps at edges and more holes.",
           at_least(0.0, 1.0)},
          s.second_peak);
}

void visit_filters(KeyVisitor& v, StereoPipeline& s) {
  v.field({"disparity_step", "pixel",
           "If `noise` is true, disparities are rounded to multiples of this value, as the number format of a device "
           "does. With 0, they are not rounded.",
           at_least(0.0, 1.0)},
          s.disparity_step);
  v.field({"decimation", "",
           "If `noise` is true, the device matches images of this many times the width and height. A delivered pixel "
           "is the median (2 and 3) or the mean (4 to 8) of a square of their pixels. Larger values give less noise "
           "and take more time. With 1, there is no decimation.",
           at_least(1.0, 8.0)},
          s.decimation);
  v.section({"spatial", "", "Recursive filter of the disparities, which preserves edges. Holes are not filled."},
            [&s](KeyVisitor& inner) { visit_spatial(inner, s.spatial); });
  v.section({"temporal", "", "Exponential average of the disparities of successive images."},
            [&s](KeyVisitor& inner) { visit_temporal(inner, s.temporal); });
  v.field({"hole_filling", "",
           "If `noise` is true: from which neighbour a missing pixel takes its depth. `left`: the neighbour to the "
           "left. `farthest` and `nearest`: the farthest or nearest one of the neighbours to the left, above and "
           "below. `off`: holes are not filled."},
          s.hole_filling, fillings);
}

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  StereoSettings& s = settings.of<StereoSettings>();
  StereoPipeline& pipeline = settings.of<StereoPipeline>();
  v.field({"baseline", "m",
           "Distance from the first camera to the second one, along the x axis of the first. A longer baseline gives "
           "less noise and more occlusion.",
           at_least(1e-4, 100.0)},
          s.baseline);
  v.field({"disparities", "pixel",
           "Number of disparities that are searched, a multiple of 16. The search begins at the disparity of `far`; "
           "surfaces that are too near for this range are not matched. The computing time grows with the number. With "
           "`fidelity: decoded`, it can be at most 2047 - focal length * baseline / far.",
           at_least(16.0, 2032.0)},
          s.disparities);
  v.field({"matcher", "",
           "Only with `fidelity: decoded`: how the two images are matched. `semi_global`: intensities are compared "
           "along several paths. `census`: signatures are compared within a window, which leaves gaps at edges, as "
           "compact cameras do."},
          pipeline.matcher, matchers);
  v.field({"window", "pixel",
           "Edge length of the window that the matcher compares, an odd number. A larger window gives less noise and "
           "rounder edges.",
           at_least(1.0, 51.0)},
          s.window);
  visit_census(v, pipeline);
  v.field({"dots", "", "Share of the projector's pixels that are dots. With 0, there is no pattern (passive stereo).",
           at_least(0.0, 0.9)},
          s.dots);
  v.field({"pattern", "",
           "How the dots are distributed. `random`: each pixel of the projector is a dot with the same probability. "
           "`spread`: there is one dot in each square of a grid."},
          pipeline.layout, layouts);
  v.field({"uniqueness", "%",
           "Only with `matcher: semi_global`: margin by which the best match must be better than the second-best one. "
           "Larger values cause more holes and fewer outliers.",
           at_least(0.0, 100.0)},
          s.uniqueness);
  v.field({"max_difference", "pixel",
           "Largest allowed difference between the disparities that the matching from left to right and from right to "
           "left gives. Smaller values cause more holes and fewer outliers.",
           at_least(0.0, 100.0)},
          s.max_difference);
  v.field({"min_texture", "grey levels",
           "Smallest standard deviation of the grey levels (0 to 255) in a window, beyond noise, at which a pixel is "
           "matched. With 0, noise is matched as well.",
           at_least(0.0, 255.0)},
          s.min_texture);
  v.field(
      {"speckle_size", "pixel",
       "Number of pixels that an isolated region of disparities must have to be kept. With 0, all regions are kept.",
       at_least(0.0, 1e5)},
      s.speckle_size);
  v.field({"disparity_noise", "pixel",
           "Only with `fidelity: analytic`: standard deviation of the disparity at full signal.", at_least(0.0, 10.0)},
          s.disparity_noise);
  v.field({"min_signal", "",
           "Only with `fidelity: analytic`: smallest signal at which a pixel is matched, divided by the full well. "
           "Darker pixels are missing (validity code 8).",
           above(0.0, 1.0)},
          s.min_signal);
  visit_filters(v, pipeline);
}

void check(const Sensor& sensor, const std::string& key) {
  const auto& s = sensor.settings.of<StereoSettings>();
  if (s.disparities % 16 != 0)
    throw input_error("is not a multiple of 16", key + ".stereo.disparities", "give 64, 128 or 256, for instance");
  if (s.window % 2 == 0) throw input_error("is even", key + ".stereo.window", "give an odd number, usually 5, 7 or 9");
  const auto& pipeline = sensor.settings.of<StereoPipeline>();
  if (pipeline.census % 2 == 0)
    throw input_error("is even", key + ".stereo.census", "give an odd number, usually 5, 7 or 9");
  if (pipeline.matcher == StereoMatcher::census && s.window > most_census_window(pipeline.census))
    throw input_error(
        "`window` and `census` together are too large", key + ".stereo.window",
        "give a window of at most " + std::to_string(most_census_window(pipeline.census)) + " with this census");
  if (sensor.model == "stereo" &&
      std::any_of(sensor.distortion.begin(), sensor.distortion.end(), [](double d) { return d != 0.0; })) {
    throw input_error("a stereo camera delivers rectified images, which have no distortion", key + ".distortion",
                      "remove this key");
  }
}

/// The lens of the images that are matched: those that are delivered have fewer pixels.
Lens matched_lens(const Sensor& sensor) {
  Lens lens = lens_of(sensor);
  const int factor = sensor.noise ? sensor.settings.of<StereoPipeline>().decimation : 1;
  lens.width *= factor, lens.height *= factor;
  lens.fx *= factor, lens.skew *= factor, lens.fy *= factor;
  lens.cx = factor * (lens.cx + 0.5) - 0.5;
  lens.cy = factor * (lens.cy + 0.5) - 0.5;
  return lens;
}

/// The matcher's disparities are sixteenths of a pixel in 16 bits.
void check_places(const Sensor& sensor, const std::string& where) {
  constexpr int most = 2047;
  const auto& s = sensor.settings.of<StereoSettings>();
  const double least = matched_lens(sensor).fx * s.baseline / sensor.far;
  if (sensor.fidelity == Fidelity::decoded && least + s.disparities > most)
    throw input_error("the depth range needs disparities of " + std::to_string(std::lround(least)) + " (at far) to " +
                          std::to_string(std::lround(least + s.disparities)) + " pixels, more than the " +
                          std::to_string(most) + " that the matcher can find",
                      where, "lower stereo.disparities, baseline or width, or set far farther away");
}

RangeImage measured(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                    const Draw& draw) {
  const Lens lens = matched_lens(sensor);
  std::optional<View> fine;
  if (lens.width != view.lens.width) fine = render(scenery, lens, view.pose, sensor.near, sensor.far);
  Stereo::Setup setup = stereo_setup(sensor);
  setup.gray = draw.gray;
  const Stereo model(scenery, fine ? *fine : view, surfaces, setup, rays_of(draw));
  return image_by(model, sensor, std::move(view), draw);
}

/// Disparities stay.
void report(RangeImage& image, const Sensor& device, const Sensor& believed) {
  const auto scale = [](const Sensor& s) { return lens_of(s).fx * s.settings.of<StereoSettings>().baseline; };
  const double share = scale(believed) / scale(device);
  report_depths(image, [&](double, double, double depth) { return share * depth; });
}

double sigma(const Sensor& sensor, double distance, double incidence, double albedo) {
  const Lens lens = matched_lens(sensor);
  Sensor matched = sensor;
  matched.width = lens.width, matched.height = lens.height;
  matched.k = {lens.fx, lens.skew, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0};
  Plate plate(matched, distance, incidence, albedo);
  const View view = plate.seen_at_center();
  return Stereo(plate.scenery, view, plate.surfaces, stereo_setup(sensor)).depth_sigma(view.depth.size() / 2);
}

constexpr SensorModel model() {
  SensorModel m{"stereo",     "Settings of the model `stereo`: second camera, dot pattern and matching.",
                visit_keys,   check,
                check_places, measured,
                sigma};
  m.imager = m.projector = m.fidelity = m.indirect = m.gray = true;
  m.report = report;
  return m;
}

}  // namespace

extern const SensorModel stereo_model = model();

}  // namespace bin_scenes
