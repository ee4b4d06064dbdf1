#include "grasp/directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace bin_scenes {

namespace {

constexpr double same_direction = 1e-4;  ///< 1 - cosine: 0.8 degrees
constexpr double across = 0.05;          ///< cosine: 3 degrees
constexpr double sharp = 0.85;           ///< cosine between the normals beside an edge: 32 degrees
constexpr double large_face = 0.02;      ///< share of the surface
constexpr double long_edge = 0.2;        ///< / diagonal: total length of the edges of one direction
constexpr std::size_t most_known = 256;  ///< largest number of directions that are distinguished
constexpr std::size_t most_of_a_kind = 6;

/// Directions with weights. Opposite directions count as one.
class Weighted {
 public:
  void add(const Vec3& direction, double weight) {
    for (auto& [known, sum] : all_)
      if (std::abs(known.dot(direction)) > 1.0 - same_direction) {
        sum += weight;
        return;
      }
    if (all_.size() < most_known) all_.emplace_back(direction, weight);
  }
  /// Appends the directions with a weight of at least `least`, the heaviest first.
  void append_to(std::vector<Vec3>& directions, double least) const {
    auto sorted = all_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    for (std::size_t i = 0; i < std::min(sorted.size(), most_of_a_kind) && sorted[i].second >= least; ++i)
      directions.push_back(sorted[i].first);
  }

 private:
  std::vector<std::pair<Vec3, double>> all_;
};

Weighted faces_of(const Mesh& mesh) {
  Weighted faces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 area = mesh.area_vector(t);
    if (area.norm() > 0.0) faces.add(area.normalized(), area.norm());
  }
  return faces;
}

Weighted edges_of(const Mesh& mesh) {
  // Edges are compared by position and not by index, because meshes of STL files repeat their vertices.
  const auto key = [](const Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  using Place = std::array<double, 3>;
  std::map<std::pair<Place, Place>, Vec3> normals;
  Weighted edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 normal = mesh.area_vector(t).normalized();
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = mesh.vertices[mesh.triangles[t][i]], &b = mesh.vertices[mesh.triangles[t][(i + 1) % 3]];
      const auto other = normals.find({key(b), key(a)});
      if (other == normals.end())
        normals.emplace(std::make_pair(key(a), key(b)), normal);
      else if (other->second.dot(normal) < sharp && (b - a).norm() > 0.0)
        edges.add((b - a).normalized(), (b - a).norm());
    }
  }
  return edges;
}

}  // namespace

std::vector<Vec3> shape_directions(const PartModel& part, const Symmetries& symmetries) {
  std::vector<Vec3> directions;
  if (symmetries.continuous.size() == 1) directions.push_back(symmetries.continuous[0].direction);
  double surface = 0.0;
  for (std::size_t t = 0; t < part.mesh().triangles.size(); ++t) surface += part.mesh().area_vector(t).norm();
  faces_of(part.mesh()).append_to(directions, large_face * surface);
  edges_of(part.mesh()).append_to(directions, long_edge * part.diagonal());
  const Mat3 principal = part.mass().principal_axes.toRotationMatrix();
  for (int i = 0; i < 3; ++i) directions.push_back(principal.col(i));
  return directions;
}

Vec3 direction_across(const std::vector<Vec3>& directions, const Vec3& axis) {
  const Vec3* best = &directions.front();
  for (const Vec3& direction : directions) {
    const double along = std::abs(direction.dot(axis));
    if (along < across) {
      best = &direction;
      break;
    }
    if (along < std::abs(best->dot(axis)) - 1e-9) best = &direction;
  }
  return (*best - best->dot(axis) * axis).normalized();
}

}  // namespace bin_scenes
