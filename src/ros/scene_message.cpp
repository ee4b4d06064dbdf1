/// Field by field, in both directions; a test fills every field. Kinds that a message writes as names are those of the
/// request.
#include "scene_message.hpp"

#include "bin_scenes/sensor/sensor_model.hpp"

#include <algorithm>
#include <limits>

namespace bin_scenes {

namespace {

namespace msgs = bin_scenes_msgs;

// The message's constants are the library's enumeration, in its order.
static_assert(int(PartState::resting) == msgs::ScenePart::RESTING && int(PartState::moving) == msgs::ScenePart::MOVING);
static_assert(int(PartState::escaped) == msgs::ScenePart::ESCAPED && int(PartState::fixed) == msgs::ScenePart::FIXED);
static_assert(int(PartState::not_poured) == msgs::ScenePart::NOT_POURED);
static_assert(int(PartState::removed) == msgs::ScenePart::REMOVED);

geometry_msgs::Vector3 vector_message(const Vec3& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

Vec3 vector_from(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

msgs::Quantiles quantiles_message(const Quantiles& q) {
  msgs::Quantiles message;
  message.median = q.median;
  message.p95 = q.p95;
  message.max = q.max;
  return message;
}

void set(Quantiles& q, const msgs::Quantiles& message) {
  q.median = message.median;
  q.p95 = message.p95;
  q.max = message.max;
}

msgs::ScenePart part_message(const ScenePart& part, const std::vector<Sensor>& sensors, const Frames& frames) {
  msgs::ScenePart message;
  message.id = part.id;
  message.frame_id = part_frame(part.id, frames.prefix);
  message.line = static_cast<std::uint32_t>(part.line);
  message.model = part.model;
  message.pose = pose_message(part.pose);
  message.velocity.linear = vector_message(part.velocity.linear);
  message.velocity.angular = vector_message(part.velocity.angular);
  message.state = static_cast<std::uint8_t>(part.state);
  for (const Sensor& sensor : sensors) {
    const auto seen = part.visible_fraction.find(sensor.name);
    message.visible_fraction.push_back(seen == part.visible_fraction.end() ? std::numeric_limits<double>::quiet_NaN()
                                                                           : seen->second);
  }
  return message;
}

ScenePart part_from(const msgs::ScenePart& message, const std::vector<msgs::Sensor>& sensors) {
  ScenePart part;
  part.id = message.id;
  part.line = message.line;
  part.model = message.model;
  part.pose = pose_from(message.pose);
  part.velocity.linear = vector_from(message.velocity.linear);
  part.velocity.angular = vector_from(message.velocity.angular);
  part.state = static_cast<PartState>(message.state);
  for (std::size_t s = 0; s < sensors.size() && s < message.visible_fraction.size(); ++s) {
    const double fraction = message.visible_fraction[s];
    if (!std::isnan(fraction)) part.visible_fraction[sensors[s].name] = fraction;
  }
  return part;
}

msgs::Worst worst_message(const WorstReport& worst) {
  msgs::Worst message;
  message.penetration_known = worst.penetration.known;
  message.penetration = worst.penetration.value;
  message.penetration_relative = worst.penetration.relative;
  message.pair = {worst.penetration.pair[0], worst.penetration.pair[1]};
  message.penetration_time = worst.penetration.time;
  message.energy_gain = worst.energy_gain.relative;
  message.energy_gain_time = worst.energy_gain.time;
  message.unresolved_impacts = worst.unresolved_impacts;
  return message;
}

WorstReport worst_from(const msgs::Worst& message) {
  WorstReport worst;
  worst.penetration.known = message.penetration_known;
  worst.penetration.value = message.penetration;
  worst.penetration.relative = message.penetration_relative;
  worst.penetration.pair = {message.pair[0], message.pair[1]};
  worst.penetration.time = message.penetration_time;
  worst.energy_gain = {message.energy_gain, message.energy_gain_time};
  worst.unresolved_impacts = message.unresolved_impacts;
  return worst;
}

}  // namespace

const char* name_of(Bin::Kind kind) {
  switch (kind) {
    case Bin::Kind::box:
      return "box";
    case Bin::Kind::mesh:
      return "mesh";
    case Bin::Kind::floor:
      return "floor";
    case Bin::Kind::none:
      return "none";
  }
  return "?";
}

bin_scenes_msgs::Bin bin_message(const Bin& bin) {
  msgs::Bin message;
  message.kind = name_of(bin.kind);
  message.inner_size = vector_message(bin.inner_size);
  message.wall_thickness = {bin.wall_thickness};
  message.mesh = bin.mesh;
  if (bin.unit) message.unit = name_of(*bin.unit);
  message.pose = pose_message(bin.pose);
  message.friction = {bin.friction};
  message.restitution = {bin.restitution};
  return message;
}

bin_scenes_msgs::Sensor sensor_message(const Sensor& sensor) {
  msgs::Sensor message;
  message.name = sensor.name;
  message.model = sensor.model;
  message.preset = sensor.preset;
  message.D.assign(sensor.distortion.begin(), sensor.distortion.end());
  message.width = static_cast<std::uint32_t>(sensor.width);
  message.height = static_cast<std::uint32_t>(sensor.height);
  message.fov = sensor.fov;
  message.K = sensor.k;
  if (sensor.pose) message.pose = pose_message(*sensor.pose);
  message.near = sensor.near;
  message.far = sensor.far;
  return message;
}

Sensor sensor_from(const bin_scenes_msgs::Sensor& message) {
  Sensor sensor;
  sensor.name = message.name;
  sensor.model = sensor_model(message.model).name;
  sensor.preset = message.preset;
  if (message.D.size() == 5) std::copy(message.D.begin(), message.D.end(), sensor.distortion.begin());
  sensor.width = static_cast<int>(message.width);
  sensor.height = static_cast<int>(message.height);
  sensor.fov = message.fov;
  sensor.k = message.K;
  sensor.pose = pose_from(message.pose);
  sensor.near = message.near;
  sensor.far = message.far;
  return sensor;
}

bin_scenes_msgs::SceneReport report_message(const Report& report) {
  msgs::SceneReport message;
  message.at_rest = report.at_rest;
  message.accepted = report.accepted;
  message.reasons = report.reasons;
  message.solver = report.solver;
  message.solver_reason = report.solver_reason;
  message.device = report.device;
  message.simulated_s = report.simulated_s;
  message.wall_s = report.wall_s;
  message.finish = report.finish;
  message.steps = report.steps;
  for (const auto& [name, ms] : report.profile.stages_ms) {
    msgs::StageTime stage;
    stage.stage = name;
    stage.ms = ms;
    message.stages.push_back(stage);
  }
  for (const auto& [name, value] : report.profile.counters) {
    msgs::Counter counter;
    counter.name = name;
    counter.value = value;
    message.counters.push_back(counter);
  }
  message.penetration.depth = quantiles_message(report.penetration);
  message.penetration.pair = {report.penetration.pair[0], report.penetration.pair[1]};
  message.penetration.p95_relative = report.penetration.p95_relative;
  message.penetration.max_relative = report.penetration.max_relative;
  message.penetration.bin_median = report.penetration.bin_median;
  message.penetration.bin_p95 = report.penetration.bin_p95;
  message.penetration.bin_max = report.penetration.bin_max;
  message.penetration.bin_part = report.penetration.bin_part;
  message.penetration.pairs = report.penetration.pairs;
  message.gap = quantiles_message(report.gap);
  message.drift.measured = report.drift.measured;
  message.drift.distance = quantiles_message(report.drift);
  message.drift.turn_p95 = report.drift.turn_p95;
  message.energy.gain = report.energy.gain;
  message.energy.time = report.energy.time;
  message.energy.part = report.energy.part;
  message.energy.thrown_ratio = report.energy.thrown.ratio;
  message.energy.thrown_time = report.energy.thrown.time;
  message.energy.thrown_part = report.energy.thrown.part;
  message.energy.thrown_beside = report.energy.thrown.beside;
  message.worst = worst_message(report.worst);
  message.jam_ratio = report.jam.ratio;
  message.jam_part = report.jam.part;
  message.escaped.assign(report.escaped.begin(), report.escaped.end());
  message.unstable.assign(report.unstable.begin(), report.unstable.end());
  message.not_poured.assign(report.not_poured.begin(), report.not_poured.end());
  message.state_hash = report.state_hash;
  for (const Flag& flag : report.flags) {
    msgs::Flag out;
    out.code = flag.code;
    out.text = flag.text;
    out.remedy = flag.remedy;
    message.flags.push_back(out);
  }
  return message;
}

Report report_from(const bin_scenes_msgs::SceneReport& message) {
  Report report;
  report.at_rest = message.at_rest;
  report.accepted = message.accepted;
  report.reasons = message.reasons;
  report.solver = message.solver;
  report.solver_reason = message.solver_reason;
  report.device = message.device;
  report.simulated_s = message.simulated_s;
  report.wall_s = message.wall_s;
  report.finish = message.finish;
  report.steps = message.steps;
  for (const auto& stage : message.stages) report.profile.stages_ms[stage.stage] = stage.ms;
  for (const auto& counter : message.counters) report.profile.counters[counter.name] = counter.value;
  set(report.penetration, message.penetration.depth);
  report.penetration.pair = {message.penetration.pair[0], message.penetration.pair[1]};
  report.penetration.p95_relative = message.penetration.p95_relative;
  report.penetration.max_relative = message.penetration.max_relative;
  report.penetration.bin_median = message.penetration.bin_median;
  report.penetration.bin_p95 = message.penetration.bin_p95;
  report.penetration.bin_max = message.penetration.bin_max;
  report.penetration.bin_part = message.penetration.bin_part;
  report.penetration.pairs = message.penetration.pairs;
  set(report.gap, message.gap);
  report.drift.measured = message.drift.measured;
  set(report.drift, message.drift.distance);
  report.drift.turn_p95 = message.drift.turn_p95;
  report.energy.gain = message.energy.gain;
  report.energy.time = message.energy.time;
  report.energy.part = message.energy.part;
  report.energy.thrown = {message.energy.thrown_ratio, message.energy.thrown_time, message.energy.thrown_part,
                          message.energy.thrown_beside};
  report.worst = worst_from(message.worst);
  report.jam = {message.jam_ratio, message.jam_part};
  report.escaped.assign(message.escaped.begin(), message.escaped.end());
  report.unstable.assign(message.unstable.begin(), message.unstable.end());
  report.not_poured.assign(message.not_poured.begin(), message.not_poured.end());
  report.state_hash = message.state_hash;
  for (const auto& flag : message.flags) report.flags.push_back({flag.code, flag.text, flag.remedy});
  return report;
}

bin_scenes_msgs::Scene scene_message(const Scene& scene, const Request& request, const Frames& frames,
                                     const ros::Time& stamp) {
  msgs::Scene message;
  message.header.stamp = stamp;
  message.header.frame_id = frames.bin;
  message.seed = scene.seed;
  message.index = scene.index;
  message.request_sha256 = request.text_sha256;
  message.bin = bin_message(request.bin);
  for (const Sensor& sensor : scene.sensors) message.sensors.push_back(sensor_message(sensor));
  for (const ScenePart& part : scene.parts) message.parts.push_back(part_message(part, scene.sensors, frames));
  message.report = report_message(scene.report);
  return message;
}

Scene scene_from(const bin_scenes_msgs::Scene& message) {
  Scene scene;
  scene.seed = message.seed;
  scene.index = message.index;
  for (const auto& sensor : message.sensors) scene.sensors.push_back(sensor_from(sensor));
  for (const auto& part : message.parts) scene.parts.push_back(part_from(part, message.sensors));
  scene.report = report_from(message.report);
  return scene;
}

}  // namespace bin_scenes
