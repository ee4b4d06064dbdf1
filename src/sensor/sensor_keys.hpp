/// The table of the keys of sensors; see scene/keys.hpp. The keys of sensor models come from their SensorModel.
#pragma once

#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/stereo_pipeline.hpp"

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

/// "structured_light, stereo", the models that use a device.
inline std::string names_of(bool SensorModel::*device) {
  std::string users;
  for (const SensorModel* model : sensor_models())
    if (model->*device) users += (users.empty() ? "" : ", ") + std::string(model->name);
  return users;
}
inline std::string users_of(bool SensorModel::*device) {
  return names_of(device) + ": ";
}

/// Those that see indirect light unless switched off.
inline std::string with_bounces() {
  std::string names;
  for (const SensorModel* model : sensor_models())
    if (model->bounces > 0) names += (names.empty() ? "" : ", ") + std::string(model->name);
  return names;
}

inline Names<Fidelity> names(Fidelity) {
  return {{"analytic", Fidelity::analytic}, {"decoded", Fidelity::decoded}};
}

template <class Visitor>
void visit(Visitor& v, Projector& projector) {
  v.field({"pose", "", "optical frame in the bin frame; left out: from baseline"}, projector.pose);
  v.field({"baseline", "m",
           "along the camera's x, turned towards the centre of the bin; longer = less noise and wider shadows; pose "
           "goes before it",
           at_least(-100.0, 100.0)},
          projector.baseline);
  v.field({"width", "pixel", "image width", at_least(1.0, 16384.0)}, projector.width);
  v.field({"height", "pixel", "image height", at_least(1.0, 16384.0)}, projector.height);
  v.field({"fov", "rad", "horizontal field of view; outside it nothing is measured", above(0.0, 3.1)}, projector.fov);
  v.field({"distortion", "", "of the lens, plumb_bob", at_least(-100.0, 100.0)}, projector.distortion);
}

template <class Visitor>
void visit(Visitor& v, Laser& laser) {
  v.field(
      {"pose", "", "frame whose y-z plane is the sheet of light, along z, in the bin frame; left out: from baseline"},
      laser.pose);
  v.field({"baseline", "m", "along the camera's x, turned towards the centre of the bin; pose goes before it",
           at_least(-100.0, 100.0)},
          laser.baseline);
  v.field({"width_mm", "mm", "width of the line on the surface; wider = more speckle noise", above(0.0, 100.0)},
          laser.width_mm);
}

template <class Visitor>
void visit(Visitor& v, Scan& scan) {
  v.field({"direction", "", "in which the sheet moves, in the bin frame; any length"}, scan.direction);
  v.field({"step", "m", "between two profiles", above(0.0, 10.0)}, scan.step);
  v.field({"profiles", "", "rows of the image; cost grows with it", at_least(1.0, 65536.0)}, scan.profiles);
}

template <class Visitor>
void visit(Visitor& v, ImagerSettings& s) {
  v.field({"exposure", "",
           "signal / full well of a white matte surface that faces the light at reference_distance; more = less noise, "
           "and bright or shiny parts saturate",
           above(0.0, 1000.0)},
          s.exposure);
  v.field({"exposures", "",
           "several, ascending, merged: a pixel takes the longest that does not saturate; structured_light, stereo, "
           "laser_line (of power); []: exposure alone",
           above(0.0, 1000.0)},
          s.exposures);
  v.field(
      {"reference_distance", "m",
       "from the light; 0 = automatic exposure: for a white surface parallel to the image at the median distance of "
       "what is lit",
       at_least(0.0, 1000.0)},
      s.reference_distance);
  v.field({"ambient", "", "except laser_line: signal / full well of white without the sensor's light; adds shot noise",
           at_least(0.0, 10.0)},
          s.ambient);
  v.field(
      {"full_well", "electrons", "at saturation; shot noise of a signal s is sqrt(s / full_well)", at_least(1.0, 1e9)},
      s.full_well);
  v.field({"read_noise", "electrons", "standard deviation; 0 = none", at_least(0.0, 1e6)}, s.read_noise);
  v.field({"blur", "pixel",
           "structured_light, image: standard deviation of the camera's blur; depth errs where bright meets dark; 0 = "
           "sharp",
           at_least(0.0, 3.0)},
          s.blur);
  v.field({"bits", "", "of the analogue-digital converter; fewer = coarser steps", at_least(1.0, 16.0)}, s.bits);
}

