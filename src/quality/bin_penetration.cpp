#include "bin_scenes/quality/quality.hpp"
#include "penetration.hpp"

#include <algorithm>
#include <map>

namespace bin_scenes {

namespace {

/// Every edge is shared by two triangles that run along it in opposite directions.
bool closed(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t u = t[i], v = t[(i + 1) % 3];
      balance[std::minmax(u, v)] += u < v ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

/// Deepest vertex behind floor and walls. A wall is solid outwards without end, up to the rim: the way out of it is
/// back into the bin or up over the rim, whichever is shorter.
Penetration behind_walls(const Mesh& part, const Pose& pose, const Bin& bin) {
  Penetration worst;
  const auto consider = [&](double depth, const Vec3& out, const Vec3& x) {
    if (depth > worst.depth) worst = {depth, -out, x};
  };
  for (const Vec3& vertex : part.vertices) {
    const Vec3 x = pose * vertex;
    consider(-x.z(), Vec3::UnitZ(), x);
    if (bin.kind != Bin::Kind::box) continue;
    const double below_rim = bin.inner_size.z() - x.z();
    for (int axis = 0; axis < 2; ++axis) {
      const double side = x[axis] < 0.0 ? -1.0 : 1.0, behind = side * x[axis] - 0.5 * bin.inner_size[axis];
      if (behind < below_rim)
        consider(behind, -side * Vec3::Unit(axis), x);
      else if (behind > 0.0)
        consider(below_rim, Vec3::UnitZ(), x);
    }
  }
  return worst;
}

}  // namespace

Penetration bin_penetration(const MeshQuery& part, const Pose& pose, const Bin& bin, const MeshQuery* bin_mesh) {
  switch (bin.kind) {
    case Bin::Kind::none:
      return {};
    case Bin::Kind::box:
    case Bin::Kind::floor:
      return behind_walls(part.mesh(), pose, bin);
    case Bin::Kind::mesh:
      break;
  }
  if (!bin_mesh) return {};
  const Vec3 middle = bin.pose.inverse() * (pose * part.mesh().bounds().center());
  return overlap({part}, pose, {*bin_mesh, closed(bin_mesh->mesh()), middle}, bin.pose);
}

}  // namespace bin_scenes
