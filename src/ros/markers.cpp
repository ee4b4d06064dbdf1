/// Markers of parts, bin and contacts. RViz reads model files by their address; of CAD files it gets the triangles.
#include "markers.hpp"

#include "core/formatted.hpp"
#include "scene/palette.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

using visualization_msgs::Marker;

constexpr double endless_plane = 4.0;     // m: edge of what is shown of a floor or table
constexpr double plane_thickness = 1e-3;  // m, below its upper side; a box marker of no thickness is refused by RViz

Marker marker(const std::string& name, int id, const Pose& pose, const Frames& frames, const ros::Time& stamp) {
  Marker m;
  m.header.frame_id = frames.bin;
  m.header.stamp = stamp;
  m.ns = name;
  m.id = id;
  m.action = Marker::ADD;
  m.pose = pose_message(pose);
  return m;
}

geometry_msgs::Point point_message(const Vec3& v) {
  geometry_msgs::Point point;
  point.x = v.x(), point.y = v.y(), point.z = v.z();
  return point;
}

/// For RViz, which reads no CAD files: the triangles themselves.
void set_triangles(Marker& m, const Mesh& mesh) {
  m.type = Marker::TRIANGLE_LIST;
  m.scale.x = m.scale.y = m.scale.z = 1.0;
  m.points.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      m.points.push_back(point_message(mesh.vertices[corner]));
    }
  }
}

/// RViz reads a COLLADA file in the unit that the file states, and any other in metres; what is left to do is `scale`
/// and the difference to the unit that the request gives.
void set_mesh(Marker& m, const std::string& model, const PartModel& part, double scale) {
  const LoadReport& file = part.load_report();
  if (is_cad(file.format)) return set_triangles(m, part.mesh());
  m.type = Marker::MESH_RESOURCE;
  m.mesh_resource = resource_uri(model, part.path());
  m.scale.x = m.scale.y = m.scale.z = scale * file.metres_per_unit / file.file_metres_per_unit;
}

struct Box {
  Vec3 center, size;
};

/// Floor and four walls round the inner space of the bin; the long walls cover the corners.
std::array<Box, 5> walls(const Bin& bin) {
  const Vec3 in = bin.inner_size;
  const double t = std::max(bin.wall_thickness, plane_thickness);
  const double x = 0.5 * (in.x() + t), y = 0.5 * (in.y() + t), z = 0.5 * in.z();
  return {Box{{0, 0, -0.5 * t}, {in.x() + 2 * t, in.y() + 2 * t, t}}, Box{{-x, 0, z}, {t, in.y(), in.z()}},
          Box{{x, 0, z}, {t, in.y(), in.z()}}, Box{{0, -y, z}, {in.x() + 2 * t, t, in.z()}},
          Box{{0, y, z}, {in.x() + 2 * t, t, in.z()}}};
}

/// The unit of what is drawn of contacts.
struct LightestPart {
  double weight = std::numeric_limits<double>::infinity();  ///< N
  double diagonal = 0.0;                                    ///< m
  explicit LightestPart(const LoadedRequest& loaded) {
    for (std::size_t line = 0; line < loaded.parts.size(); ++line) {
      const PartModel& part = *loaded.parts[line];
      const double its = mass_of(loaded.request.parts[line], part) * loaded.request.gravity.norm();
      if (!(its < weight)) continue;
      weight = its;
      diagonal = part.diagonal();
    }
  }
};

/// Blue at a tenth, green at three times, red at a hundred times the weight.
std_msgs::ColorRGBA load_color(double weights) {
  const double share = std::clamp((std::log10(std::max(weights, 1e-9)) + 1.0) / 3.0, 0.0, 1.0);
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(std::clamp(2.0 * share - 1.0, 0.0, 1.0));
  color.g = static_cast<float>(1.0 - std::abs(2.0 * share - 1.0));
  color.b = static_cast<float>(std::clamp(1.0 - 2.0 * share, 0.0, 1.0));
  color.a = 1.0f;
  return color;
}

std_msgs::ColorRGBA opaque(const Vec3& colour) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(colour.x());
  color.g = static_cast<float>(colour.y());
  color.b = static_cast<float>(colour.z());
  color.a = 1.0f;
  return color;
}

}  // namespace

std_msgs::ColorRGBA part_color(int id) {
  return opaque(part_colour(id));
}

std_msgs::ColorRGBA bin_color() {
  std_msgs::ColorRGBA color;
  color.r = color.g = color.b = 0.6f;
  color.a = 0.5f;  // parts behind a wall stay visible
  return color;
}

std::string resource_uri(const std::string& model, const std::string& path) {
  if (model.rfind("package://", 0) == 0) return model;
  std::string uri = "file://";
  for (const unsigned char c : path) {
    if (std::isalnum(c) || c == '/' || c == '-' || c == '_' || c == '.' || c == '~') {
      uri += static_cast<char>(c);
    } else {
      uri += formatted("%%%02X", c);
    }
  }
  return uri;
}