template <class Visitor>
void visit(Visitor& v, OutlierFilter& outlier) {
  v.field(
      {"neighbours", "", "so many pixels of the window need its depth; more = more holes; 0 = off", at_least(0.0, 1e5)},
      outlier.neighbours);
  v.field({"window", "pixel", "odd: edge of the window", at_least(3.0, 301.0)}, outlier.window);
  v.field({"step", "m", "largest difference of depth; smaller = steep faces go as well", above(0.0, 10.0)},
          outlier.step);
}

template <class Visitor>
void visit(Visitor& v, ReflectionFilter& reflection) {
  v.field({"step", "m", "largest difference of depth by two fringes; several times the noise; 0 = off",
           at_least(0.0, 10.0)},
          reflection.step);
  v.field({"period", "pixel", "projector pixels of the second fringe; shorter = finds more, noisier",
           at_least(4.0, 4096.0)},
          reflection.period);
}

template <class Visitor>
void visit(Visitor& v, EdgeFilter& edge) {
  v.field({"reach", "pixel", "so far from a step, on both of its sides; more = wider gaps around parts; 0 = off",
           at_least(0.0, 100.0)},
          edge.reach);
  v.field({"step", "m", "smallest difference of neighbours that is a step; smaller = steep faces go as well",
           above(0.0, 10.0)},
          edge.step);
}

template <class Visitor>
void visit(Visitor& v, ClusterFilter& cluster) {
  v.field({"pixels", "", "regions of fewer are taken away; 0 = off", at_least(0.0, 1e8)}, cluster.pixels);
  v.field({"step", "m", "neighbours that differ by more are not connected", above(0.0, 10.0)}, cluster.step);
}

template <class Visitor>
void visit(Visitor& v, MedianFilter& median) {
  v.field(
      {"window", "pixel", "odd: edge of the window; more = less noise, rounder corners; 0 = off", at_least(0.0, 31.0)},
      median.window);
}

template <class Visitor>
void visit(Visitor& v, SmoothingFilter& smoothing) {
  v.field({"sigma", "pixel", "width of the weights; more = less noise, rounder creases; 0 = off", at_least(0.0, 20.0)},
          smoothing.sigma);
  v.field({"step", "m", "what lies so far off the plane counts nothing; ten times the noise", above(0.0, 10.0)},
          smoothing.step);
}

template <class Visitor>
void visit(Visitor& v, FilterSettings& filter) {
  v.field({"snr", "", "pixels with less are taken away (code 4); 0 = off", at_least(0.0, 1e6)}, filter.snr);
  v.section({"outlier", "", "takes away pixels with too few neighbours of their depth (code 9)"}, filter.outlier);
  v.section({"reflection", "", "structured_light: takes away pixels whose light bounced (code 10)"}, filter.reflection);
  v.field(
      {"incidence", "rad",
       "pixels whose measured normal is farther from the view are taken away (code 9); smaller = fewer steep faces; "
       "0 = off",
       at_least(0.0, 1.5707963267948966)},
      filter.incidence);
  v.section({"edge", "", "takes away pixels at steps of depth (code 9)"}, filter.edge);
  v.section({"cluster", "", "takes away small regions (code 9)"}, filter.cluster);
  v.section({"median", "", "median of the depths around each pixel that is left; holes stay"}, filter.median);
  v.section({"smoothing", "", "smooths the depth of what is left; edges stay"}, filter.smoothing);
}

