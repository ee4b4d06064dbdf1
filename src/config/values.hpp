/// Single values of a request in YAML: reading them with clear error messages, and writing them so that reading
/// restores the same bits. Maps and lists of keys are handled by key_reader.hpp.
#pragma once

#include "config/suggest.hpp"
#include "scene/keys.hpp"
#include "sensor/sensor_keys.hpp"

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes::config {

/// Thrown if a value has the wrong type; states what was expected. The caller adds file, line and key.
struct Mismatch {
  static constexpr std::size_t whole = static_cast<std::size_t>(-1);

  std::string expected;      ///< description of the expected value
  std::size_t item = whole;  ///< index of the wrong item of a list; `whole` if the value itself is wrong
  std::string meant = "";    ///< the known word that the user may have meant

  std::string index() const { return item == whole ? "" : "[" + std::to_string(item) + "]"; }
};

void read_value(const YAML::Node& node, bool& value);
void read_value(const YAML::Node& node, int& value);
void read_value(const YAML::Node& node, std::uint64_t& value);
void read_value(const YAML::Node& node, double& value);
void read_value(const YAML::Node& node, std::string& value);
void read_value(const YAML::Node& node, Vec3& value);
void read_value(const YAML::Node& node, Pose& value);  ///< [x,y,z,qx,qy,qz,qw], [x,y,z] or {position, orientation_xyzw}
void read_value(const YAML::Node& node, Twist& value);  ///< [vx,vy,vz,wx,wy,wz]
void read_value(const YAML::Node& node, std::array<double, 5>& value);
void read_value(const YAML::Node& node, std::vector<double>& value);
void read_value(const YAML::Node& node, std::vector<Pose>& value);
void read_value(const YAML::Node& node, std::vector<Twist>& value);

/// Returns the shortest decimal that reads back as the same number; the decimal point is '.' in every locale.
std::string text_of(double value);
std::string text_of(bool value);
std::string text_of(int value);
std::string text_of(std::uint64_t value);
std::string text_of(const std::string& value);
std::string text_of(const Vec3& value);
std::string text_of(const Pose& value);
std::string text_of(const Twist& value);
std::string text_of(const std::array<double, 5>& value);
std::string text_of(const std::vector<double>& value);
std::string text_of(const std::vector<Pose>& value);
std::string text_of(const std::vector<Twist>& value);

// The words that describe a type of value in error messages and in docs/use/request.md.
inline std::string kind_of(bool) {
  return "true or false";
}
inline std::string kind_of(int) {
  return "whole number";
}
inline std::string kind_of(std::uint64_t) {
  return "whole number, 0 or more";
}
inline std::string kind_of(double) {
  return "number";
}
inline std::string kind_of(const std::string&) {
  return "text";
}
inline std::string kind_of(const Vec3&) {
  return "[x, y, z]";
}
inline std::string kind_of(const Pose&) {
  return "[x, y, z, qx, qy, qz, qw]";
}
inline std::string kind_of(const std::array<double, 5>&) {
  return "[k1, k2, p1, p2, k3]";
}
inline std::string kind_of(const std::vector<double>&) {
  return "list of numbers";
}
inline std::string kind_of(const std::vector<Pose>&) {
  return "list of [x, y, z, qx, qy, qz, qw]";
}
inline std::string kind_of(const std::vector<Twist>&) {
  return "list of [vx, vy, vz, wx, wy, wz]";
}
void read_value(const YAML::Node& node, Word& value);
inline std::string text_of(const Word& value) {
  return value.value;
}
inline std::string kind_of(const Word& value) {
  std::string text;
  for (const std::string& word : value.known) text += (text.empty() ? "" : " | ") + word;
  return text;
}

template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
Word word_of(Enum) {
  Word word;
  for (const auto& [name, value] : names(Enum{})) word.known.emplace_back(name);
  return word;
}
template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
std::string kind_of(Enum value) {
  return kind_of(word_of(value));
}
template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
void read_value(const YAML::Node& node, Enum& value) {
  Word word = word_of(value);
  read_value(node, word);
  for (const auto& [name, meaning] : names(Enum{}))
    if (word.value == name) value = meaning;
}

template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
std::string text_of(Enum value) {
  return name_in_table(value);
}

}  // namespace bin_scenes::config
