/// Writes the fields of a message as overrides of the keys with their names, for the reader of requests. A field that
/// is left at its default writes nothing.
#include "request_message.hpp"

#include "bin_scenes/core/error.hpp"
#include "config/paths.hpp"
#include "config/reference.hpp"
#include "frames.hpp"
#include "message_fields.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <type_traits>

namespace bin_scenes {

namespace {

namespace msgs = bin_scenes_msgs;

template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
Number values(Number number) {
  return number;
}

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

template <class Item>
auto values(const std::vector<Item>& list) {
  std::vector<decltype(values(list[0]))> rows;
  for (const Item& item : list) rows.push_back(values(item));
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

/// What a value of the key looks like; none: there is no such key.
const std::string* kind_of(const std::string& key) {
  static const auto kinds = [] {
    std::map<std::string, std::string> all;
    for (const config::Entry& entry : config::reference()) all[entry.path] = entry.kind;
    return all;
  }();
  const auto found = kinds.find(key);
  return found == kinds.end() ? nullptr : &found->second;
}

/// The set fields of a message as keys of a request: what is called a_b there is a, or b of the section a.
class Keys {
 public:
  /// @param section  of the table: "", "bin." or "parts[]."
  /// @param path     of the message, for errors: "", "bin." or "parts[2]."
  Keys(std::string section, std::string path) : section_(std::move(section)), path_(std::move(path)) {}

  void operator()(const std::string& field, const std::string& value) {
    if (section_ == "bin." && field == "kind") return bin_kind(value);
    if (!value.empty()) set(field, YAML::Node(value));
  }
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  void operator()(const std::string& field, Number value) {
    if (value != 0) set(field, std::is_same_v<Number, std::uint8_t> ? YAML::Node(true) : YAML::Node(value));
  }
  void operator()(const std::string& field, const geometry_msgs::Vector3& value) { set_if(field, value); }
  void operator()(const std::string& field, const geometry_msgs::Pose& value) { set_if(field, value); }
  template <class Item>
  void operator()(const std::string& field, const std::vector<Item>& items) {
    if constexpr (std::is_same_v<Item, msgs::PartLine> || std::is_same_v<Item, msgs::Sensor>) {
      YAML::Node list;
      for (std::size_t i = 0; i < items.size(); ++i)
        list.push_back(keys_of(items[i], field + "[].", field + "[" + std::to_string(i) + "]."));
      if (!items.empty()) set(field, list);
    } else if constexpr (std::is_same_v<Item, geometry_msgs::Pose> || std::is_same_v<Item, geometry_msgs::Twist>) {
      if (!items.empty()) set(field, YAML::Node(values(items)));
    } else if (std::is_arithmetic_v<Item> && is_list(field)) {
      if (!items.empty()) set(field, YAML::Node(values(items)));
    } else if (is_set(items, path_ + field)) {
      set(field, YAML::Node(values(items[0])));
    }
  }
  void operator()(const std::string&, const std::vector<std::string>&) {}  // `set`, whose items are overrides
  void operator()(const std::string& field, const msgs::Bin& message) { section(field, message); }
  void operator()(const std::string& field, const msgs::Table& message) { section(field, message); }
  void operator()(const std::string& field, const msgs::Surface& message) { section(field, message); }
  void operator()(const std::string& field, const msgs::Motion& message) { section(field, message); }

  template <class Message>
  static YAML::Node keys_of(const Message& message, const std::string& section, const std::string& path) {
    Keys keys(section, path);
    for_each_field(message, keys);
    if constexpr (std::is_same_v<Message, msgs::PartLine>)
      if (message.count == 0 && !message.poses.empty()) keys.set("count", YAML::Node(message.poses.size()));
    return keys.map_;
  }

 private:
  /// "tessellation.chord" of the field tessellation_chord; empty: the field is no key.
  std::string key_of(const std::string& field) const {
    static const std::map<std::string, std::string> others = {
        {"K", "k"}, {"D", "distortion"}, {"index", "first"}, {"solver", "solver.type"}};
    const auto other = others.find(field);
    if (other != others.end()) return other->second;
    if (kind_of(section_ + field)) return field;
    for (std::size_t at = field.find('_'); at != std::string::npos; at = field.find('_', at + 1)) {
      const std::string key = field.substr(0, at) + "." + field.substr(at + 1);
      if (kind_of(section_ + key)) return key;
    }
    return "";
  }
  bool is_list(const std::string& field) const {
    const std::string* kind = kind_of(section_ + key_of(field));
    return kind && (kind->rfind("list", 0) == 0 || kind->rfind("[k1", 0) == 0);
  }
  void set(const std::string& field, const YAML::Node& value) {
    const std::string key = key_of(field);
    const std::size_t dot = key.find('.');
    if (dot != std::string::npos)
      map_[key.substr(0, dot)][key.substr(dot + 1)] = value;
    else if (!key.empty())
      map_[key] = value;
  }
  template <class Value>
  void set_if(const std::string& field, const Value& value) {
    if (is_set(value)) set(field, YAML::Node(values(value)));
  }
  template <class Message>
  void section(const std::string& field, const Message& message) {
    const YAML::Node keys = keys_of(message, section_ + field + ".", path_ + field + ".");
    if (keys.size() > 0) set(field, keys);
  }
  void bin_kind(const std::string& kind) {
    if (kind == "floor" || kind == "none")
      map_[kind] = true;
    else if (!kind.empty() && kind != "box" && kind != "mesh")
      throw input_error("unknown kind '" + kind + "'", "bin.kind", "box, mesh, floor or none");
  }

  std::string section_, path_;
  YAML::Node map_ = YAML::Node(YAML::NodeType::Map);
};

}  // namespace

std::vector<Override> overrides_from(const bin_scenes_msgs::SceneRequest& message) {
  if (message.bin.kind == "mesh" && message.bin.mesh.empty())
    throw input_error("the bin is a mesh, but none is named", "bin.mesh", "name a model file");
  std::vector<Override> overrides;
  const auto add = [&](const std::string& key, const YAML::Node& value) {
    overrides.emplace_back(key + "=" + flow(value), "the request message");
  };
  for (const auto& item : Keys::keys_of(message, "", "")) {
    const std::string key = item.first.Scalar();
    if (!item.second.IsMap()) {
      add(key, item.second);
      continue;
    }
    for (const auto& inner : item.second) add(key + "." + inner.first.Scalar(), inner.second);  // over those of a file
  }
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
