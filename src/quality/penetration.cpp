/// Penetration depth of two concave meshes.
///
/// The surfaces are cut against each other through both triangle trees; every closed curve of intersection is one
/// region of overlap. Around a point x of a region, each mesh stands for the convex set of all points behind those of
/// its nearby faces that x itself lies behind. That set is a part of the mesh: on the path from x to a point outside
/// there is a face to leave by, x is behind it, and the point is not. So the depth of the two convex sets, which is
/// exact (convex_cell.hpp), never exceeds what the meshes need to come apart, and with x in the right place it is the
/// depth of the two convex pieces that touch: the depth of the region is the largest over its points. Points on one
/// side of the same faces give the same sets and are judged once.
#include "penetration.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "convex_cell.hpp"
#include "core/disjoint_sets.hpp"
#include "crossings.hpp"

#include <algorithm>
#include <cstdint>
#include <map>

namespace bin_scenes {

namespace {

// All relative to the smaller diagonal of the two meshes.
constexpr double touching = 1e-9;  // lengths that rounding makes
constexpr double coplanar = 1e-6;  // triangles this close to a common plane are one face: float32 files are no better
constexpr double sliver = 1e-4;    // thinner triangles have no plane worth the name and leave it to their neighbours
constexpr double first_reach = 0.01;  // how far around a region faces are looked for at first; doubled as needed
constexpr double tile = 8.0;          // a region wider than this many reaches is judged in tiles of that size

/// The faces of one mesh that reach into a box. Large triangles define the planes, small ones join them.
std::vector<Plane> planes_near(const OverlapSide& side, const Pose& to_frame, const Aabb& box, double unit) {
  struct Sized {
    TrianglePoints points;
    Vec3 normal;  // times twice the area
    double area;
    std::size_t triangle;
  };
  std::vector<Sized> facets;
  side.query.overlapping(BoxMotion(to_frame.inverse())(box), [&](std::size_t triangle) {
    const TrianglePoints t = moved(to_frame, points_of(side.query.mesh(), triangle));
    if (!bounds(t).overlaps(box)) return;
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    if (normal.squaredNorm() > 0.0) facets.push_back({t, normal, normal.norm(), triangle});
  });
  std::sort(facets.begin(), facets.end(), [](const Sized& s, const Sized& t) {
    return s.area != t.area ? s.area > t.area : s.triangle < t.triangle;
  });
  BIN_SCENES_ASSERT(unit > 0.0 && is_rigid(to_frame));
  std::vector<Plane> planes;
  const Vec3 front = to_frame * side.front;
  for (const Sized& f : facets) {
    const auto& [p, q, r] = f.points;
    Plane plane{f.normal / f.area, 0.0};
    plane.offset = plane.normal.dot(p + q + r) / 3.0;
    if (!side.closed && plane.above(front) < 0.0) plane = {-plane.normal, -plane.offset};
    const auto holds = [&](const Plane& known) {
      return known.normal.dot(plane.normal) > 0.9 && std::abs(known.above(p)) <= coplanar * unit &&
             std::abs(known.above(q)) <= coplanar * unit && std::abs(known.above(r)) <= coplanar * unit;
    };
    if (std::any_of(planes.begin(), planes.end(), holds)) continue;
    const double longest = std::sqrt(std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()}));
    if (f.area >= sliver * unit * longest) planes.push_back(plane);
  }
  return planes;
}

/// Which of the planes a point lies behind, as bits.
using Signature = std::vector<std::uint64_t>;

Signature behind(const std::vector<Plane>& planes, const Vec3& x, double slack) {
  BIN_SCENES_ASSERT(slack >= 0.0);
  Signature bits((planes.size() + 63) / 64, 0);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].above(x) <= slack) bits[i / 64] |= std::uint64_t{1} << (i % 64);
  }
  return bits;
}

std::size_t population(const Signature& bits) {
  std::size_t n = 0;
  for (const std::uint64_t word : bits) n += static_cast<std::size_t>(__builtin_popcountll(word));
  return n;
}

/// The convex sets of one mesh, one per signature met, made when first asked for.
class Cells {
 public:
  Cells(const std::vector<Plane>& planes, const Aabb& box) : planes_(planes), box_(box) {}

  std::size_t id(Signature signature) {
    const auto [found, added] = ids_.try_emplace(std::move(signature), cells_.size());
    if (added) {
      cells_.emplace_back();
      signatures_.push_back(&found->first);
    }
    return found->second;
  }
  const Signature& signature(std::size_t id) const { return *signatures_[id]; }
  const ConvexCell& cell(std::size_t id) {
    if (!cells_[id]) {
      cells_[id].emplace(box_);
      for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (has(id, i)) cells_[id]->clip(planes_[i]);
      }
    }
    return *cells_[id];
  }
  /// Upper bound of the depth of cell `id` and `other` from the faces of the former, without making it.
  double bound(std::size_t id, const ConvexCell& other) const {
    double depth = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (has(id, i)) depth = std::min(depth, -planes_[i].above(other.lowest(planes_[i].normal)));
    }
    return depth;
  }

 private:
  bool has(std::size_t id, std::size_t plane) const { return signature(id)[plane / 64] >> (plane % 64) & 1; }

  const std::vector<Plane>& planes_;
  Aabb box_;
  std::map<Signature, std::size_t> ids_;
  std::vector<const Signature*> signatures_;
  std::vector<std::optional<ConvexCell>> cells_;
};

