/// The table of the keys of sensors; see scene/keys.hpp. The keys of sensor models come from their SensorModel, and
/// those of filters from filter_keys.hpp.
#pragma once

#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/stereo_pipeline.hpp"
#include "sensor/filter_keys.hpp"

#include <functional>
#include <string>

namespace bin_scenes {

/// A section within the settings of a model.
struct KeysOfModel {
  const std::function<void(KeyVisitor&)>& visit_keys;
};
template <class Visitor>
void visit(Visitor& v, KeysOfModel& section);

/// Presents a visitor of tables (a template) to sensor models as a KeyVisitor (an interface).
template <class Visitor>
class AsKeyVisitor final : public KeyVisitor {
 public:
  explicit AsKeyVisitor(Visitor& visitor) : visitor_(visitor) {}
  void section(const Key& key, const std::function<void(KeyVisitor&)>& visit_keys) override {
    KeysOfModel keys{visit_keys};
    visitor_.section(key, keys);
  }
  void field(const Key& key, double& value) override { visitor_.field(key, value); }
  void field(const Key& key, int& value) override { visitor_.field(key, value); }
  void field(const Key& key, bool& value) override { visitor_.field(key, value); }
  void field(const Key& key, Word& value) override { visitor_.field(key, value); }

 private:
  Visitor& visitor_;
};

template <class Visitor>
void visit(Visitor& v, KeysOfModel& section) {
  AsKeyVisitor<Visitor> keys(v);
  section.visit_keys(keys);
}

/// A section of the settings of one model.
struct SettingsOfModel {
  const SensorModel& model;
  ModelSettings& settings;
};

template <class Visitor>
void visit(Visitor& v, SettingsOfModel& section) {
  AsKeyVisitor<Visitor> keys(v);
  section.model.visit(keys, section.settings);
}

/// Returns the names of all models with a property, for example "structured_light and stereo".
template <class Property>
std::string names_of(Property SensorModel::*property) {
  std::string names, last;
  for (const SensorModel* model : sensor_models()) {
    if (!(model->*property)) continue;
    if (!last.empty()) names += (names.empty() ? "" : ", ") + last;
    last = std::string("`") + model->name + "`";
  }
  return names.empty() ? last : names + " and " + last;
}
/// Begins the text of a key that only the models with this property have.
inline std::string only_for(bool SensorModel::*property) {
  const std::string names = names_of(property);
  return std::string("Only for the model") + (names.find(' ') == std::string::npos ? " " : "s ") + names + ": ";
}

inline Names<Fidelity> names(Fidelity) {
  return {{"analytic", Fidelity::analytic}, {"decoded", Fidelity::decoded}};
}

template <class Visitor>
void visit(Visitor& v, Projector& projector) {
  v.field({"pose", "",
           "Pose of the projector's optical frame in the bin frame. If it is not given, it follows from `baseline`."},
          projector.pose);
  v.field({"baseline", "m",
           "Distance from the camera to the projector along the x axis of the camera. The projector is turned towards "
           "the centre of the bin. A longer baseline gives less noise and wider shadows. This key has no effect if "
           "`pose` is given.",
           at_least(-100.0, 100.0)},
          projector.baseline);
  v.field({"width", "pixel", "Width of the projected image.", at_least(1.0, 16384.0)}, projector.width);
  v.field({"height", "pixel", "Height of the projected image.", at_least(1.0, 16384.0)}, projector.height);
  v.field(
      {"fov", "rad", "Horizontal field of view of the projector. Nothing is measured outside of it.", above(0.0, 3.1)},
      projector.fov);
  v.field({"distortion", "", "Coefficients of the distortion of the projector's lens, by the ROS model `plumb_bob`.",
           at_least(-100.0, 100.0)},
          projector.distortion);
}

template <class Visitor>
void visit(Visitor& v, Laser& laser) {
  v.field({"pose", "",
           "Pose of the laser's frame in the bin frame. The sheet of light is the y-z plane of this frame, and the "
           "light leaves along z. If the pose is not given, it follows from `baseline`."},
          laser.pose);
  v.field({"baseline", "m",
           "Distance from the camera to the laser along the x axis of the camera. The laser is turned towards the "
           "centre of the bin. This key has no effect if `pose` is given.",
           at_least(-100.0, 100.0)},
          laser.baseline);
  v.field({"width_mm", "mm", "Width of the line of light on the surface. A wider line has more speckle noise.",
           above(0.0, 100.0)},
          laser.width_mm);
}

template <class Visitor>
void visit(Visitor& v, Scan& scan) {
  v.field({"direction", "",
           "Direction in which camera and laser move, in the bin frame. The length of the vector has no effect."},
          scan.direction);
  v.field({"step", "m", "Distance between two successive profiles.", above(0.0, 10.0)}, scan.step);
  v.field({"profiles", "", "Number of profiles, which are the rows of the image. The computing time grows with it.",
           at_least(1.0, 65536.0)},
          scan.profiles);
}

template <class Visitor>
void visit(Visitor& v, ImagerSettings& s) {
  v.field({"exposure", "",
           "Signal of a white matte surface that faces the light at `reference_distance`, divided by the full well. A "
           "larger exposure gives less noise, but bright or shiny parts saturate.",
           above(0.0, 1000.0)},
          s.exposure);
  v.field({"exposures", "",
           "Exposures of several images that are merged, in ascending order: each pixel uses the longest exposure with "
           "which it does not saturate. They replace `exposure` for the models `structured_light` and `stereo`, and "
           "`power` for `laser_line`. With an empty list, there is one exposure.",
           above(0.0, 1000.0)},
          s.exposures);
  v.field({"reference_distance", "m",
           "Distance from the light at which `exposure` is defined. With 0, the exposure is automatic: it is defined "
           "for a white surface parallel to the image at the median distance of everything that is lit.",
           at_least(0.0, 1000.0)},
          s.reference_distance);
  v.field({"ambient", "",
           "Signal of a white surface without the light of the sensor, divided by the full well. Ambient light adds "
           "shot noise. It has no effect on the model `laser_line`.",
           at_least(0.0, 10.0)},
          s.ambient);
  v.field({"full_well", "electrons",
           "Number of electrons of a saturated pixel. The shot noise of a signal s, where 1 is saturated, is sqrt(s / "
           "full_well).",
           at_least(1.0, 1e9)},
          s.full_well);
  v.field({"read_noise", "electrons", "Standard deviation of the read noise. With 0, there is no read noise.",
           at_least(0.0, 1e6)},
          s.read_noise);
  v.field({"blur", "pixel",
           "Only for the models `structured_light` and `image`: standard deviation of the blur of the camera. It "
           "causes errors of depth where bright and dark surfaces meet. With 0, images are sharp.",
           at_least(0.0, 3.0)},
          s.blur);
  v.field({"bits", "", "Number of bits of the analogue-to-digital converter. Fewer bits give coarser steps.",
           at_least(1.0, 16.0)},
          s.bits);
}

template <class Visitor>
void visit(Visitor& v, CalibrationSettings& sigma) {
  v.field({"focal", "pixel",
           "Standard deviation of the error of the focal length fx. The focal length fy has the same relative error.",
           at_least(0.0, 1000.0)},
          sigma.focal);
  v.field({"center", "pixel", "Standard deviation of the error of each coordinate of the principal point, cx and cy.",
           at_least(0.0, 1000.0)},
          sigma.center);
  v.field({"baseline", "m",
           "Standard deviation of the error of the distance from the camera to the projector, laser or second camera.",
           at_least(0.0, 1.0)},
          sigma.baseline);
  v.field({"position", "m",
           "Standard deviation of the error of the position of the whole device, along each axis of its optical frame.",
           at_least(0.0, 10.0)},
          sigma.position);
  v.field(
      {"rotation", "rad",
       "Standard deviation of the error of the orientation of the whole device, about each axis of its optical frame.",
       at_least(0.0, 1.0)},
      sigma.rotation);
  v.field({"range", "m", "Only for the model `time_of_flight`: standard deviation of a constant error of all ranges.",
           at_least(0.0, 1.0)},
          sigma.range);
}

inline Names<ImageLamp::Type> names(ImageLamp::Type) {
  using Type = ImageLamp::Type;
  return {{"area", Type::area}, {"ring", Type::ring}, {"dome", Type::dome}, {"projector", Type::projector}};
}

template <class Visitor>
void visit(Visitor& v, ImageLamp& lamp) {
  v.field({"type", "",
           "Kind of lamp. `area`: a rectangle. `ring`: a flat ring or disk. `dome`: light from all directions. "
           "`projector`: white light from the projector of the sensor."},
          lamp.type);
  v.field({"pose", "",
           "For `area` and `ring`: pose of the lamp in the bin frame. The light leaves along z. If the pose is not "
           "given, it is that of the camera."},
          lamp.pose);
  v.field({"radiance", "",
           "Radiance of the lamp. For `projector`, it is the radiance of a white surface at a distance of 1 m. Only "
           "the ratios between lamps matter, because the exposure is automatic.",
           at_least(0.0, 1e9)},
          lamp.radiance);
  v.field({"colour", "", "Factors for red, green and blue by which the radiance is multiplied.", at_least(0.0, 1e3)},
          lamp.colour);
  v.field({"width", "m", "For `area`: size of the lamp along its x axis.", above(0.0, 100.0)}, lamp.width);
  v.field({"height", "m", "For `area`: size of the lamp along its y axis.", above(0.0, 100.0)}, lamp.height);
  v.field({"outer", "m", "For `ring`: outer radius.", above(0.0, 100.0)}, lamp.outer);
  v.field({"inner", "m", "For `ring`: inner radius. With 0, the lamp is a disk.", at_least(0.0, 100.0)}, lamp.inner);
  v.field({"horizon", "", "For `dome`: radiance at the horizon and below it, divided by the radiance at the zenith.",
           at_least(0.0, 1e3)},
          lamp.horizon);
  v.field({"picture", "",
           "For `dome`: path of an equirectangular picture of the surroundings, in the format Radiance (.hdr)."},
          lamp.picture);
  v.field({"turn", "rad", "For `dome`: rotation of the picture about the vertical.", at_least(-100.0, 100.0)},
          lamp.turn);
}

template <class Visitor>
void visit(Visitor& v, Views& views) {
  v.field({"poses", "", "Poses of the optical frame in the bin frame, one for each view."}, views.poses);
  v.field(
      {"count", "",
       "Number of views that are distributed evenly over a dome, instead of `poses`. View 0 is the most upright one."},
      views.count);
  v.field({"distance", "m", "Distance of the views from `target`, which is the radius of the dome."}, views.distance);
  v.field({"tilt", "rad", "Largest angle between a view and the vertical. It must be below pi / 2."}, views.tilt);
  v.field({"target", "m", "Point at which all views look, in the bin frame. [0, 0, 0] is the centre of the floor."},
          views.target);
}

/// Keys of the view of a sensor: its name, model, lens, pose and range.
template <class Visitor>
void visit_view(Visitor& v, Sensor& sensor) {
  v.field({"name", "",
           "Name of the sensor, which is used in the names of frames and files. It may contain letters, digits, _ and "
           "-, and must be different for each sensor."},
          sensor.name);
  Word model{sensor.model, {}};
  for (const SensorModel* known : sensor_models()) model.known.emplace_back(known->name);
  v.field({"model", "",
           "Sensor model, which turns the view of the camera into what a device measures. `ideal` measures the exact "
           "depth at the centres of the pixels."},
          model);
  sensor.model = model.value;
  v.field({"preset", "",
           "Name of a file in `config/sensors`. The values in this file are the defaults of the other keys of this "
           "sensor."},
          sensor.preset);
  v.field({"width", "pixel", "Width of the image.", at_least(1.0, 16384.0)}, sensor.width);
  v.field({"height", "pixel", "Height of the image.", at_least(1.0, 16384.0)}, sensor.height);
  v.field({"fov", "rad", "Horizontal field of view of the camera. It determines the intrinsics unless `k` is given.",
           above(0.0, 3.1)},
          sensor.fov);
  v.field({"k", "pixel",
           "Intrinsics of the camera as a row-major 3x3 matrix [fx, 0, cx, 0, fy, cy, 0, 0, 1]. They replace `fov`.",
           anything, !sensor.k.empty()},
          sensor.k);
  v.field({"distortion", "",
           "Coefficients of the distortion of the lens, by the ROS model `plumb_bob`. If all are 0, the camera is a "
           "pinhole camera.",
           at_least(-100.0, 100.0)},
          sensor.distortion);
  v.field({"pose", "",
           "Pose of the optical frame (x to the right, y down, z forward) in the bin frame. If it is not given, the "
           "camera is above the bin, looks down and sees the whole rim."},
          sensor.pose);
  v.section({"views", "",
             "Several poses of the sensor, instead of `pose`. Each view becomes a sensor, with the names NAME_0, "
             "NAME_1 and so on.",
             anything, false},
            sensor.views);
  v.field({"view_of", "",
           "Name of the sensor of which this sensor is a further view. It is written if `views` were replaced by a "
           "sensor for each view.",
           anything, !sensor.view_of.empty()},
          sensor.view_of);
  v.field(
      {"pose_of", "", "Name of another sensor. This sensor has the lens, the pose and the projector of that sensor.",
       anything, !sensor.pose_of.empty()},
      sensor.pose_of);
  v.field({"near", "m", "Smallest depth that the sensor sees. Nearer surfaces are invisible to it.", above(0.0)},
          sensor.near);
  v.field({"far", "m", "Largest depth that the sensor sees. Farther surfaces are invisible to it.", above(0.0, 1e4)},
          sensor.far);
}

/// Keys of the fidelity, and of the devices that a sensor has in addition to its camera, such as a projector.
template <class Visitor>
void visit_devices(Visitor& v, Sensor& sensor) {
  const std::string fidelity = only_for(&SensorModel::fidelity) +
                               "how closely the device is simulated. `analytic`: noise and missing pixels are computed "
                               "from formulas. `decoded`: "
                               "images are made and decoded as the device does it, which is slower.";
  v.field({"fidelity", "", fidelity.c_str()}, sensor.fidelity);
  const std::string projector = only_for(&SensorModel::projector) + "projector of the pattern.";
  v.section({"projector", "", projector.c_str()}, sensor.projector);
  const std::string laser = only_for(&SensorModel::laser) + "laser that emits a sheet of light.";
  v.section({"laser", "", laser.c_str()}, sensor.laser);
  const std::string scan = only_for(&SensorModel::laser) +
                           "how camera and laser move over the bin. The poses in the request are those at the centre "
                           "of this movement.";
  v.section({"scan", "", scan.c_str()}, sensor.scan);
  const std::string imager = only_for(&SensorModel::imager) + "image sensor of the camera.";
  v.section({"imager", "", imager.c_str()}, sensor.imager);
}

template <class Visitor>
void visit(Visitor& v, Sensor& sensor) {
  visit_view(v, sensor);
  visit_devices(v, sensor);
  CalibrationSettings& calibration = sensor.settings.of<CalibrationSettings>();
  v.section({"calibration", "",
             "Standard deviations of calibration errors. The true values of the device are drawn around the values in "
             "the request, once for each seed and sensor. With 0, there is no error.",
             anything, calibration.any()},
            calibration);
  FilterSettings& filter = sensor.settings.of<FilterSettings>();
  v.section(
      {"filter", "",
       "Filters that process the measured image as the driver of a device does. Filters that are not given are off.",
       anything, filter.any()},
      filter);
  v.list({"lamps", "",
          "Only for the model `image`: lamps that light the scene. If none is given, the light comes from a dome."},
         sensor.settings.of<ImageSettings>().lamps);
  for (const SensorModel* known : sensor_models()) {
    if (!known->visit) continue;
    SettingsOfModel section{*known, sensor.settings};
    v.section({known->name, "", known->text}, section);
  }
  const std::string bounces = only_for(&SensorModel::indirect) +
                              "largest number of other surfaces that may reflect the light on its path to the surface "
                              "that a pixel sees. Larger numbers cause errors of depth in corners and on shiny parts, "
                              "as in reality, and take more time. The default is 1 for " +
                              names_of(&SensorModel::bounces) + ", and 0 for all other models.";
  v.field({"bounces", "", bounces.c_str(), at_least(0.0, 2.0)}, sensor.bounces);
  v.field({"indirect_samples", "",
           "Number of rays with which the light that other surfaces reflect is sampled. More rays give less noise and "
           "take more time.",
           at_least(4.0, 4096.0)},
          sensor.indirect_samples);
  v.field(
      {"noise", "", "If false, every random effect is switched off. Effects of geometry, for example shadows, remain."},
      sensor.noise);
  v.field({"depth_unit", "m",
           "If `noise` is true, measured depth is rounded to multiples of this value; for the model `laser_line`, it "
           "is the z coordinate of each point. True depth is not rounded. With 0, nothing is rounded.",
           at_least(0.0, 0.1)},
          sensor.settings.of<DepthFormat>().unit);
}

}  // namespace bin_scenes