template <class Visitor>
void visit(Visitor& v, CalibrationSettings& sigma) {
  v.field({"focal", "pixel", "of fx; fy errs by the same share", at_least(0.0, 1000.0)}, sigma.focal);
  v.field({"center", "pixel", "of cx and of cy", at_least(0.0, 1000.0)}, sigma.center);
  v.field({"baseline", "m", "of the distance from camera to projector, laser or second camera", at_least(0.0, 1.0)},
          sigma.baseline);
  v.field({"position", "m", "of the whole device along each axis of its optical frame", at_least(0.0, 10.0)},
          sigma.position);
  v.field({"rotation", "rad", "of the whole device about each axis", at_least(0.0, 1.0)}, sigma.rotation);
  v.field({"range", "m", "of an offset of all ranges: time_of_flight", at_least(0.0, 1.0)}, sigma.range);
}

inline Names<ImageLamp::Type> names(ImageLamp::Type) {
  using Type = ImageLamp::Type;
  return {{"area", Type::area}, {"ring", Type::ring}, {"dome", Type::dome}, {"projector", Type::projector}};
}

template <class Visitor>
void visit(Visitor& v, ImageLamp& lamp) {
  v.field({"type", "", "dome: light from everywhere; projector: its white light"}, lamp.type);
  v.field({"pose", "", "area, ring: light leaves along z; left out: the camera's"}, lamp.pose);
  v.field({"radiance", "", "projector: of a white surface at 1 m", at_least(0.0, 1e9)}, lamp.radiance);
  v.field({"colour", "", "RGB, times radiance", at_least(0.0, 1e3)}, lamp.colour);
  v.field({"width", "m", "area: along x", above(0.0, 100.0)}, lamp.width);
  v.field({"height", "m", "area: along y", above(0.0, 100.0)}, lamp.height);
  v.field({"outer", "m", "ring: radius", above(0.0, 100.0)}, lamp.outer);
  v.field({"inner", "m", "0 = a disk", at_least(0.0, 100.0)}, lamp.inner);
  v.field({"horizon", "", "dome: radiance there and below / at the zenith", at_least(0.0, 1e3)}, lamp.horizon);
  v.field({"picture", "", "dome: equirectangular, Radiance .hdr"}, lamp.picture);
  v.field({"turn", "rad", "of the picture about the vertical", at_least(-100.0, 100.0)}, lamp.turn);
}

template <class Visitor>
void visit(Visitor& v, Views& views) {
  v.field({"poses", "", "optical frames in the bin frame, one a view"}, views.poses);
  v.field({"count", "", "instead of poses: so many, spread evenly over a dome; view 0 is the most upright"},
          views.count);
  v.field({"distance", "m", "of the dome, from target"}, views.distance);
  v.field({"tilt", "rad", "largest angle between a view and the vertical; below pi/2"}, views.tilt);
  v.field({"target", "m", "what they look at; [0, 0, 0] is the centre of the floor"}, views.target);
}

