/// A fringe projector before the groove of shot.hpp, for bench/light.cpp and tests.
#pragma once

#include "bin_scenes/sensor/resolve.hpp"
#include "sensor/models/structured_light.hpp"

#include <cmath>

namespace bin_scenes::test {

/// @param period  projector pixels a fringe
inline StructuredLight::Setup groove_device(double period, int bounces) {
  StructuredLight::Setup setup;
  const Projector usual;
  setup.projector = lens_of(usual);
  setup.projector_pose = {Vec3(usual.baseline, 0.0, 0.0),
                          Quat(Eigen::AngleAxisd(-std::atan(usual.baseline / 0.75), Vec3::UnitY()))};
  setup.settings.period = period;
  setup.imager.exposure = 0.4;  // both faces' light stays below saturation
  setup.near = 0.3;
  setup.far = 1.3;
  setup.indirect.bounces = bounces;
  return setup;
}

/// The pixels of the groove of a camera of 1944 columns and a field of view of 0.997 rad.
inline Lens groove_camera() {
  Lens lens = Lens::from_fov(1944, 1200, 0.997);
  lens.cx -= 871.0, lens.cy -= 580.0;
  lens.width = 202, lens.height = 40;
  return lens;
}

}  // namespace bin_scenes::test
