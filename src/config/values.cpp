/// Readers and writers of single values: numbers, vectors, poses, units, lists. Each pair gives back the same bits.
#include "config/values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <type_traits>

namespace bin_scenes::config {

namespace {

std::string scalar(const YAML::Node& node, const std::string& expected) {
  if (!node.IsScalar()) throw Mismatch{expected};
  return node.Scalar();
}

/// The whole text as one number in the C locale; no "inf", "nan" or hexadecimal.
template <class Number>
bool parse(const std::string& text, Number& value) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  if (text.empty() || std::isspace(static_cast<unsigned char>(text[0]))) return false;
  if (std::is_unsigned_v<Number> && text[0] == '-') return false;  // streams wrap negative numbers around
  return static_cast<bool>(in >> value) && in.peek() == std::istringstream::traits_type::eof();
}

std::vector<double> numbers(const YAML::Node& node, const std::string& expected) {
  if (!node.IsSequence()) throw Mismatch{expected};
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    double value;
    if (!item.IsScalar() || !parse(item.Scalar(), value)) throw Mismatch{expected};
    values.push_back(value);
  }
  return values;
}

std::vector<double> numbers(const YAML::Node& node, std::size_t count, const std::string& expected) {
  std::vector<double> values = numbers(node, expected);
  if (values.size() != count) throw Mismatch{expected};
  return values;
}

Quat orientation_of(const double* xyzw) {
  Quat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  const double length = q.squaredNorm();
  if (!(std::abs(length - 1.0) < 2e-2)) throw Mismatch{"a quaternion x, y, z, w of length 1"};
  // A quaternion that is of unit length up to rounding keeps its bits, so that written poses read back unchanged.
  return std::abs(length - 1.0) < 1e-14 ? q : q.normalized();
}

template <class Item>
std::string list_of(const std::vector<Item>& items) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i ? ", " : "") + text_of(items[i]);
  return text + "]";
}

template <class Item>
void read_items(const YAML::Node& node, std::vector<Item>& items) {
  if (!node.IsSequence()) throw Mismatch{kind_of(items)};
  items.clear();
  for (const YAML::Node& item : node) {
    items.emplace_back();
    try {
      read_value(item, items.back());
    } catch (Mismatch& mismatch) {
      mismatch.item = items.size() - 1;
      throw;
    }
  }
}

}  // namespace

void read_value(const YAML::Node& node, bool& value) {
  const std::string text = scalar(node, kind_of(value));
  if (text != "true" && text != "false") throw Mismatch{kind_of(value)};
  value = text == "true";
}

void read_value(const YAML::Node& node, int& value) {
  if (!parse(scalar(node, kind_of(value)), value)) throw Mismatch{kind_of(value)};
}

void read_value(const YAML::Node& node, std::uint64_t& value) {
  if (!parse(scalar(node, kind_of(value)), value)) throw Mismatch{kind_of(value)};
}

void read_value(const YAML::Node& node, double& value) {
  if (!parse(scalar(node, kind_of(value)), value)) throw Mismatch{kind_of(value)};
}

void read_value(const YAML::Node& node, std::string& value) {
  value = scalar(node, kind_of(value));
}

void read_value(const YAML::Node& node, Word& value) {
  std::string text;
  read_value(node, text);
  if (std::find(value.known.begin(), value.known.end(), text) == value.known.end())
    throw Mismatch{kind_of(value), Mismatch::whole, nearest(text, value.known)};
  value.value = text;
}
void read_value(const YAML::Node& node, Vec3& value) {
  const std::vector<double> v = numbers(node, 3, kind_of(value));
  value = {v[0], v[1], v[2]};
}

void read_value(const YAML::Node& node, Pose& value) {
  const char* expected = "[x, y, z, qx, qy, qz, qw], [x, y, z] or {position: [...], orientation_xyzw: [...]}";
  value = {};
  std::vector<double> v;
  if (node.IsMap()) {
    std::size_t known = 0;
    if (const YAML::Node position = node["position"]) {
      v = numbers(position, 3, expected);
      value.position = {v[0], v[1], v[2]};
      ++known;
    }
    if (const YAML::Node orientation = node["orientation_xyzw"]) {
      v = numbers(orientation, 4, expected);
      value.orientation = orientation_of(v.data());
      ++known;
    }
    if (known != node.size()) throw Mismatch{expected};
    return;
  }
  v = numbers(node, expected);
  if (v.size() != 3 && v.size() != 7) throw Mismatch{expected};
  value.position = {v[0], v[1], v[2]};
  if (v.size() == 7) value.orientation = orientation_of(&v[3]);
}

void read_value(const YAML::Node& node, Twist& value) {
  const std::vector<double> v = numbers(node, 6, "[vx, vy, vz, wx, wy, wz]");
  value.linear = {v[0], v[1], v[2]};
  value.angular = {v[3], v[4], v[5]};
}

void read_value(const YAML::Node& node, std::array<double, 5>& value) {
  const std::vector<double> v = numbers(node, 5, kind_of(value));
  std::copy(v.begin(), v.end(), value.begin());
}

void read_value(const YAML::Node& node, std::vector<double>& value) {
  value = numbers(node, kind_of(value));
}
void read_value(const YAML::Node& node, std::vector<Pose>& value) {
  read_items(node, value);
}
void read_value(const YAML::Node& node, std::vector<Twist>& value) {
  read_items(node, value);
}

std::string text_of(double value) {
  char text[32];
  for (int digits = 15;; ++digits) {
    char* const end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr;
    double back = 0;
    std::from_chars(text, end, back);
    if (digits == std::numeric_limits<double>::max_digits10 || back == value) return {text, end};
  }
}

std::string text_of(bool value) {
  return value ? "true" : "false";
}
std::string text_of(int value) {
  return std::to_string(value);
}
std::string text_of(std::uint64_t value) {
  return std::to_string(value);
}

std::string text_of(const std::string& value) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << value;
  return out.c_str();
}

std::string text_of(const Vec3& v) {
  return list_of<double>({v.x(), v.y(), v.z()});
}

std::string text_of(const Pose& pose) {
  const Vec3& p = pose.position;
  const Quat& q = pose.orientation;
  return list_of<double>({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
}

std::string text_of(const Twist& t) {
  return list_of<double>({t.linear.x(), t.linear.y(), t.linear.z(), t.angular.x(), t.angular.y(), t.angular.z()});
}

std::string text_of(const std::array<double, 5>& value) {
  return list_of<double>({value.begin(), value.end()});
}
std::string text_of(const std::vector<double>& value) {
  return list_of(value);
}
std::string text_of(const std::vector<Pose>& value) {
  return list_of(value);
}
std::string text_of(const std::vector<Twist>& value) {
  return list_of(value);
}

}  // namespace bin_scenes::config
