/// Scenes to convert: every field set to a value of its own, so that a swapped or forgotten one is seen.
#pragma once

#include "bin_scenes/scene/scene.hpp"

namespace bin_scenes::testing {

inline Pose some_pose(double shift) {
  return {Vec3(0.1 + shift, -0.2, 0.3), Quat(Eigen::AngleAxisd(0.5 + shift, Vec3(1, 2, 3).normalized()))};
}

inline Sensor some_sensor(const std::string& name, double shift) {
  Sensor sensor;
  sensor.name = name;
  sensor.width = 4;
  sensor.height = 3;
  sensor.fov = 0.7 + shift;
  sensor.k = {5.0 + shift, 0, 1.5, 0, 5.0 + shift, 1.0, 0, 0, 1};
  sensor.pose = Pose{Vec3(0, 0, 0.6 + shift), Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX()))};
  sensor.near = 0.1;
  sensor.far = 2.0 + shift;
  return sensor;
}

inline Report full_report() {
  Report r;
  r.at_rest = true;
  r.accepted = false;
  r.reasons = {"penetration", "escaped"};
  r.solver = "sphere";
  r.solver_reason = "measured cheaper";
  r.device = "llvmpipe";
  r.simulated_s = 1.25;
  r.wall_s = 2.5;
  r.finish = "pressed";
  r.steps = 300;
  r.profile.stages_ms = {{"pour", 12.5}, {"settle", 40.0}};
  r.profile.counters = {{"contacts", 1234567890123ull}, {"skipped_pairs", 7}};
  static_cast<Quantiles&>(r.penetration) = {1e-5, 2e-5, 3e-5};
  r.penetration.pair = {0, 2};
  r.penetration.p95_relative = 4e-4;
  r.penetration.max_relative = 5e-4;
  r.penetration.bin_median = 4e-5;
  r.penetration.bin_p95 = 5e-5;
  r.penetration.bin_max = 6e-5;
  r.penetration.bin_part = 1;
  r.penetration.pairs = 9;
  r.gap = {7e-6, 8e-6, 9e-6};
  static_cast<Quantiles&>(r.drift) = {1e-6, 2e-6, 3e-6};
  r.drift.measured = true;
  r.drift.turn_p95 = 0.01;
  r.worst = {{true, 1e-3, 0.02, {0, 2}, 0.75}, {0.003, 0.5}, 4};
  r.escaped = {1};
  r.unstable = {0, 2};
  r.not_poured = {3};
  r.state_hash = 0xfedcba9876543210ull;
  r.flags = {{"mesh_repaired", "2 holes closed", "repair the file"}};
  return r;
}

/// Four parts, one of each fate; the last was never poured and has no pose.
inline Scene full_scene() {
  Scene scene;
  scene.seed = 0x8000000000000001ull;
  scene.index = 42;
  scene.sensors = {some_sensor("camera", 0.0), some_sensor("side", 0.1)};
  const PartState states[] = {PartState::resting, PartState::escaped, PartState::fixed, PartState::not_poured};
  for (int id = 0; id < 4; ++id) {
    ScenePart part;
    part.id = id;
    part.line = id / 2;
    part.model = id < 2 ? "bolt.stl" : "package://bin_scenes/models/nut.stl";
    part.pose = some_pose(0.1 * id);
    part.velocity.linear = Vec3(1e-3, 2e-3, 3e-3) * id;
    part.velocity.angular = Vec3(4e-3, 5e-3, 6e-3) * id;
    part.state = states[id];
    if (id < 2) part.visible_fraction = {{"camera", 0.25 * id}, {"side", 0.5}};
    scene.parts.push_back(part);
  }
  scene.parts[3].pose.position = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  scene.report = full_report();
  return scene;
}

inline Request request_of(const Scene&) {
  Request request;
  request.text_sha256 = "c0ffee";
  request.bin.inner_size = Vec3(0.3, 0.2, 0.1);
  request.bin.friction = 0.0;
  PartLine bolt, nut;
  bolt.model = bolt.path = "bolt.stl";
  nut.model = "package://bin_scenes/models/nut.stl";
  nut.path = "nut.stl";
  bolt.count = nut.count = 2;
  nut.scale = 2.0;
  request.parts = {bolt, nut};
  return request;
}

}  // namespace bin_scenes::testing
