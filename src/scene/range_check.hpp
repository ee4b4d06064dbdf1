/// A visitor of tables of keys that refuses numbers outside their range. The error names the path of the key.
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/types.hpp"
#include "bin_scenes/scene/key.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace bin_scenes {

struct Bin;
struct BinKeys;
struct Sensor;

/// Returns the text of a range for messages, such as "at least 0 and at most 10"; "" for `anything`.
std::string text_of(const Range& range);

/// Throws an input Error at `path` unless `value` is finite and within the key's range.
void check_number(const std::string& path, const Key& key, double value);
void check_pose(const std::string& path, const Pose& pose);

class RangeCheck {
 public:
  /// @param prefix  path of the struct, which begins all paths in messages, such as "" or "parts[3]."
  explicit RangeCheck(std::string prefix = "") : prefix_(std::move(prefix)) {}

  template <class Value>
  void field(const Key& key, const Value& value) {
    if (key.written) check_value(prefix_ + key.name, key, value);
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    nested(key.name + std::string("."), value);
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) nested(key.name + ("[" + std::to_string(i) + "]."), values[i]);
  }
  void list(const Key&, std::vector<Sensor>&) {}  ///< the sensor models check their keys: check_sensors()
  void bin_kind(Bin&, const BinKeys&) {}

 private:
  template <class Struct>
  void nested(const std::string& inner, Struct& value) {
    const std::string outer = prefix_;
    prefix_ += inner;
    visit(*this, value);
    prefix_ = outer;
  }

  static void check_value(const std::string& path, const Key& key, double value) { check_number(path, key, value); }
  static void check_value(const std::string& path, const Key& key, int value) { check_number(path, key, value); }
  static void check_value(const std::string& path, const Key& key, std::uint64_t value) {
    check_number(path, key, static_cast<double>(value));
  }
  static void check_value(const std::string& path, const Key& key, const Vec3& value) {
    for (int i = 0; i < 3; ++i) check_number(path, key, value[i]);
  }
  static void check_value(const std::string& path, const Key&, const Pose& value) { check_pose(path, value); }
  static void check_value(const std::string& path, const Key& key, const Twist& value) {
    check_value(path, key, value.linear);
    check_value(path, key, value.angular);
  }
  static void check_value(const std::string& path, const Key& key, const std::array<double, 5>& value) {
    for (const double item : value) check_number(path, key, item);
  }
  static void check_value(const std::string& path, const Key&, const Word& value) {
    if (std::find(value.known.begin(), value.known.end(), value.value) != value.known.end()) return;
    std::string known;
    for (const std::string& word : value.known) known += (known.empty() ? "" : ", ") + word;
    throw input_error("'" + value.value + "' is unknown", path, "one of " + known);
  }
  template <class Item>
  static void check_value(const std::string& path, const Key& key, const std::vector<Item>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) check_value(path + "[" + std::to_string(i) + "]", key, values[i]);
  }
  template <class Value>
  static void check_value(const std::string& path, const Key& key, const std::optional<Value>& value) {
    if (value) check_value(path, key, *value);
  }
  static void check_value(const std::string&, const Key&, bool) {}
  static void check_value(const std::string&, const Key&, const std::string&) {}
  template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
  static void check_value(const std::string&, const Key&, Enum) {}

  std::string prefix_;
};

}  // namespace bin_scenes
