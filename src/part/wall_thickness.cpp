/// One ray from each of many points that are spread evenly over the surface.
#include "bin_scenes/part/wall_thickness.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "ray_parity.hpp"
#include "tree_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bin_scenes {

namespace {

constexpr std::size_t rays = 1000;
constexpr double share = 0.05;       ///< of the surface that may be thinner
constexpr double at_surface = 1e-9;  ///< / diagonal: what is met as near is where the ray begins
constexpr double outside = 1e-6;     ///< / diagonal: in front of the surface
constexpr double inf = std::numeric_limits<double>::infinity();

struct Ray {
  Vec3 from, along;
};

/// Spread evenly over the area by a quasi-random sequence (R3, Roberts 2018).
std::vector<Ray> rays_into(const Mesh& mesh) {
  std::vector<double> area_up_to;
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area_up_to.push_back(area += mesh.area_vector(t).norm());
  const Vec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  std::vector<Ray> out;
  for (std::size_t i = 0; i < rays; ++i) {
    Vec3 place = (static_cast<double>(i) + 0.5) * step;
    place -= place.array().floor().matrix();
    const auto there = std::lower_bound(area_up_to.begin(), area_up_to.end() - 1, place.x() * area);
    const auto t = static_cast<std::size_t>(there - area_up_to.begin());
    double u = place.y(), v = place.z();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 from = (1.0 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c];
    out.push_back({from, -mesh.area_vector(t).normalized()});
  }
  return out;
}

bool meets(const Ray& ray, const Aabb& box) {
  double first = 0.0, last = inf;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis] - ray.from[axis], upper = box.upper[axis] - ray.from[axis];
    if (ray.along[axis] == 0.0) {
      if (lower > 0.0 || upper < 0.0) return false;
      continue;
    }
    const double a = lower / ray.along[axis], b = upper / ray.along[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last + 1e-12 * (first + box.size().sum());
}

/// Where a ray passes a surface (m), and whether it leaves a solid there.
struct Passage {
  double distance;
  bool leaves;

  bool operator<(const Passage& other) const { return distance < other.distance; }
};

void add_passage(const Mesh& mesh, std::size_t triangle, const Ray& ray, double least, std::vector<Passage>& passages) {
  const auto& [ia, ib, ic] = mesh.triangles[triangle];
  const Vec3 &a = mesh.vertices[ia], ab = mesh.vertices[ib] - a, ac = mesh.vertices[ic] - a;
  const Vec3 s = ray.from - a, across = ray.along.cross(ac), round = s.cross(ab);
  const double det = ab.dot(across);
  if (det == 0.0) return;
  const double u = s.dot(across) / det, v = ray.along.dot(round) / det, distance = ac.dot(round) / det;
  if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > least) passages.push_back({distance, det < 0.0});
}

/// Until the ray has left as many solids as it was in; infinite if it never does.
double length_inside(const MeshQuery& query, const Ray& ray, double least) {
  std::vector<Passage> passages;
  any_near(
      query, [&](const Aabb& box) { return !meets(ray, box); },
      [&](std::size_t triangle) {
        add_passage(query.mesh(), triangle, ray, least, passages);
        return false;
      });
  std::sort(passages.begin(), passages.end());
  int inside_of = 1;
  for (const Passage& passage : passages) {
    inside_of += passage.leaves ? -1 : 1;
    if (inside_of == 0) return passage.distance;
  }
  return inf;
}

}  // namespace

double wall_thickness(const MeshQuery& query) {
  const Mesh& mesh = query.mesh();
  if (mesh.triangles.empty() || !closed(mesh)) return 0.0;
  const double diagonal = mesh.bounds().diagonal();
  std::vector<double> lengths;
  for (const Ray& ray : rays_into(mesh))
    if (!query.inside(ray.from - outside * diagonal * ray.along))  // else it is a face within another solid
      lengths.push_back(length_inside(query, ray, at_surface * diagonal));
  BIN_SCENES_ASSERT(each_is(lengths, [](double length) { return length > 0.0; }));
  if (lengths.empty()) return 0.0;
  const auto low = lengths.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(lengths.size()));
  std::nth_element(lengths.begin(), low, lengths.end());
  return std::isfinite(*low) ? *low : 0.0;
}

}  // namespace bin_scenes
