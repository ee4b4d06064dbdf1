#include "symmetry_axes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bin_scenes {

namespace {

constexpr double equal_moments = 0.02;    ///< relative difference up to which an axis between two is tried
constexpr int directions_between = 48;    ///< of those that are tried over half a turn
constexpr std::size_t most_normals = 32;  ///< of faces, the largest ones
constexpr std::size_t most_far = 16;      ///< vertices

/// Normals of the largest flat faces.
std::vector<Vec3> large_normals(const Mesh& mesh) {
  std::vector<std::pair<double, Vec3>> faces;  // area, normal
  constexpr std::size_t most = 400;            // that are distinguished
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 area = mesh.area_vector(t);
    if (!(area.norm() > 0.0)) continue;
    const Vec3 normal = area.normalized();
    const auto known = std::find_if(faces.begin(), faces.end(),
                                    [&](const auto& face) { return std::abs(face.second.dot(normal)) > 1.0 - 1e-7; });
    if (known != faces.end())
      known->first += area.norm();
    else if (faces.size() < most)
      faces.emplace_back(area.norm(), normal);
  }
  std::stable_sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < std::min(most_normals, faces.size()); ++i) normals.push_back(faces[i].second);
  return normals;
}

/// Towards the vertices that lie farthest from an axis, and between any two of them: a half turn across the axis leaves
/// one of them in its place, or exchanges two.
std::vector<Vec3> far_directions(const Mesh& mesh, const Vec3& center, const Vec3& axis) {
  std::vector<Vec3> arms;
  for (const Vec3& vertex : mesh.vertices) arms.push_back((vertex - center) - axis * axis.dot(vertex - center));
  const auto longer = [](const Vec3& a, const Vec3& b) { return a.squaredNorm() > b.squaredNorm(); };
  const std::size_t count = std::min(arms.size(), most_far);
  std::partial_sort(arms.begin(), arms.begin() + static_cast<std::ptrdiff_t>(count), arms.end(), longer);
  arms.resize(count);
  for (Vec3& arm : arms) arm.normalize();
  std::vector<Vec3> directions = arms;
  for (std::size_t i = 0; i < arms.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) directions.push_back((arms[i] + arms[j]).normalized());
  return directions;
}

/// The centre of the surface around a direction, seen from the centre, shifted there until it stays.
Vec3 center_around(const Mesh& mesh, const Vec3& center, Vec3 direction) {
  const double within = std::cos(0.4);  // rad: half of what is between arms of an icosahedron, and less
  for (int shift = 0; shift < 20; ++shift) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3 arm = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0 - center;
      if (arm.dot(direction) > within * arm.norm()) sum += mesh.area_vector(t).norm() * arm;
    }
    if (!(sum.norm() > 0.0)) break;
    const Vec3 before = std::exchange(direction, sum.normalized());
    if ((direction - before).norm() < 1e-9) break;
  }
  return direction;
}

/// Along the arms of a part whose moments are all equal, as of a tetrapod or a jack: towards the farthest vertices, no
/// two of one arm, and from there to its centre, since the vertices of a rounded end lie beside it.
std::vector<Vec3> arm_directions(const Mesh& mesh, const Vec3& center) {
  constexpr double one_arm = 0.6;  // rad
  std::vector<Vec3> arms, directions;
  for (const Vec3& vertex : mesh.vertices) arms.push_back(vertex - center);
  std::stable_sort(arms.begin(), arms.end(),
                   [](const Vec3& a, const Vec3& b) { return a.squaredNorm() > b.squaredNorm(); });
  std::vector<Vec3> far;
  for (std::size_t i = 0; i < arms.size() && far.size() < most_far; ++i) {
    const Vec3 arm = arms[i].normalized();
    const auto same = [&](const Vec3& other) { return other.dot(arm) > std::cos(one_arm); };
    if (std::none_of(far.begin(), far.end(), same)) far.push_back(arm);
  }
  for (const Vec3& arm : far) directions.push_back(center_around(mesh, center, arm));
  return directions;
}

}  // namespace

std::vector<Vec3> candidate_axes(const PartModel& part) {
  const Vec3 moments = part.mass().principal;
  const Mat3 axes = part.mass().principal_axes.toRotationMatrix();
  std::vector<Vec3> all, guessed;
  bool any = false;
  for (int i = 0; i < 3; ++i) {
    const int a = i, b = (i + 1) % 3;
    if (std::abs(moments[a] - moments[b]) > equal_moments * moments.maxCoeff()) continue;
    any = true;
    for (const Vec3& arm : far_directions(part.mesh(), part.mass().center, axes.col((i + 2) % 3))) all.push_back(arm);
    for (int k = 1; k < directions_between; ++k) {
      const double angle = M_PI * k / directions_between;
      guessed.push_back(std::cos(angle) * axes.col(a) + std::sin(angle) * axes.col(b));
    }
  }
  if (moments.maxCoeff() - moments.minCoeff() <= equal_moments * moments.maxCoeff())
    for (const Vec3& arm : arm_directions(part.mesh(), part.mass().center)) all.push_back(arm);
  if (any)
    for (const Vec3& normal : large_normals(part.mesh())) all.push_back(normal);
  all.insert(all.begin(), {axes.col(0), axes.col(1), axes.col(2), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
  all.insert(all.end(), guessed.begin(), guessed.end());
  std::vector<Vec3> distinct;
  for (const Vec3& axis : all) {
    const bool known = std::any_of(distinct.begin(), distinct.end(),
                                   [&](const Vec3& other) { return std::abs(axis.dot(other)) > 1.0 - 1e-6; });
    const bool somewhere = axis.norm() > 0.5;  // not so between opposite vertices
    if (!known && somewhere) distinct.push_back(axis);
  }
  return distinct;
}

}  // namespace bin_scenes