/// Of a closed mesh; outside of its bounds, no triangle needs a look.
bool lies_in(const MeshQuery& query, const Vec3& x) {
  return query.nodes()[0].box.overlaps({x, x}) && query.inside(x);
}

/// Whether a mesh that cuts no triangle of `outer` lies in it: most do not, and then some corner is outside its bounds.
bool within(const MeshQuery& inner, const Pose& to_outer, const MeshQuery& outer) {
  const Mesh& mesh = inner.mesh();
  const Aabb& box = outer.nodes()[0].box;
  const auto in_box = [&](const Triangle& t) {
    const Vec3 x = to_outer * mesh.vertices[t[0]];
    return box.overlaps({x, x});
  };
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), in_box) &&
         outer.inside(to_outer * mesh.vertices[mesh.triangles[0][0]]);
}

/// Centres of the triangles of `one` near a box that lie inside `other`; triangles in `cut` meet its surface and are
/// left out. What hangs together by corners without being cut is inside or outside as a whole.
std::vector<Vec3> centers_inside(const OverlapSide& one, const Pose& to_frame, const OverlapSide& other,
                                 const Pose& to_other, const Aabb& box, const std::vector<std::size_t>& cut) {
  if (!other.closed) return {};
  BIN_SCENES_ASSERT(std::is_sorted(cut.begin(), cut.end()));
  const Mesh& mesh = one.query.mesh();
  std::vector<std::size_t> triangles;
  one.query.overlapping(BoxMotion(to_frame.inverse())(box), [&](std::size_t triangle) {
    if (!std::binary_search(cut.begin(), cut.end(), triangle)) triangles.push_back(triangle);
  });
  std::vector<std::uint32_t> corners;
  for (const std::size_t t : triangles)
    corners.insert(corners.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const auto place = [&](std::uint32_t vertex) {
    return static_cast<std::uint32_t>(std::lower_bound(corners.begin(), corners.end(), vertex) - corners.begin());
  };
  DisjointSets sets(corners.size());
  for (const std::size_t t : triangles)
    for (const int k : {1, 2}) sets.join(place(mesh.triangles[t][0]), place(mesh.triangles[t][k]));
  std::map<std::uint32_t, bool> inside;  // by root
  std::vector<Vec3> centers;
  for (const std::size_t t : triangles) {
    const auto [p, q, r] = points_of(mesh, t);
    const Vec3 center = (p + q + r) / 3.0;
    const auto [verdict, added] = inside.try_emplace(sets.root(place(mesh.triangles[t][0])), false);
    if (added) verdict->second = lies_in(other.query, to_other * center);
    if (verdict->second) centers.push_back(to_frame * center);
  }
  return centers;
}

/// Largest depth over points that lie in both meshes, judged with the faces no farther than `reach` from them. Less
/// than the truth where that is below `enough`, or where it comes near `reach`.
Separation depth_within(const OverlapSide& a, const OverlapSide& b, const Pose& b_in_a, const std::vector<Vec3>& common,
                        Aabb box, double unit, double enough) {
  const std::vector<Plane> planes_a = planes_near(a, Pose(), box, unit), planes_b = planes_near(b, b_in_a, box, unit);
  Cells cells_a(planes_a, box), cells_b(planes_b, box);
  struct Group {
    std::size_t point, planes, cell_a, cell_b;
  };
  std::map<std::pair<std::size_t, std::size_t>, Group> groups;
  const double slack = 2.0 * coplanar * unit;
  for (std::size_t i = 0; i < common.size(); ++i) {
    Signature in_a = behind(planes_a, common[i], slack), in_b = behind(planes_b, common[i], slack);
    const std::size_t planes = population(in_a) + population(in_b);
    const std::size_t cell_a = cells_a.id(std::move(in_a)), cell_b = cells_b.id(std::move(in_b));
    groups.try_emplace({cell_a, cell_b}, Group{i, planes, cell_a, cell_b});
  }

  // The fewer faces, the larger the sets, the deeper they may be.
  std::vector<Group> order;
  for (const auto& [key, group] : groups) order.push_back(group);
  std::sort(order.begin(), order.end(), [](const Group& s, const Group& t) {
    return s.planes != t.planes ? s.planes < t.planes : s.point < t.point;
  });
  Separation best;
  for (const Group& group : order) {
    stop_if_cancelled();
    const ConvexCell& cell_b = cells_b.cell(group.cell_b);
    const double known = std::max(enough, best.depth);
    if (cell_b.empty() || cells_a.bound(group.cell_a, cell_b) <= known) continue;
    const Separation found = separation(cells_a.cell(group.cell_a), cell_b, common[group.point], slack, known);
    if (found.depth > best.depth) best = found;
  }
  return best;
}

/// Two meshes in the frame of the first, and where their surfaces meet.
struct Overlap {
  const OverlapSide &a, &b;
  Pose b_in_a;
  double unit;
  std::array<std::vector<std::size_t>, 2> cut;  ///< triangles that meet the other mesh, sorted

  /// Largest depth of one region of overlap; `common` are points of both meshes on its rim.
  Separation depth(const Aabb& region, const std::vector<Vec3>& common, double enough) const {
    const double widest = a.query.nodes()[0].box.diagonal() + b.query.nodes()[0].box.diagonal();
    for (double reach = std::max(first_reach * unit, 2.0 * enough);;) {
      const Separation found = depth(region, common, reach, enough);
      if (found.depth <= 0.5 * reach || reach > widest) return found;
      reach = std::max(2.0 * reach, 2.5 * found.depth);
    }
  }

 private:
  Separation depth(const Aabb& region, std::vector<Vec3> points, double reach, double enough) const {
    const Aabb box = widened(region, reach);
    const std::vector<Vec3> of_a = centers_inside(a, Pose(), b, b_in_a.inverse(), box, cut[0]);
    const std::vector<Vec3> of_b = centers_inside(b, b_in_a, a, b_in_a, box, cut[1]);
    points.insert(points.end(), of_a.begin(), of_a.end());
    points.insert(points.end(), of_b.begin(), of_b.end());

    // A wide region is judged tile by tile: what is farther away than the reach does not limit the depth.
    std::map<std::array<int, 3>, std::vector<Vec3>> tiles;
    const double edge = tile * reach;
    for (const Vec3& x : points) {
      const Vec3 at = ((x - box.lower) / edge).array().floor();
      tiles[{static_cast<int>(at.x()), static_cast<int>(at.y()), static_cast<int>(at.z())}].push_back(x);
    }
    Separation best;
    for (const auto& [key, common] : tiles) {
      Aabb around;
      for (const Vec3& x : common) around.extend(x);
      const Separation found =
          depth_within(a, b, b_in_a, common, widened(around, reach), unit, std::max(enough, best.depth));
      if (found.depth > best.depth) best = found;
    }
    return best;
  }

  static Aabb widened(Aabb box, double by) {
    box.lower.array() -= by;
    box.upper.array() += by;
    return box;
  }
};

}  // namespace

