#include "config/json_fields.hpp"

#include "core/formatted.hpp"

#include <cmath>
#include <limits>

namespace bin_scenes::config {

namespace {

[[noreturn]] void refuse(const Json& json, const std::string& path, const std::string& wanted) {
  const std::string held = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  throw JsonFault{path, "is " + held.substr(0, 40) + ", but must be " + wanted};
}

/// A whole number that its type can hold; the cast of another one may be anything.
template <class Whole>
Whole whole_of(const Json& json, const std::string& path) {
  const bool fits = json.is_number_unsigned()
                        ? json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<Whole>::max())
                        : json.is_number_integer() && std::is_signed_v<Whole> &&
                              json.get<std::int64_t>() >= static_cast<std::int64_t>(std::numeric_limits<Whole>::min());
  if (!fits) refuse(json, path, "a whole number");
  return json.get<Whole>();
}

const Json& member_of(const Json& json, const std::string& path, const char* key) {
  expect_map(json, path);
  if (!json.contains(key)) throw JsonFault{path + "." + key, "is missing"};
  return json.at(key);
}

}  // namespace

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json json_of(const Pose& pose) {
  if (!pose.finite()) return {};
  const Quat& q = pose.orientation;
  return {{"position", json_of(pose.position)}, {"orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

Json json_of(const Twist& twist) {
  return {{"linear", json_of(twist.linear)}, {"angular", json_of(twist.angular)}};
}

Json json_of(const Hexadecimal& number) {
  return formatted("%016llx", static_cast<unsigned long long>(number.value));
}

void expect_list(const Json& json, const std::string& path, std::optional<std::size_t> size) {
  if (!json.is_array()) refuse(json, path, "a list");
  if (size && json.size() != *size) refuse(json, path, "a list of " + std::to_string(*size));
}

void expect_map(const Json& json, const std::string& path) {
  if (!json.is_object()) refuse(json, path, "a map");
}

void read_json(const Json& json, const std::string& path, bool& value) {
  if (!json.is_boolean()) refuse(json, path, "true or false");
  value = json.get<bool>();
}

void read_json(const Json& json, const std::string& path, int& value) {
  value = whole_of<int>(json, path);
}

void read_json(const Json& json, const std::string& path, std::uint64_t& value) {
  value = whole_of<std::uint64_t>(json, path);
}

void read_json(const Json& json, const std::string& path, double& value) {
  if (!json.is_number() && !json.is_null()) refuse(json, path, "a number");
  value = json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

void read_json(const Json& json, const std::string& path, std::string& value) {
  if (!json.is_string()) refuse(json, path, "a text");
  value = json.get<std::string>();
}

void read_json(const Json& json, const std::string& path, Word& value) {
  read_json(json, path, value.value);
}

void read_json(const Json& json, const std::string& path, Hexadecimal& value) {
  std::string text;
  read_json(json, path, text);
  const bool digits = text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  if (text.empty() || text.size() > 16 || !digits) refuse(json, path, "a text of hexadecimal digits");
  value.value = std::stoull(text, nullptr, 16);
}

void read_json(const Json& json, const std::string& path, Vec3& value) {
  std::array<double, 3> v;
  read_json(json, path, v);
  value = {v[0], v[1], v[2]};
}

void read_json(const Json& json, const std::string& path, Pose& value) {
  value = Pose::none();
  if (json.is_null()) return;
  std::array<double, 4> q;
  read_json(member_of(json, path, "position"), path + ".position", value.position);
  read_json(member_of(json, path, "orientation_xyzw"), path + ".orientation_xyzw", q);
  value.orientation = Quat(q[3], q[0], q[1], q[2]);
}

void read_json(const Json& json, const std::string& path, Twist& value) {
  read_json(member_of(json, path, "linear"), path + ".linear", value.linear);
  read_json(member_of(json, path, "angular"), path + ".angular", value.angular);
}

void JsonReader::bin_kind(Bin& bin, const BinKeys&) {
  using Kind = Bin::Kind;
  for (const auto& [key, kind] :
       {std::pair("inner_size", Kind::box), {"mesh", Kind::mesh}, {"floor", Kind::floor}, {"none", Kind::none}})
    if (json_.contains(key)) bin.kind = kind;
}

const Json* JsonReader::find(const Key& key, bool needed) const {
  const auto item = json_.find(key.name);
  if (item != json_.end()) return &*item;
  if (needed || key.needed) throw JsonFault{path_of(key), "is missing"};
  return nullptr;
}

}  // namespace bin_scenes::config
