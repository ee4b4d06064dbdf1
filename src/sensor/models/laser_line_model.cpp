/// A sheet of light as a SensorModel: keys, checks, and the model made from a sensor.
#include "bin_scenes/core/error.hpp"
#include "sensor/models/laser_line.hpp"
#include "sensor/models/of_sensor.hpp"
#include "sensor/report_points.hpp"

namespace bin_scenes {

namespace {

/// @param s  resolved()
LaserLine::Setup laser_line_setup(const Sensor& s) {
  LaserLine::Setup setup;
  setup.camera = lens_of(s);
  setup.camera_pose = *s.pose;
  setup.laser_pose = *s.laser.pose;
  setup.line_width = 1e-3 * s.laser.width_mm;
  setup.scan = s.scan.step * s.scan.direction.normalized();
  setup.profiles = s.scan.profiles;
  setup.settings = s.settings.of<LaserLineSettings>();
  setup.imager = s.imager;
  setup.noise = s.noise;
  setup.near = s.near, setup.far = s.far;
  setup.indirect = indirect_of(s);
  return setup;
}

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  LaserLineSettings& s = settings.of<LaserLineSettings>();
  v.field({"fan", "rad", "Opening angle of the sheet of light, symmetric about the z axis of the laser.",
           at_least(1e-3, 3.0)},
          s.fan);
  v.field({"power", "",
           "Signal at the peak of the line on a white matte surface that faces the laser, divided by the full well.",
           above(0.0, 1000.0)},
          s.power);
  v.field({"blur", "pixel", "Standard deviation of the blur of the camera. It adds to the width of the line.",
           at_least(0.2, 100.0)},
          s.blur);
  v.field({"speckle", "",
           "Contrast of the speckle in one pixel. Speckle displaces the peak of the line. With 0, there is no speckle.",
           at_least(0.0, 1.0)},
          s.speckle);
  v.field({"min_signal", "",
           "Smallest peak signal at which a line is detected, divided by the full well. Weaker lines are missing "
           "(validity code 4).",
           above(0.0, 1.0)},
          s.min_signal);
  v.field({"peak", "",
           "Which line is reported if a column of the image contains two. `strongest`: the one with the larger signal. "
           "`nearest`: the one with the smaller depth."},
          s.peak, {{"strongest", LaserLineSettings::Peak::strongest}, {"nearest", LaserLineSettings::Peak::nearest}});
}

void check(const Sensor& sensor, const std::string& key) {
  check_baseline(key + ".laser.baseline", sensor.laser.baseline);
  const Vec3& direction = sensor.scan.direction;
  if (!direction.allFinite() || !(direction.norm() > 0.0))
    throw input_error("has length 0", key + ".scan.direction", "give a direction, for instance [1, 0, 0]");
}

void check_places(const Sensor& sensor, const std::string& where) {
  const Vec3 sheet = sensor.laser.pose->orientation * Vec3::UnitX();
  if (std::abs(sheet.dot(sensor.laser.pose->position - sensor.pose->position)) < 1e-6)
    throw input_error("the sheet of light contains the camera, so that nothing can be measured by triangulation", where,
                      "move the laser along the x axis of its frame, or give a baseline");
}

RangeImage measured(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                    const Draw& draw) {
  Profiles profiles = LaserLine(scenery, surfaces, laser_line_setup(sensor), rays_of(draw)).scanned(random_of(draw));
  RangeImage image;
  image.width = profiles.width;
  image.height = profiles.height;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array<float, 3> no_normal{nan, nan, nan};
  for (std::size_t i = 0; i < profiles.points.size(); ++i) {
    const bool valid = profiles.validity[i] == Validity::valid;
    image.validity.push_back(static_cast<std::uint8_t>(profiles.validity[i]));
    image.depth.push_back(profiles.points[i][2]);
    image.label.push_back(valid ? profiles.label[i] : std::uint16_t{0});
    image.normal.push_back(valid ? profiles.normals[i] : no_normal);
  }
  image.intensity = std::move(profiles.intensity);
  image.snr = std::move(profiles.snr);
  image.points = std::move(profiles.points);
  image.truth_normal = std::move(view.normal);  // the others are of profiles, not of the camera's image
  add_truth(image, std::move(view));
  return image;
}

/// The pixel of the true camera, met with what is believed of the sheet. The carriage goes as it does.
void report(RangeImage& image, const Sensor& device, const Sensor& believed) {
  const Lens eye = lens_of(device), read = lens_of(believed);
  const LaserLine::Setup setup = laser_line_setup(believed);
  const Pose laser = believed.pose->inverse() * *believed.laser.pose, to_believed = believed.pose->inverse();
  const Vec3 sheet = laser.orientation * Vec3::UnitX();
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    if (std::isnan(image.depth[i])) continue;
    const Vec3 gone = (static_cast<double>(i / width) - 0.5 * (setup.profiles - 1)) * setup.scan;
    const auto& p = image.points[i];
    const Vec3 seen = Vec3(p[0], p[1], p[2]) - device.pose->orientation.conjugate() * gone;
    const auto pixel = eye.project(seen);
    const Vec3 ray = pixel ? read.ray(pixel->x(), pixel->y()) : Vec3::Constant(std::nan(""));
    const Vec3 met = sheet.dot(laser.position) / sheet.dot(ray) * ray + to_believed.orientation * gone;
    for (int axis = 0; axis < 3; ++axis) image.points[i][axis] = static_cast<float>(met[axis]);
    image.depth[i] = image.points[i][2];
  }
  report_depths(image, [](double, double, double depth) { return depth; });
}

double sigma(const Sensor& sensor, double distance, double incidence, double albedo) {
  const Plate plate(sensor, distance, incidence, albedo);
  return LaserLine(plate.scenery, plate.surfaces, laser_line_setup(sensor)).depth_sigma();
}

constexpr SensorModel model() {
  SensorModel m{"laser_line", "Settings of the model `laser_line`: a sheet of light, whose line a camera detects.",
                visit_keys,   check,
                check_places, measured,
                sigma};
  m.image = SensorModel::Image::profiles;
  m.imager = m.laser = m.indirect = true;
  m.bounces = 1;
  m.report = report;
  return m;
}

}  // namespace

extern const SensorModel laser_line_model = model();

}  // namespace bin_scenes