Penetration overlap(const OverlapSide& a, const Pose& pose_a, const OverlapSide& b, const Pose& pose_b) {
  const Mesh &mesh_a = a.query.mesh(), &mesh_b = b.query.mesh();
  if (mesh_a.empty() || mesh_b.empty()) return {};
  const Aabb &box_a = a.query.nodes()[0].box, &box_b = b.query.nodes()[0].box;
  const Pose b_in_a = pose_a.inverse() * pose_b;
  if (!box_a.overlaps(BoxMotion(b_in_a)(box_b))) return {};
  const double unit = std::min(box_a.diagonal(), box_b.diagonal());
  const std::vector<Crossing> cuts = crossings(a.query, b.query, b_in_a, touching * unit);
  Overlap pair{a, b, b_in_a, unit, {}};
  for (int side = 0; side < 2; ++side) {
    std::vector<std::size_t>& cut = pair.cut[side];
    for (const Crossing& c : cuts) cut.push_back(c.triangles[side]);
    std::sort(cut.begin(), cut.end());
    cut.erase(std::unique(cut.begin(), cut.end()), cut.end());
  }

  Separation worst;
  for (const std::vector<std::size_t>& curve : connected(cuts, 10.0 * touching * unit)) {
    Aabb region;
    std::vector<Vec3> points;
    for (const std::size_t i : curve) {
      region.extend(cuts[i].box);
      points.push_back(cuts[i].point);
    }
    const Separation found = pair.depth(region, points, worst.depth);
    if (found.depth > worst.depth) worst = found;
  }
  if (cuts.empty()) {  // apart, or one inside the other
    if (a.closed && within(b.query, b_in_a, a.query)) {
      worst = pair.depth(BoxMotion(b_in_a)(box_b), {}, 0.0);
    } else if (b.closed && within(a.query, b_in_a.inverse(), b.query)) {
      worst = pair.depth(box_a, {}, 0.0);
    }
  }
  if (worst.depth <= touching * unit) return {};
  return {worst.depth, pose_a.orientation * worst.direction, pose_a * worst.point};
}

Penetration penetration(const MeshQuery& a, const Pose& pose_a, const MeshQuery& b, const Pose& pose_b) {
  return overlap({a}, pose_a, {b}, pose_b);
}

}  // namespace bin_scenes
