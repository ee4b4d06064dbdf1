#include "bin_scenes/quality/quality.hpp"
#include "part/ray_parity.hpp"
#include "penetration.hpp"

#include <vector>

namespace bin_scenes {

namespace {

/// Deepest point behind floor and walls. A wall is solid outwards without end, up to the rim: the path out of it is
/// back into the bin or up over the rim, whichever is shorter. Depth is the smaller of two linear functions, so that it
/// is largest in a vertex, or where both paths out of an edge are equally long: of what leans over a rim no vertex need
/// be in it.
Penetration behind_walls(const Mesh& part, const Pose& pose, const Bin& bin) {
  Penetration worst;
  const auto consider = [&](double depth, const Vec3& out, const Vec3& x) {
    if (depth > worst.depth) worst = {depth, -out, x};
  };
  const bool walls = bin.kind == Bin::Kind::box;
  const auto behind = [&](const Vec3& x, int axis, double side) { return side * x[axis] - 0.5 * bin.inner_size[axis]; };
  const auto below_rim = [&](const Vec3& x) { return bin.inner_size.z() - x.z(); };
  std::vector<Vec3> placed;
  for (const Vec3& vertex : part.vertices) {
    const Vec3& x = placed.emplace_back(pose * vertex);
    consider(-x.z(), Vec3::UnitZ(), x);
    for (int axis = 0; walls && axis < 2; ++axis) {
      const double side = x[axis] < 0.0 ? -1.0 : 1.0, depth = behind(x, axis, side);
      if (depth < below_rim(x))
        consider(depth, -side * Vec3::Unit(axis), x);
      else if (depth > 0.0)
        consider(below_rim(x), Vec3::UnitZ(), x);
    }
  }
  const auto along_edge = [&](const Vec3& p, const Vec3& q, int axis, double side) {
    const double more_p = behind(p, axis, side) - below_rim(p), more_q = behind(q, axis, side) - below_rim(q);
    if (!(more_p < 0.0 && more_q > 0.0)) return;  // the other triangle of the edge has the opposite orientation
    const Vec3 x = p + more_p / (more_p - more_q) * (q - p);
    consider(below_rim(x), Vec3::UnitZ(), x);
  };
  for (std::size_t t = 0; walls && t < part.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      for (const int axis : {0, 1})
        for (const double side : {-1.0, 1.0})
          along_edge(placed[part.triangles[t][k]], placed[part.triangles[t][(k + 1) % 3]], axis, side);
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
  const Vec3 center = bin.pose.inverse() * (pose * part.mesh().bounds().center());
  return overlap({part}, pose, {*bin_mesh, closed(bin_mesh->mesh()), center}, bin.pose);
}

}  // namespace bin_scenes
