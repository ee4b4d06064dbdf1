#include "cdr.hpp"

#include <cctype>
#include <regex>
#include <sstream>

namespace bin_scenes {

void CdrStream::next(const ros::Time& time) {
  next(static_cast<std::int32_t>(time.sec));
  next(time.nsec);
}

void CdrStream::next(const ros::Duration& duration) {
  next(duration.sec);
  next(static_cast<std::uint32_t>(duration.nsec));  // never negative
}

void CdrStream::next(const std_msgs::Header& header) {
  next(header.stamp);
  next(header.frame_id);
}

void CdrStream::next(const visualization_msgs::Marker& m) {
  const auto all = [this](const auto&... fields) { (next(fields), ...); };
  const std::uint32_t none = 0;  // elements
  const std::string empty;
  all(m.header, m.ns, m.id, m.type, m.action, m.pose, m.scale, m.color, m.lifetime, m.frame_locked, m.points, m.colors);
  all(empty, std_msgs::Header(), empty, none, none);  // texture_resource; texture: header, format, data; uv_coordinates
  all(m.text, m.mesh_resource);
  all(empty, none);  // mesh_file: filename, data
  all(m.mesh_use_embedded_materials);
}

std::string ros2_type(const std::string& type) {
  std::string result = type;
  return result.replace(result.find('/'), 1, "/msg/");
}

namespace {

const std::string separator(80, '=');
const std::string header_type = "std_msgs/Header", marker_type = "visualization_msgs/Marker";

const char* const header_definition =
    "builtin_interfaces/Time stamp\n"
    "string frame_id\n";
const char* const before_text_of_marker =
    "string texture_resource\n"
    "sensor_msgs/CompressedImage texture\n"
    "visualization_msgs/UVCoordinate[] uv_coordinates\n";
const char* const behind_mesh_resource = "visualization_msgs/MeshFile mesh_file\n";

struct Definition {
  const char* type;
  const char* text;
};
constexpr Definition of_markers[] = {
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
};
constexpr Definition of_times[] = {
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
};

std::string ros2_field_type(const std::string& type) {
  if (type == "Header") return header_type;
  if (type == "time") return "builtin_interfaces/Time";
  if (type == "duration") return "builtin_interfaces/Duration";
  if (type == "char") return "uint8";  // what it is in ROS 1; in ROS 2 both names mean the same
  return type;
}

/// One line of `type`'s definition, without remarks.
std::string ros2_line(const std::string& type, const std::string& line) {
  static const std::regex field(R"(\s*([\w/]+)(\[\d*\])?\s+(\w+)\s*(=\s*[^#]*[^#\s])?\s*(#.*)?)");
  std::smatch found;
  if (!std::regex_match(line, found, field)) return "";
  std::string name = found[3];
  const bool is_constant = found[4].matched;
  if (!is_constant)
    for (char& letter : name) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  const std::string text = ros2_field_type(found[1]) + found[2].str() + " " + name + found[4].str() + "\n";
  if (type != marker_type) return text;
  return (name == "text" ? before_text_of_marker : "") + text + (name == "mesh_resource" ? behind_mesh_resource : "");
}

std::string part(const std::string& type, const std::string& text) {
  return separator + "\nMSG: " + type + "\n" + text;
}

}  // namespace

std::string ros2_definition(const std::string& type, const std::string& definition) {
  std::istringstream lines(definition);
  std::string current = type, line, result;
  if (type == header_type) result = header_definition;
  while (std::getline(lines, line)) {
    if (line.rfind(separator, 0) == 0) continue;
    if (line.rfind("MSG: ", 0) == 0) {
      current = line.substr(5);
      result += part(current, current == header_type ? header_definition : "");
    } else if (current != header_type) {
      result += ros2_line(current, line);
    }
  }
  const auto uses = [&](const std::string& name) { return result.find(name) != std::string::npos; };
  if (uses("MSG: " + marker_type + "\n") || type == marker_type)
    for (const Definition& one : of_markers) result += part(one.type, one.text);
  for (const Definition& one : of_times)
    if (uses(std::string(one.type) + " ")) result += part(one.type, one.text);
  return result;
}

}  // namespace bin_scenes