visualization_msgs::MarkerArray following_markers(const LoadedRequest& loaded, const Frames& frames,
                                                  const ros::Time& stamp) {
  Scene scene;
  for (std::size_t line = 0; line < loaded.request.parts.size(); ++line) {
    for (std::size_t k = 0; k < loaded.request.parts[line].count; ++k) {
      ScenePart part;
      part.id = static_cast<int>(scene.parts.size());
      part.line = line;
      part.model = loaded.request.parts[line].model;
      part.pose = Pose();
      scene.parts.push_back(part);
    }
  }
  visualization_msgs::MarkerArray array = scene_markers(scene, loaded, frames, stamp);
  for (Marker& m : array.markers) {
    if (m.ns != "parts") continue;
    m.header.frame_id = part_frame(m.id, frames.prefix);
    m.frame_locked = true;
  }
  return array;
}

std_msgs::ColorRGBA action_color(ContactAction action) {
  std_msgs::ColorRGBA color;
  color.a = 1.0f;
  switch (action) {
    case ContactAction::resting:
      color.r = 0.16f, color.g = 0.62f, color.b = 0.33f;
      break;
    case ContactAction::sliding:
      color.r = 0.95f, color.g = 0.76f, color.b = 0.0f;
      break;
    case ContactAction::pushed_apart:
      color.r = 0.82f, color.g = 0.31f, color.b = 0.69f;
      break;
    case ContactAction::impact:
      color.r = 0.82f, color.g = 0.10f, color.b = 0.10f;
      break;
  }
  return color;
}

visualization_msgs::MarkerArray contact_markers(const std::vector<SceneContact>& contacts, const LoadedRequest& loaded,
                                                const Frames& frames, const ros::Time& stamp) {
  const LightestPart lightest(loaded);
  visualization_msgs::MarkerArray array;
  const auto list = [&](const char* name, int type, double width) {
    Marker m = marker(name, 0, Pose(), frames, stamp);
    m.type = type;
    m.scale.x = m.scale.y = m.scale.z = width * lightest.diagonal;
    if (type == Marker::LINE_LIST) m.scale.y = m.scale.z = 0.0;
    if (contacts.empty()) m.action = Marker::DELETE;
    return m;
  };
  Marker points = list("contact_points", Marker::SPHERE_LIST, 0.04);
  Marker normals = list("contact_normals", Marker::LINE_LIST, 0.01);
  Marker forces = list("contact_forces", Marker::LINE_LIST, 0.015);
  const auto add = [&](Marker& to, const Vec3& point, const SceneContact& contact) {
    to.points.push_back(point_message(point));
    to.colors.push_back(load_color(contact.force.norm() / lightest.weight));
  };
  for (const SceneContact& c : contacts) {
    const double weights = c.force.norm() / lightest.weight;
    points.points.push_back(point_message(c.point));
    points.colors.push_back(action_color(c.action));
    add(normals, c.point, c);
    add(normals, c.point + 0.15 * lightest.diagonal * c.normal, c);
    add(forces, c.point, c);
    const double length = std::min(0.5 * weights, 3.0) * lightest.diagonal;
    add(forces, c.point + (weights > 0.0 ? Vec3(length * c.force.normalized()) : Vec3::Zero()), c);
  }
  array.markers = {points, normals, forces};
  return array;
}

visualization_msgs::MarkerArray scene_markers(const Scene& scene, const LoadedRequest& loaded, const Frames& frames,
                                              const ros::Time& stamp) {
  visualization_msgs::MarkerArray array;
  Marker clear = marker("", 0, Pose(), frames, stamp);
  clear.action = Marker::DELETEALL;
  array.markers.push_back(clear);

  const Bin& bin = loaded.request.bin;
  const auto add_box = [&](const char* name, const Box& box, const std_msgs::ColorRGBA& color) {
    Marker m = marker(name, static_cast<int>(array.markers.size()), {box.center, Quat::Identity()}, frames, stamp);
    m.type = Marker::CUBE;
    m.scale.x = box.size.x();
    m.scale.y = box.size.y();
    m.scale.z = box.size.z();
    m.color = color;
    array.markers.push_back(m);
  };
  const auto add_plane = [&](const char* name, double height, const std_msgs::ColorRGBA& color) {
    add_box(name, {{0, 0, height - 0.5 * plane_thickness}, {endless_plane, endless_plane, plane_thickness}}, color);
  };
  switch (bin.kind) {
    case Bin::Kind::box:
      for (const Box& box : walls(bin)) add_box("bin", box, bin_color());
      break;
    case Bin::Kind::floor:
      add_plane("bin", 0.0, bin_color());
      break;
    case Bin::Kind::mesh:
      if (loaded.bin_model) {
        Marker m = marker("bin", 0, bin.pose, frames, stamp);
        set_mesh(m, bin.mesh, *loaded.bin_model, 1.0);
        m.color = bin_color();
        array.markers.push_back(m);
      }
      break;
    case Bin::Kind::none:
      break;
  }

  if (loaded.request.table.height) add_plane("table", *loaded.request.table.height, opaque(table_colour));

  for (const ScenePart& part : scene.parts) {
    if (!part.pose.finite()) continue;
    Marker m = marker("parts", part.id, part.pose, frames, stamp);
    set_mesh(m, part.model, *loaded.parts.at(part.line), loaded.request.parts.at(part.line).scale);
    m.color = part_color(part.id);
    array.markers.push_back(m);
  }
  return array;
}

}  // namespace bin_scenes
