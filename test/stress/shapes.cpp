#include "stress/shapes.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/lab.hpp"

#include <cstdio>
#include <utility>

namespace bin_scenes::stress {

namespace {

using Point = Eigen::Vector2d;

void append(Mesh& mesh, const Mesh& other) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

/// Prism of `length` along x around the middle, over a counter-clockwise polygon in y, z that can be seen whole from
/// its first point.
Mesh extrude(const std::vector<Point>& polygon, double length) {
  const auto n = static_cast<std::uint32_t>(polygon.size());
  Mesh mesh;
  for (const double x : {-0.5 * length, 0.5 * length})
    for (const Point& p : polygon) mesh.vertices.emplace_back(x, p.x(), p.y());
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({n, n + i, n + i + 1});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, n + j});
    mesh.triangles.push_back({i, n + j, n + i});
  }
  return mesh;
}

}  // namespace

Mesh box(const Vec3& size, const Vec3& center) {
  const Point h(0.5 * size.y(), 0.5 * size.z());
  Mesh mesh = extrude({{-h.x(), -h.y()}, {h.x(), -h.y()}, {h.x(), h.y()}, {-h.x(), h.y()}}, size.x());
  for (Vec3& v : mesh.vertices) v += center;
  return mesh;
}

Mesh cube(double edge) {
  return box(Vec3::Constant(edge));
}

Mesh ball(double radius, int splits) {
  return testing::sphere_mesh(radius, splits);
}

Mesh ring(double inner, double outer, double height, int segments) {
  const std::vector<Point> profile = {
      {inner, -0.5 * height}, {outer, -0.5 * height}, {outer, 0.5 * height}, {inner, 0.5 * height}};
  Mesh mesh;
  for (int s = 0; s < segments; ++s) {
    const double turn = 2.0 * M_PI * s / segments;
    for (const Point& p : profile) mesh.vertices.emplace_back(p.x() * std::cos(turn), p.x() * std::sin(turn), p.y());
  }
  const auto vertex = [&](int s, int k) { return static_cast<std::uint32_t>(4 * (s % segments) + k % 4); };
  for (int s = 0; s < segments; ++s)
    for (int k = 0; k < 4; ++k) {
      mesh.triangles.push_back({vertex(s, k), vertex(s + 1, k), vertex(s + 1, k + 1)});
      mesh.triangles.push_back({vertex(s, k), vertex(s + 1, k + 1), vertex(s, k + 1)});
    }
  return mesh;
}

Mesh angle(double length, double wall, double width) {
  return extrude({{wall, wall}, {wall, length}, {0, length}, {0, 0}, {length, 0}, {length, wall}}, width);
}

Mesh quad(double width, double depth) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh sliver_plate(double width, double depth, double height, int spikes) {
  // Long edges of the plate carry many points each; all triangles of top and bottom meet in two far corners.
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(spikes);
  std::vector<Point> outline = {{0, 0}};
  for (std::uint32_t i = 0; i <= n; ++i) outline.emplace_back(width, depth * i / n);
  outline.emplace_back(0, depth);
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, height})
    for (const Point& p : outline) mesh.vertices.emplace_back(p.x(), p.y(), z);
  for (std::uint32_t i = 1; i + 1 < count; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({count, count + i, count + i + 1});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = (i + 1) % count;
    mesh.triangles.push_back({i, j, count + j});
    mesh.triangles.push_back({i, count + j, count + i});
  }
  return mesh;
}

Mesh v_bin(double length, double opening, double depth, double wall) {
  const double h = 0.5 * opening, across = wall * std::hypot(h, depth) / depth, below = wall * std::hypot(h, depth) / h;
  Mesh mesh =
      extrude({{0, 0}, {-h, depth}, {-h - across, depth}, {0, -below}, {h + across, depth}, {h, depth}}, length);
  for (const double side : {-0.5, 0.5})
    append(mesh, box(Vec3(wall, opening + 2.0 * across, depth + below),
                     Vec3(side * (length + wall), 0, 0.5 * (depth - below))));
  return mesh;
}

Mesh slotted_bin(const Vec3& inner, double hole, double bar, double wall) {
  Mesh mesh;
  const double x = 0.5 * inner.x(), y = 0.5 * inner.y(), pitch = hole + bar;
  for (double at = -x + hole + 0.5 * bar; at < x; at += pitch)  // two layers of bars, the lower one across
    append(mesh, box(Vec3(bar, inner.y() + 2.0 * wall, bar), Vec3(at, 0, -0.5 * bar)));
  for (double at = -y + hole + 0.5 * bar; at < y; at += pitch)
    append(mesh, box(Vec3(inner.x() + 2.0 * wall, bar, bar), Vec3(0, at, -1.5 * bar)));
  for (const double side : {-1.0, 1.0}) {
    append(mesh, box(Vec3(wall, inner.y() + 2.0 * wall, inner.z() + 2.0 * bar),
                     Vec3(side * (x + 0.5 * wall), 0, 0.5 * inner.z() - bar)));
    append(mesh, box(Vec3(inner.x() + 2.0 * wall, wall, inner.z() + 2.0 * bar),
                     Vec3(0, side * (y + 0.5 * wall), 0.5 * inner.z() - bar)));
  }
  return mesh;
}

void write_obj(const Mesh& mesh, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (!file) throw environment_error("cannot be written", path, "choose another --out");
  for (const Vec3& v : mesh.vertices) std::fprintf(file, "v %.17g %.17g %.17g\n", v.x(), v.y(), v.z());
  for (const auto& [a, b, c] : mesh.triangles) std::fprintf(file, "f %u %u %u\n", a + 1, b + 1, c + 1);
  if (std::fclose(file) != 0) throw environment_error("cannot be written whole", path, "make room on the disk");
}

}  // namespace bin_scenes::stress
