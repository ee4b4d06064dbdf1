/// The table of keys of sensors and surfaces (see keys.hpp).
#pragma once

#include "bin_scenes/scene/request.hpp"
#include "config/key.hpp"
#include "config/sensor_model_keys.hpp"

namespace bin_scenes::config {

inline Names<SensorModel> names(SensorModel) {
  Names<SensorModel> all;
  for (const SensorModel model : sensor_models) all.emplace_back(name_of(model), model);
  return all;
}
inline Names<Fidelity> names(Fidelity) {
  return {{"analytic", Fidelity::analytic}, {"decoded", Fidelity::decoded}};
}

template <class Visitor>
void visit(Visitor& v, Surface& surface) {
  v.field({"albedo", "", "share of the light that is sent back, 0 to 1; dark parts are noisier and drop out"},
          surface.albedo);
  v.field({"gloss", "", "share of that which is mirrored, 0 to 1; shiny parts saturate or drop out"}, surface.gloss);
  v.field({"roughness", "", "width of the mirrored lobe, 0 to 1; smaller = narrower and brighter highlights"},
          surface.roughness);
}

template <class Visitor>
void visit(Visitor& v, Projector& projector) {
  v.field({"pose", "", "optical frame in the bin frame; left out: from baseline"}, projector.pose);
  v.field({"baseline", "m",
           "along the camera's x, turned towards the middle of the bin; longer = less noise and wider shadows; pose "
           "goes before it"},
          projector.baseline);
  v.field({"width", "pixel", "image width"}, projector.width);
  v.field({"height", "pixel", "image height"}, projector.height);
  v.field({"fov", "rad", "horizontal field of view; outside it nothing is measured"}, projector.fov);
  v.field({"distortion", "", "of the lens, plumb_bob k1 k2 p1 p2 k3"}, projector.distortion);
}

template <class Visitor>
void visit(Visitor& v, Laser& laser) {
  v.field(
      {"pose", "", "frame whose y-z plane is the sheet of light, along z, in the bin frame; left out: from baseline"},
      laser.pose);
  v.field({"baseline", "m", "along the camera's x, turned towards the middle of the bin; pose goes before it"},
          laser.baseline);
  v.field({"width_mm", "mm", "width of the line on the surface; wider = more speckle noise"}, laser.width_mm);
}

template <class Visitor>
void visit(Visitor& v, Scan& scan) {
  v.field({"direction", "", "in which the sheet moves, in the bin frame; any length"}, scan.direction);
  v.field({"step", "m", "between two profiles"}, scan.step);
  v.field({"profiles", "", "rows of the image; cost grows with it"}, scan.profiles);
}

template <class Visitor>
void visit(Visitor& v, Sensor& sensor) {
  v.field({"name", "", "names frames and files; letters, digits, _ and -, different for each sensor"}, sensor.name);
  v.field({"model", "", "what a sensor makes of what it sees; ideal is exact depth at pixel centres"}, sensor.model);
  v.field({"preset", "",
           "name of a file of config/sensors whose values are the defaults here; keys given here go before them"},
          sensor.preset);
  v.field({"width", "pixel", "image width"}, sensor.width);
  v.field({"height", "pixel", "image height"}, sensor.height);
  v.field({"fov", "rad", "horizontal field of view; sets the intrinsics unless k is given"}, sensor.fov);
  v.field({"k", "pixel", "3x3 row-major intrinsics [fx, 0, cx, 0, fy, cy, 0, 0, 1] instead of fov", !sensor.k.empty()},
          sensor.k);
  v.field({"distortion", "", "of the lens, plumb_bob k1 k2 p1 p2 k3; 0 = a pinhole"}, sensor.distortion);
  v.field({"pose", "",
           "optical frame (x right, y down, z forward) in the bin frame; left out: above the bin, looking down, the "
           "whole rim in view"},
          sensor.pose);
  v.field({"near", "m", "nothing nearer is seen"}, sensor.near);
  v.field({"far", "m", "nothing farther is seen"}, sensor.far);
  v.field({"fidelity", "",
           "structured_light, stereo: analytic draws noise and gaps from formulas; decoded makes the images and "
           "evaluates them as a device does, several times slower"},
          sensor.fidelity);
  v.section({"projector", "", "structured_light, stereo: source of the pattern"}, sensor.projector);
  v.section({"laser", "", "laser_line: the sheet of light"}, sensor.laser);
  v.section({"scan", "", "laser_line: how camera and laser move; their poses are those at the middle of the way"},
            sensor.scan);
  v.section({"imager", "", "structured_light, laser_line, stereo: the camera's chip"}, sensor.imager);
  v.section({"structured_light", "", "fringes: phase shift and Gray code"}, sensor.structured_light);
  v.section({"laser_line", "", "the line of light and its peak"}, sensor.laser_line);
  v.section({"stereo", "", "the second camera, dots and matching"}, sensor.stereo);
  v.section({"time_of_flight", "", "noise along the ray and across it"}, sensor.time_of_flight);
  v.field({"bounces", "",
           "structured_light, stereo: how many other surfaces light may meet, 0 to 2: depth errs in corners and on "
           "shiny parts; left out: 1 of structured_light, 0 of others"},
          sensor.bounces);
  v.field({"indirect_samples", "", "rays that look for such light, 4 to 4096; more = less noise in it, slower"},
          sensor.indirect_samples);
  v.field({"noise", "", "false: every random effect is off; geometry (shadow, field of view) stays"}, sensor.noise);
}

}  // namespace bin_scenes::config