/// Keys of the view of a sensor: its name, model, lens, pose and range.
template <class Visitor>
void visit_view(Visitor& v, Sensor& sensor) {
  v.field({"name", "", "names frames and files; letters, digits, _ and -, different for each sensor"}, sensor.name);
  Word model{sensor.model, {}};
  for (const SensorModel* known : sensor_models()) model.known.emplace_back(known->name);
  v.field({"model", "", "ideal: exact depth at pixel centres"}, model);
  sensor.model = model.value;
  v.field({"preset", "", "file of config/sensors whose values are the defaults here"}, sensor.preset);
  v.field({"width", "pixel", "image width", at_least(1.0, 16384.0)}, sensor.width);
  v.field({"height", "pixel", "image height", at_least(1.0, 16384.0)}, sensor.height);
  v.field({"fov", "rad", "horizontal field of view; sets the intrinsics unless k is given", above(0.0, 3.1)},
          sensor.fov);
  v.field({"k", "pixel", "3x3 row-major intrinsics [fx, 0, cx, 0, fy, cy, 0, 0, 1] instead of fov", anything,
           !sensor.k.empty()},
          sensor.k);
  v.field({"distortion", "", "of the lens, plumb_bob; 0 = a pinhole", at_least(-100.0, 100.0)}, sensor.distortion);
  v.field({"pose", "",
           "optical frame (x right, y down, z forward) in the bin frame; left out: above the bin, looking down, the "
           "whole rim in view"},
          sensor.pose);
  v.section({"views", "", "instead of pose: several, as sensors NAME_0, NAME_1, ...", anything, false}, sensor.views);
  v.field({"view_of", "", "sensor of which this is a further view; written where views are spelled out", anything,
           !sensor.view_of.empty()},
          sensor.view_of);
  v.field(
      {"pose_of", "", "another sensor, whose lens, place and projector it takes", anything, !sensor.pose_of.empty()},
      sensor.pose_of);
  v.field({"near", "m", "nothing nearer is seen", above(0.0)}, sensor.near);
  v.field({"far", "m", "nothing farther is seen", above(0.0, 1e4)}, sensor.far);
}

/// Devices beside the camera's lens.
template <class Visitor>
void visit_devices(Visitor& v, Sensor& sensor) {
  const std::string fidelity = users_of(&SensorModel::fidelity) +
                               "analytic draws noise and gaps from formulas; decoded makes and reads images as a "
                               "device does, slower";
  v.field({"fidelity", "", fidelity.c_str()}, sensor.fidelity);
  const std::string projector = users_of(&SensorModel::projector) + "source of the pattern";
  v.section({"projector", "", projector.c_str()}, sensor.projector);
  const std::string laser = users_of(&SensorModel::laser) + "the sheet of light";
  v.section({"laser", "", laser.c_str()}, sensor.laser);
  const std::string scan =
      users_of(&SensorModel::laser) + "how camera and laser move; poses are those at the centre of the scan";
  v.section({"scan", "", scan.c_str()}, sensor.scan);
  const std::string imager = users_of(&SensorModel::imager) + "the camera's chip";
  v.section({"imager", "", imager.c_str()}, sensor.imager);
}

template <class Visitor>
void visit(Visitor& v, Sensor& sensor) {
  visit_view(v, sensor);
  visit_devices(v, sensor);
  CalibrationSettings& calibration = sensor.settings.of<CalibrationSettings>();
  v.section(
      {"calibration", "", "sigmas of its errors, drawn once from seed and sensor about the request's values; 0 = exact",
       anything, calibration.any()},
      calibration);
  FilterSettings& filter = sensor.settings.of<FilterSettings>();
  v.section({"filter", "", "of the driver; off unless given", anything, filter.any()}, filter);
  v.list({"lamps", "", "image: what lights it; left out: a dome"}, sensor.settings.of<ImageSettings>().lamps);
  for (const SensorModel* known : sensor_models()) {
    if (!known->visit) continue;
    SettingsOfModel section{*known, sensor.settings};
    v.section({known->name, "", known->text}, section);
  }
  const std::string bounces = users_of(&SensorModel::indirect) +
                              "other surfaces that light may meet; more = depth errs in corners and on "
                              "shiny parts, slower; left out: 1 for " +
                              with_bounces() + ", else 0";
  v.field({"bounces", "", bounces.c_str(), at_least(0.0, 2.0)}, sensor.bounces);
  v.field({"indirect_samples", "", "rays that look for such light; more = less noise, slower", at_least(4.0, 4096.0)},
          sensor.indirect_samples);
  v.field({"noise", "", "false: every random effect is off; geometry stays"}, sensor.noise);
  v.field({"depth_unit", "m",
           "with noise: measured depth is rounded to multiples of it, of laser_line the z of each point; the truth is "
           "not; 0 = not rounded",
           at_least(0.0, 0.1)},
          sensor.settings.of<DepthFormat>().unit);
}

}  // namespace bin_scenes
