#include "grasp/placed_parts.hpp"

#include "bin_scenes/mesh/bin_mesh.hpp"
#include "grasp/surface_points.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

Aabb box_of(const MeshQuery& mesh, const Pose& pose) {
  Aabb box;
  if (mesh.nodes().empty()) return box;
  for (const Vec3& v : mesh.mesh().vertices) box.extend(pose * v);
  return box;
}

}  // namespace

double highest(const Aabb& box, const Vec3& direction) {
  return direction.cwiseProduct(box.center()).sum() + 0.5 * direction.cwiseAbs().dot(box.size());
}
double lowest(const Aabb& box, const Vec3& direction) {
  return direction.cwiseProduct(box.center()).sum() - 0.5 * direction.cwiseAbs().dot(box.size());
}

namespace {

/// The bin, or a part whose number and state are not stated yet.
PlacedPart placed_at(const MeshQuery& mesh, const Pose& pose) {
  PlacedPart placed;
  placed.mesh = &mesh;
  placed.pose = pose;
  placed.box = box_of(mesh, pose);
  return placed;
}

std::vector<Vec3> tops_of(const std::vector<SpreadPoint>& points, const Pose& pose, const Vec3& up) {
  std::vector<Vec3> tops;
  for (const SpreadPoint& point : points)
    if ((pose.orientation * point.normal).dot(up) > 0.1) tops.push_back(pose * point.point);
  return tops;
}

}  // namespace

PlacedParts::PlacedParts(const Scene& scene, const LoadedRequest& loaded) {
  const Request& request = loaded.request;
  if (request.gravity.norm() > 0.0) up_ = -request.gravity.normalized();
  constexpr std::size_t probes = 96;
  std::vector<std::vector<SpreadPoint>> spread;
  for (const PartModelPtr& model : loaded.parts) spread.push_back(spread_points(model->mesh(), probes));
  for (const ScenePart& part : scene.parts) {
    if (!is_there(part.state) || !part.pose.finite()) continue;
    const MeshQuery& mesh = loaded.parts.at(part.line)->query();
    const bool movable = part.state != PartState::fixed && part.state != PartState::escaped;
    PlacedPart placed = placed_at(mesh, part.pose);
    placed.id = part.id;
    placed.line = part.line;
    placed.movable = movable;
    if (movable) placed.tops = tops_of(spread[part.line], part.pose, up_);
    all_.push_back(std::move(placed));
  }
  const Bin& bin = request.bin;
  if (bin.kind == Bin::Kind::mesh && loaded.bin_model) {
    all_.push_back(placed_at(loaded.bin_model->query(), bin.pose));
  } else if (bin.kind == Bin::Kind::box) {
    walls_ = std::make_unique<MeshQuery>(box_bin_mesh(bin));
    all_.push_back(placed_at(*walls_, Pose()));
  }
  floor_ = bin.kind == Bin::Kind::floor;
  flat_floor_ = floor_ || bin.kind == Bin::Kind::box;
  for (const PlacedPart& part : all_) top_ = std::max(top_, highest(part.box, up_));
}

std::optional<int> PlacedParts::met_by(const Sweep& sweep, const std::vector<std::size_t>& order) const {
  for (const std::size_t i : order) {
    const PlacedPart& other = all_[i];
    if (other.box.overlaps(sweep.bounds()) && sweep.meets(*other.mesh, other.pose)) return other.id;
  }
  if (floor_ && sweep.lowest(Vec3::UnitZ()) < 0.0) return -1;
  return std::nullopt;
}

}  // namespace bin_scenes
