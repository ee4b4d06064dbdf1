/// Drops each resting part along gravity onto its neighbours and the bin, by free_distance(). A neighbour that it
/// overlaps counts as support by the direction of the overlap.
#include "gap.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "core/in_parallel.hpp"
#include "tree_pair.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

namespace bin_scenes {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double clear = 4e-9;    // / smaller diagonal: what has been moved apart stays so, in spite of rounding
constexpr double upwards = 1e-6;  // slope of a path out above which it leads up, off something that holds
constexpr int most_exits = 4;     // that are taken one after the other where parts overlap in several places

/// Walls of a box bin up to the rim, and the rim, which goes on outwards far beyond any part that did not escape.
Mesh walls(const Bin& bin) {
  const Vec3 half = 0.5 * bin.inner_size;
  const double far = 4.0 * bin.inner_size.maxCoeff(), rim = bin.inner_size.z();
  Mesh mesh;
  for (const auto& [grow, z] : {std::pair{0.0, 0.0}, std::pair{0.0, rim}, std::pair{far, rim}}) {
    for (const auto& [x, y] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
      mesh.vertices.emplace_back(x * (half.x() + grow), y * (half.y() + grow), z);
    }
  }
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    for (const std::uint32_t ring : {0u, 4u}) {
      mesh.triangles.push_back({ring + i, ring + j + 4, ring + j});
      mesh.triangles.push_back({ring + i, ring + i + 4, ring + j + 4});
    }
  }
  return mesh;
}

