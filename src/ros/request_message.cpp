/// Writes the fields of a message as overrides of keys, for the reader of requests. A field that is left at its default
/// writes nothing.
#include "request_message.hpp"

#include "bin_scenes/core/error.hpp"
#include "config/paths.hpp"
#include "frames.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace bin_scenes {

namespace {

namespace msgs = bin_scenes_msgs;

std::vector<double> values(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

std::vector<double> values(const geometry_msgs::Twist& t) {
  return {t.linear.x, t.linear.y, t.linear.z, t.angular.x, t.angular.y, t.angular.z};
}

/// An orientation of four zeros is what a message holds when nobody set it: the identity.
std::vector<double> values(const geometry_msgs::Pose& message) {
  const Pose pose = pose_from(message);
  const Vec3& p = pose.position;
  const Quat& q = pose.orientation;
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

bool is_set(const geometry_msgs::Vector3& v) {
  return v.x != 0.0 || v.y != 0.0 || v.z != 0.0;
}

bool is_set(const geometry_msgs::Quaternion& q) {
  return q.x != 0.0 || q.y != 0.0 || q.z != 0.0 || q.w != 0.0;
}

bool is_set(const geometry_msgs::Pose& p) {
  return p.position.x != 0.0 || p.position.y != 0.0 || p.position.z != 0.0 || is_set(p.orientation);
}

template <class Message>
std::vector<std::vector<double>> values(const std::vector<Message>& list) {
  std::vector<std::vector<double>> rows;
  for (const Message& item : list) rows.push_back(values(item));
  return rows;
}

template <class Value>
bool is_set(const std::vector<Value>& optional, const std::string& key) {
  if (optional.size() > 1) {
    throw input_error("an optional value is given " + std::to_string(optional.size()) + " times", key,
                      "give it once, or leave the array empty");
  }
  return optional.size() == 1;
}

/// The set fields of one message as keys of a request. Only what differs from "not set" is written.
class Keys {
 public:
  explicit Keys(std::string path) : path_(std::move(path)) { map_ = YAML::Node(YAML::NodeType::Map); }

  void text(const char* key, const std::string& value) {
    if (!value.empty()) map_[key] = value;
  }
  template <class Number>
  void number(const char* key, Number value) {
    if (value != 0) map_[key] = value;
  }
  template <class Number>
  void optional(const char* key, const std::vector<Number>& value) {
    if (is_set(value, path_ + "." + key)) map_[key] = value[0];
  }
  template <class Value>
  void value(const char* key, const Value& value) {
    map_[key] = value;
  }
  void section(const char* key, const Keys& section) {
    if (section.map().size() > 0) map_[key] = section.map();
  }
  const YAML::Node& map() const { return map_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  YAML::Node map_;
};

/// YAML on one line, numbers with all their digits.
std::string flow(const YAML::Node& node) {
  YAML::Emitter out;
  out.SetSeqFormat(YAML::Flow);
  out.SetMapFormat(YAML::Flow);
  out << node;
  std::string text = out.c_str();
  std::replace(text.begin(), text.end(), '\n', ' ');  // yaml-cpp breaks long flow sequences into lines
  return text;
}

Keys bin_keys(const msgs::Bin& bin) {
  Keys keys("bin");
  if (bin.kind == "floor" || bin.kind == "none") {
    keys.value(bin.kind.c_str(), true);
  } else if (bin.kind == "mesh") {
    if (bin.mesh.empty()) throw input_error("the bin is a mesh, but none is named", "bin.mesh", "name a model file");
  } else if (!bin.kind.empty() && bin.kind != "box") {
    throw input_error("unknown kind '" + bin.kind + "'", "bin.kind", "box, mesh, floor or none");
  }
  if (is_set(bin.inner_size)) keys.value("inner_size", values(bin.inner_size));
  keys.optional("wall_thickness", bin.wall_thickness);
  keys.text("mesh", bin.mesh);
  keys.text("unit", bin.unit);
  if (is_set(bin.pose)) keys.value("pose", values(bin.pose));
  keys.optional("friction", bin.friction);
  keys.optional("restitution", bin.restitution);
  return keys;
}

Keys surface_keys(const msgs::Surface& surface, const std::string& path) {
  Keys keys(path);
  keys.text("material", surface.material);
  keys.optional("albedo", surface.albedo);
  keys.optional("gloss", surface.gloss);
  keys.optional("roughness", surface.roughness);
  keys.optional("anisotropy", surface.anisotropy);
  if (is_set(surface.along)) keys.value("along", values(surface.along));
  Keys texture(path + ".texture");
  texture.optional("scratches", surface.texture_scratches);
  texture.optional("oil", surface.texture_oil);
  texture.optional("rust", surface.texture_rust);
  keys.section("texture", texture);
  return keys;
}

Keys motion_keys(const msgs::Motion& motion, const std::string& path) {
  Keys keys(path);
  if (!motion.times.empty()) keys.value("times", motion.times);
  if (!motion.poses.empty()) keys.value("poses", values(motion.poses));
  if (is_set(motion.shake)) keys.value("shake", values(motion.shake));
  if (is_set(motion.tilt)) keys.value("tilt", values(motion.tilt));
  if (is_set(motion.belt)) keys.value("belt", values(motion.belt));
  keys.optional("frequency", motion.frequency);
  keys.optional("seconds", motion.seconds);
  return keys;
}

Keys part_keys(const msgs::PartLine& part, const std::string& path) {
  Keys keys(path);
  keys.text("model", part.model);
  keys.text("unit", part.unit);
  keys.number("scale", part.scale);
  keys.number("count", part.count != 0 ? part.count : static_cast<int>(part.poses.size()));
  keys.number("density", part.density);
  keys.number("mass", part.mass);
  keys.optional("friction", part.friction);
  keys.optional("restitution", part.restitution);
  keys.number("thickness", part.thickness);
  keys.text("solid", part.solid);
  Keys tessellation(path + ".tessellation");
  tessellation.number("chord", part.tessellation_chord);
  tessellation.number("angle", part.tessellation_angle);
  keys.section("tessellation", tessellation);
  if (!part.poses.empty()) keys.value("poses", values(part.poses));
  if (!part.velocities.empty()) keys.value("velocities", values(part.velocities));
  if (part.fixed) keys.value("fixed", true);
  keys.section("surface", surface_keys(part.surface, path + ".surface"));
  keys.section("motion", motion_keys(part.motion, path + ".motion"));
  return keys;
}

Keys sensor_keys(const msgs::Sensor& sensor, const std::string& path) {
  Keys keys(path);
  keys.text("name", sensor.name);
  keys.text("model", sensor.model);
  keys.text("preset", sensor.preset);
  keys.number("width", sensor.width);
  keys.number("height", sensor.height);
  keys.number("fov", sensor.fov);
  if (!sensor.K.empty()) keys.value("k", sensor.K);
  if (!sensor.D.empty()) keys.value("distortion", sensor.D);
  if (is_set(sensor.pose)) keys.value("pose", values(sensor.pose));
  keys.number("near", sensor.near);
  keys.number("far", sensor.far);
  return keys;
}

}  // namespace

std::vector<Override> overrides_from(const bin_scenes_msgs::SceneRequest& message) {
  std::vector<Override> overrides;
  const auto add = [&](const std::string& key, const YAML::Node& value) {
    overrides.emplace_back(key + "=" + flow(value), "the request message");
  };
  if (is_set(message.seed, "seed")) add("seed", YAML::Node(message.seed[0]));
  if (is_set(message.index, "index")) add("first", YAML::Node(message.index[0]));
  const Keys bin = bin_keys(message.bin);
  for (const auto& key : bin.map()) add("bin." + key.first.Scalar(), key.second);
  if (is_set(message.gravity, "gravity")) add("gravity", YAML::Node(values(message.gravity[0])));
  if (!message.parts.empty()) {
    YAML::Node list;
    for (std::size_t i = 0; i < message.parts.size(); ++i) {
      list.push_back(part_keys(message.parts[i], "parts[" + std::to_string(i) + "]").map());
    }
    add("parts", list);
  }
  if (!message.pour_pattern.empty()) add("pour.pattern", YAML::Node(message.pour_pattern));
  if (!message.pour_scene.empty()) add("pour.scene", YAML::Node(message.pour_scene));
  if (!message.solver.empty()) add("solver.type", YAML::Node(message.solver));
  if (!message.sensors.empty()) {
    YAML::Node list;
    for (std::size_t i = 0; i < message.sensors.size(); ++i) {
      list.push_back(sensor_keys(message.sensors[i], "sensors[" + std::to_string(i) + "]").map());
    }
    add("sensors", list);
  }
  if (message.seconds != 0.0) add("seconds", YAML::Node(message.seconds));
  overrides.insert(overrides.end(), message.set.begin(), message.set.end());
  return overrides;
}

Request request_from(const bin_scenes_msgs::SceneRequest& message, const PathRules& rules) {
  const std::vector<Override> overrides = overrides_from(message);
  if (!message.file.empty() && !message.yaml.empty()) {
    throw input_error("a request file and a request text are both given", "file, yaml", "give one of them");
  }
  if (!message.file.empty()) {
    // A file is read before anything in it can be judged, so its own place is checked first.
    const std::string base = rules.roots.empty() ? std::string(".") : rules.roots[0];
    return read_request(config::resolve_file(message.file, base, rules, "file"), overrides, rules);
  }
  const std::string base = rules.roots.empty() ? std::string(".") : rules.roots[0];
  return read_request_text(message.yaml.empty() ? "{}" : message.yaml, base, overrides, rules);
}

std::vector<PartLine> part_lines_from(const std::vector<bin_scenes_msgs::PartLine>& messages, const PathRules& rules) {
  if (messages.empty()) throw input_error("no part line is given", "parts", "name at least one model");
  std::vector<PartLine> lines;
  for (const bin_scenes_msgs::PartLine& message : messages) {
    bin_scenes_msgs::SceneRequest alone;
    alone.parts = {message};
    if (!message.poses.empty() && !message.fixed) alone.pour_pattern = "given";
    lines.push_back(request_from(alone, rules).parts.at(0));
  }
  return lines;
}

}  // namespace bin_scenes
