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
  v.field({"alpha", "", "weight of a pixel against the one before it; smaller = smoother, edges are wider",
           at_least(0.01, 1.0)},
          s.alpha);
  v.field({"delta", "pixel",
           "neighbours whose disparities differ by as much or more do not influence each other; larger = steps of "
           "depth become ramps",
           at_least(0.0, 1000.0)},
          s.delta);
  v.field({"iterations", "", "each is a pass to the right, left, down and up; 0 = off", at_least(0.0, 10.0)},
          s.iterations);
}

void visit_temporal(KeyVisitor& v, TemporalFilter& s) {
  v.field({"frames", "", "images of the scene at rest that are averaged; 1 = off; decoded: time grows with it",
           at_least(1.0, 1000.0)},
          s.frames);
  v.field({"alpha", "", "weight of an image against the result before it; smaller = smoother", at_least(0.01, 1.0)},
          s.alpha);
  v.field({"delta", "pixel", "a pixel whose disparity differs from its last result by as much or more starts again",
           at_least(0.0, 1000.0)},
          s.delta);
  v.field({"persistence", "",
           "decoded: a missing pixel keeps its last result if it was measured in so many of the last images"},
          s.persistence, persistences);
}

void visit_census(KeyVisitor& v, StereoPipeline& s) {
  v.field({"census", "pixel", "census: odd edge of the window of a signature; larger = less noise, wider edges",
           at_least(3.0, 9.0)},
          s.census);
  v.field({"second_peak", "",
           "census: share of all signature bits of the window by which any other disparity must fit worse than the "
           "best one; more = wider gaps at edges, more holes",
           at_least(0.0, 1.0)},
          s.second_peak);
}

void visit_filters(KeyVisitor& v, StereoPipeline& s) {
  v.field({"disparity_step", "pixel",
           "with noise: disparities are rounded to multiples of it, as the number format of a device does; 0 = not "
           "rounded",
           at_least(0.0, 1.0)},
          s.disparity_step);
  v.field({"decimation", "",
           "with noise: the device matches images of so many times width and height, and a delivered pixel is the "
           "median (2, 3) or mean (4 to 8) of a square; 1 = off; more = less noise, slower",
           at_least(1.0, 8.0)},
          s.decimation);
  v.section({"spatial", "", "edge-preserving recursive filter of disparities; holes are not filled"},
            [&s](KeyVisitor& inner) { visit_spatial(inner, s.spatial); });
  v.section({"temporal", "", "exponential average of successive images"},
            [&s](KeyVisitor& inner) { visit_temporal(inner, s.temporal); });
  v.field({"hole_filling", "",
           "with noise: a missing pixel takes the depth of the neighbour to the left, or of the farthest or nearest "
           "among those to the left, above and below"},
          s.hole_filling, fillings);
}

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  StereoSettings& s = settings.of<StereoSettings>();
  StereoPipeline& pipeline = settings.of<StereoPipeline>();
  v.field({"baseline", "m", "to the second camera along the first one's x; longer = less noise, more occlusion",
           at_least(1e-4, 100.0)},
          s.baseline);
  v.field(
      {"disparities", "pixel",
       "multiple of 16; what lies nearer than focal length * baseline / disparities is unmatched; time grows with it; "
       "decoded: at most 2047 less focal length * baseline / far",
       at_least(16.0, 2032.0)},
      s.disparities);
  v.field({"matcher", "",
           "decoded: semi_global compares intensities along several paths, census compares signatures within a window "
           "and leaves gaps at edges, as compact cameras do"},
          pipeline.matcher, matchers);
  v.field({"window", "pixel", "odd: the matcher's block; larger = less noise, rounder edges", at_least(1.0, 51.0)},
          s.window);
  visit_census(v, pipeline);
  v.field(
      {"dots", "", "share of the projector's pixels that are dots; 0 = no pattern, passive stereo", at_least(0.0, 0.9)},
      s.dots);
  v.field({"pattern", "", "random: each pixel of the projector by chance; spread: one dot in each square of a grid"},
          pipeline.layout, layouts);
  v.field({"uniqueness", "%",
           "semi_global: by which the best match must beat the second; more = more holes, fewer outliers",
           at_least(0.0, 100.0)},
          s.uniqueness);
  v.field({"max_difference", "pixel", "left-right check; smaller = more holes, fewer outliers", at_least(0.0, 100.0)},
          s.max_difference);
  v.field({"min_texture", "grey levels",
           "of 255: standard deviation in a window, beyond noise, below which nothing is matched; 0 = noise is matched "
           "as well",
           at_least(0.0, 255.0)},
          s.min_texture);
  v.field({"speckle_size", "pixel", "smaller islands of disparity are removed; 0 = none are", at_least(0.0, 1e5)},
          s.speckle_size);
  v.field({"disparity_noise", "pixel", "analytic: standard deviation at full signal", at_least(0.0, 10.0)},
          s.disparity_noise);
  v.field({"min_signal", "", "analytic: signal / full well below which nothing is matched (code 8)", above(0.0, 1.0)},
          s.min_signal);
  visit_filters(v, pipeline);
}

void check(const Sensor& sensor, const std::string& key) {
  const auto& s = sensor.settings.of<StereoSettings>();
  if (s.disparities % 16 != 0)
    throw input_error("is no multiple of 16", key + ".stereo.disparities", "the matcher wants one: 64, 128, 256");
  if (s.window % 2 == 0) throw input_error("is even", key + ".stereo.window", "5, 7 or 9 is usual");
  const auto& pipeline = sensor.settings.of<StereoPipeline>();
  if (pipeline.census % 2 == 0) throw input_error("is even", key + ".stereo.census", "5, 7 or 9 is usual");
  if (pipeline.matcher == StereoMatcher::census && s.window > most_census_window(pipeline.census))
    throw input_error("window and census are too large together", key + ".stereo.window",
                      "at most " + std::to_string(most_census_window(pipeline.census)) + " with this census");
  if (sensor.model == "stereo" &&
      std::any_of(sensor.distortion.begin(), sensor.distortion.end(), [](double d) { return d != 0.0; })) {
    throw input_error("a stereo camera delivers rectified images, which have no distortion", key + ".distortion",
                      "leave it out");
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
    throw input_error("disparities of " + std::to_string(std::lround(least)) + " (at far) to " +
                          std::to_string(std::lround(least + s.disparities)) + " pixels, more than the " +
                          std::to_string(most) + " that are matched",
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
  SensorModel m{"stereo", "the second camera, dots and matching", visit_keys, check, check_places, measured, sigma};
  m.imager = m.projector = m.fidelity = m.indirect = m.gray = true;
  m.report = report;
  return m;
}

}  // namespace

extern const SensorModel stereo_model = model();

}  // namespace bin_scenes