/// Falls of one part after the other.
class Falls {
 public:
  Falls(const std::vector<Placed>& placed, const std::vector<Overlapping>& overlaps, const Request& request,
        const MeshQuery* bin_mesh, const Vec3& down)
      : placed_(placed), bin_(request.bin), bin_mesh_(bin_mesh), down_(down), overlaps_(placed.size()) {
    BIN_SCENES_ASSERT(is_unit(down));
    BIN_SCENES_ASSERT(each_is(
        overlaps, [&](const Overlapping& o) { return o.a < o.b && o.b < placed.size() && o.found.depth >= 0.0; }));
    for (const Overlapping& o : overlaps) {
      overlaps_[o.a].push_back({o.b, -o.found.depth * o.found.direction});
      overlaps_[o.b].push_back({o.a, o.found.depth * o.found.direction});
    }
    if (bin_.kind == Bin::Kind::box) walls_.emplace(walls(bin_));
    // Shadows of parts, ordered along x, in a frame with z against gravity.
    const BoxMotion upright(Pose{Vec3::Zero(), Quat::FromTwoVectors(-down, Vec3::UnitZ())});
    for (const Placed& p : placed) {
      shadows_.push_back(upright(p.box));
      widest_ = std::max(widest_, shadows_.back().size().x());
    }
    order_.resize(placed.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::size_t i, std::size_t j) {
      const double x = shadows_[i].lower.x(), y = shadows_[j].lower.x();
      return x != y ? x < y : i < j;
    });
  }

  double of(std::size_t i) const {
    for (const Neighbour& other : overlaps_[i]) {
      if (leads_up(other.out)) return 0.0;
    }
    double best = to_bin(i);
    for (const Neighbour& other : overlaps_[i]) {
      if (best > 0.0) best = past(i, other, best);
    }
    const Aabb& shadow = shadows_[i];
    auto at = std::lower_bound(order_.begin(), order_.end(), shadow.lower.x() - widest_,
                               [&](std::size_t j, double x) { return shadows_[j].lower.x() < x; });
    for (; at != order_.end() && shadows_[*at].lower.x() <= shadow.upper.x() && best > 0.0; ++at) {
      const Aabb& other = shadows_[*at];
      if (*at == i || other.lower.z() > shadow.upper.z() || other.upper.x() < shadow.lower.x() ||
          other.upper.y() < shadow.lower.y() || other.lower.y() > shadow.upper.y() ||
          shadow.lower.z() - other.upper.z() > best || overlap(i, *at)) {
        continue;
      }
      best = free_distance(*placed_[i].query, placed_[i].part->pose, *placed_[*at].query, placed_[*at].part->pose,
                           down_, best);
    }
    return best;
  }

 private:
  struct Neighbour {
    std::size_t part;
    Vec3 out;  ///< shortest path out of it
  };

  bool leads_up(const Vec3& out) const { return -out.dot(down_) > upwards * out.norm(); }

  bool overlap(std::size_t i, std::size_t j) const {
    return std::any_of(overlaps_[i].begin(), overlaps_[i].end(), [&](const Neighbour& n) { return n.part == j; });
  }

  /// The fall past a neighbour, from the nearest place where the two do not overlap. Where none is found, as in a slot
  /// that is too narrow, they hold each other.
  double past(std::size_t i, const Neighbour& neighbour, double limit) const {
    const Placed &a = placed_[i], &b = placed_[neighbour.part];
    const double slack = clear * std::min(a.diagonal, b.diagonal);
    Pose pose = a.part->pose;
    Vec3 out = neighbour.out;
    for (int k = 0; k < most_exits; ++k) {
      pose.position += out + slack * out.normalized();
      const Penetration left = penetration(*a.query, pose, *b.query, b.part->pose);
      if (left.depth <= 0.0) return free_distance(*a.query, pose, *b.query, b.part->pose, down_, limit);
      out = -left.depth * left.direction;
      if (leads_up(out)) break;
    }
    return 0.0;
  }

  double to_bin(std::size_t i) const {
    const Placed& p = placed_[i];
    Pose pose = p.part->pose;
    if (bin_.kind == Bin::Kind::none || (bin_.kind == Bin::Kind::mesh && !bin_mesh_)) return infinity;
    double best = infinity;
    if (bin_.kind != Bin::Kind::mesh) {  // the floor
      const double slope = -down_.z();
      if (slope > upwards) best = std::max(0.0, p.box.lower.z()) / slope;
      if (bin_.kind == Bin::Kind::floor) return best;
      const Vec3 half = 0.5 * bin_.inner_size;
      const bool inside = (p.box.lower.head<2>() + half.head<2>()).minCoeff() >= 0.0 &&
                          (half.head<2>() - p.box.upper.head<2>()).minCoeff() >= 0.0;
      if (inside && slope > 1.0 - upwards) return best;
    }
    const Penetration found = bin_penetration(*p.query, pose, bin_, bin_mesh_);
    if (found.depth > 0.0) {
      const Vec3 out = -found.depth * found.direction;
      if (leads_up(out)) return 0.0;
      pose.position += out - clear * p.diagonal * found.direction;
    }
    return bin_mesh_ ? free_distance(*p.query, pose, *bin_mesh_, bin_.pose, down_, best)
                     : free_distance(*p.query, pose, *walls_, {}, down_, best);
  }

  const std::vector<Placed>& placed_;
  const Bin& bin_;
  const MeshQuery* bin_mesh_;
  Vec3 down_;
  std::vector<std::vector<Neighbour>> overlaps_;
  std::optional<MeshQuery> walls_;
  std::vector<Aabb> shadows_;
  std::vector<std::size_t> order_;
  double widest_ = 0.0;
};

}  // namespace

std::vector<double> free_falls(const std::vector<Placed>& placed, const std::vector<Overlapping>& overlaps,
                               const Request& request, const MeshQuery* bin_mesh, const Vec3& down) {
  std::vector<double> distances(placed.size(), infinity);
  if (down.isZero()) return distances;
  const Falls falls(placed, overlaps, request, bin_mesh, down);
  in_parallel(placed.size(), [&](std::size_t i) {
    if (placed[i].part->state == PartState::resting) distances[i] = falls.of(i);
  });
  BIN_SCENES_ASSERT(each_is(distances, [](double fall) { return fall >= 0.0; }));
  return distances;
}

}  // namespace bin_scenes
