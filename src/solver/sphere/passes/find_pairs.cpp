/// Sweeps upright boxes along strips, then tests oriented boxes. GPU form: shaders/sphere/find_pairs.comp.
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/contact.hpp"
#include "core/in_parallel.hpp"
#include "solver/sphere/invariants.hpp"
#include "solver/sphere/passes/counting_sort.hpp"
#include "solver/sphere/passes/lanes.hpp"
#include "solver/sphere/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace bin_scenes::sphere {

namespace {

constexpr std::size_t entries_per_piece = 256;     ///< of a thread; fewer = more handing over
constexpr std::size_t entries_between_stops = 16;  ///< each may meet all others: milliseconds with 20,000 in one place

struct Bounds {
  Vec3f lower, upper;
  float margin;
  std::uint32_t body;
  int strip;  ///< first that the box lies in
};

/// A box in one of the strips that it lies in.
struct Entry {
  int strip;
  float lower_x;
  std::uint32_t box;
};

/// The upright boxes of eight entries in a row.
struct EntryLanes {
  Lanes lower_x{}, lower_y{}, upper_y{}, lower_z{}, upper_z{};
};

using Pair = std::pair<std::uint32_t, std::uint32_t>;

/// Distance that the surface of a body may move in one step, and the distance at which contacts are kept.
float reach(const World& world, const Body& b) {
  const float base = 0.5f * world.settings.margin * world.shapes[b.shape]->size;
  if (!b.moves()) return base;
  return base +
         (b.v.norm() + b.w.norm() * world.shapes[b.shape]->radius + world.gravity.norm() * world.settings.time_step) *
             world.settings.time_step;
}

Bounds bounds_of(const World& world, std::uint32_t i) {
  const Body& b = world.bodies[i];
  const Shape& s = *world.shapes[b.shape];
  const float margin = reach(world, b);
  const Vec3f center = b.x + b.rotation * s.box_center;
  const Vec3f half = b.rotation.cwiseAbs() * s.box_half + Vec3f::Constant(margin);
  return {center - half, center + half, margin, i, 0};
}

/// Width along y (m) of the strips: some two boxes, and no box lies in more than a few dozen. Few boxes share one
/// strip, for sorting those that lie in several costs more than it saves.
float strip_width(const std::vector<Bounds>& boxes) {
  if (boxes.size() < 512) return std::numeric_limits<float>::infinity();
  float sum = 0.0f, widest = 0.0f;
  for (const Bounds& box : boxes) {
    const float width = box.upper.y() - box.lower.y();
    sum += width;
    widest = std::max(widest, width);
  }
  return std::max({2.0f * sum / static_cast<float>(boxes.size()), widest / 32.0f, 1e-9f});
}

int strip_at(float y, float width) {
  return static_cast<int>(std::fmax(-1e9f, std::fmin(1e9f, std::floor(y / width))));
}

/// Separating axis test on the six face normals of both oriented boxes: rejects most pairs whose upright boxes meet.
bool boxes_apart(const World& world, const Body& a, const Body& b, float margin) {
  const Shape &sa = *world.shapes[a.shape], &sb = *world.shapes[b.shape];
  const Vec3f d = (b.x + b.rotation * sb.box_center) - (a.x + a.rotation * sa.box_center);
  const Mat3f relative = (a.rotation.transpose() * b.rotation);
  const Mat3f size = relative.cwiseAbs();
  const Vec3f da = (a.rotation.transpose() * d).cwiseAbs(), db = (b.rotation.transpose() * d).cwiseAbs();
  return ((da - sa.box_half - size * sb.box_half).array() > margin).any() ||
         ((db - sb.box_half - size.transpose() * sa.box_half).array() > margin).any();
}

void fill_lanes(const std::vector<Entry>& entries, const std::vector<Bounds>& boxes, std::vector<EntryLanes>& lanes) {
  lanes.resize((entries.size() + lane_count - 1) / lane_count);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Bounds& box = boxes[entries[i].box];
    EntryLanes& to = lanes[i / lane_count];
    const int lane = static_cast<int>(i % lane_count);
    to.lower_x[lane] = box.lower.x();
    to.lower_y[lane] = box.lower.y();
    to.upper_y[lane] = box.upper.y();
    to.lower_z[lane] = box.lower.z();
    to.upper_z[lane] = box.upper.z();
  }
}

/// Entries behind the i-th one, in its strip, whose upright boxes meet its own, for i in [begin, end): `meeting(i, j)`.
/// It may not throw: GCC 12 leaves the versions of a BIN_SCENES_WIDE function without handlers of its callers.
template <class Meeting>
BIN_SCENES_WIDE void sweep(const std::vector<Entry>& entries, const std::vector<Bounds>& boxes,
                           const std::vector<EntryLanes>& lanes, std::size_t begin, std::size_t end,
                           const Meeting& meeting) {
  for (std::size_t i = begin; i < end; ++i) {
    const Bounds& p = boxes[entries[i].box];
    for (std::size_t first = (i + 1) / lane_count * lane_count; first < entries.size(); first += lane_count) {
      if (entries[first].strip != entries[i].strip && first > i) break;
      if (first > i && entries[first].lower_x > p.upper.x()) break;
      const EntryLanes& q = lanes[first / lane_count];
      const LaneMask meets = (q.lower_x <= p.upper.x()) & (q.lower_y <= p.upper.y()) & (q.upper_y >= p.lower.y()) &
                             (q.lower_z <= p.upper.z()) & (q.upper_z >= p.lower.z());
      if (!any(meets)) continue;
      const std::size_t last = std::min(first + lane_count, entries.size());
      for (std::size_t j = std::max(first, i + 1); j < last && entries[j].strip == entries[i].strip; ++j)
        if (meets[j - first]) meeting(i, j);
    }
  }
}

bool may_touch(const World& world, const Bounds& p, const Bounds& r) {
  const Body &a = world.bodies[p.body], &b = world.bodies[r.body];
  if (!a.moves() && !b.moves()) return false;
  if (a.inverse_mass == 0 && b.inverse_mass == 0) return false;  // on their paths
  return !world.settings.oriented_boxes || !boxes_apart(world, a, b, p.margin + r.margin);
}

/// `work(begin, end, pairs)` for pieces of `count` entries, in parallel where there are many; what they find goes to
/// `found`, in order of the pieces.
template <class Work>
void for_each_piece(std::size_t count, std::vector<Pair>& found, const Work& work) {
  static thread_local std::vector<std::vector<Pair>> kept;
  const std::size_t pieces = (count + entries_per_piece - 1) / entries_per_piece;
  std::vector<std::vector<Pair>>& of_piece = kept;  // of this thread, whichever thread works on a piece
  if (of_piece.size() < pieces) of_piece.resize(pieces);
  const auto piece = [&](std::size_t k) {
    of_piece[k].clear();
    const std::size_t last = std::min((k + 1) * entries_per_piece, count);
    for (std::size_t begin = k * entries_per_piece; begin < last; begin += entries_between_stops) {
      stop_if_cancelled();
      work(begin, std::min(begin + entries_between_stops, last), of_piece[k]);
    }
  };
  in_parallel(pieces, piece);
  for (std::size_t k = 0; k < pieces; ++k) found.insert(found.end(), of_piece[k].begin(), of_piece[k].end());
}

/// By a, then b; the ground comes last.
void sort_pairs(std::vector<Pair>& pairs, std::size_t bodies) {
  static thread_local std::vector<Pair> by_b;
  static thread_local std::vector<std::uint32_t> start;
  counting_sort(
      pairs, bodies + 1, [&](const Pair& p) { return std::min<std::size_t>(p.second, bodies); }, start, by_b);
  counting_sort(
      by_b, bodies, [](const Pair& p) { return p.first; }, start, pairs);
}

/// Whether the body's upright box comes near any wall or the floor.
bool near_ground(const World& world, const Bounds& box) {
  for (const Plane& p : world.planes) {
    const Vec3f nearest = (p.normal.array() > 0).select(box.lower, box.upper);
    if (p.normal.dot(nearest) < p.offset) return true;
  }
  return false;
}

Manifold manifold_between(const World& world, std::uint32_t a, std::uint32_t b) {
  Manifold m;
  m.a = a;
  m.b = b;
  const Body& body = world.bodies[a];
  const float friction = b == ground ? world.ground_friction : world.bodies[b].friction;
  const float restitution = b == ground ? world.ground_restitution : world.bodies[b].restitution;
  m.friction = pair_friction(body.friction, friction);
  m.restitution = std::max(body.restitution, restitution);
  return m;
}

/// Merges the sorted pairs with the manifolds of the last step: forces and recyclable contacts live on under the same
/// key.
void adopt(World& world, const std::vector<Pair>& found) {
  BIN_SCENES_ASSERT(manifolds_ascend(world));
  world.previous.swap(world.manifolds);
  world.manifolds.clear();
  std::size_t old = 0;
  const auto keep_sleeping = [&](Manifold& m) {
    const bool a_waits = world.bodies[m.a].present && !world.bodies[m.a].moves();
    const bool b_waits = m.b == ground || (world.bodies[m.b].present && !world.bodies[m.b].moves());
    if (a_waits && b_waits) {
      world.manifolds.push_back(std::move(m));
      ++world.counters.pairs_asleep;
    }
  };
  for (const auto& [a, b] : found) {
    stop_if_cancelled();
    while (old < world.previous.size() &&
           std::make_pair(world.previous[old].a, world.previous[old].b) < std::make_pair(a, b))
      keep_sleeping(world.previous[old++]);
    if (old < world.previous.size() && world.previous[old].a == a && world.previous[old].b == b)
      world.manifolds.push_back(std::move(world.previous[old++]));
    else
      world.manifolds.push_back(manifold_between(world, a, b));
  }
  while (old < world.previous.size()) keep_sleeping(world.previous[old++]);
  BIN_SCENES_ASSERT(manifolds_ascend(world));
}

}  // namespace

/// Sort and sweep along x over upright boxes, eight at a time, in strips along y, then oriented boxes: on a wide floor
/// a sweep meets what lies in its strip, not all that lies at the same x. Pairs of bodies that do not move are left
/// out, unless they were in contact already (their manifold waits, untouched, until one of them wakes).
void find_pairs(World& world) {
  static thread_local std::vector<Bounds> boxes;
  static thread_local std::vector<Entry> entries;
  static thread_local std::vector<EntryLanes> lanes;
  static thread_local std::vector<Pair> found;
  boxes.clear();
  entries.clear();
  found.clear();
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& b = world.bodies[i];
    if (!b.present) continue;
    b.rotation = b.q.toRotationMatrix();
    b.world_inverse_inertia =
        b.inverse_mass > 0 ? Mat3f(b.rotation * b.inverse_inertia * b.rotation.transpose()) : Mat3f(Mat3f::Zero());
    boxes.push_back(bounds_of(world, i));
    if (b.moves() && !b.driven && near_ground(world, boxes.back())) found.emplace_back(i, ground);
  }
  const float width = strip_width(boxes);
  BIN_SCENES_ASSERT(width > 0);
  for (std::uint32_t k = 0; k < boxes.size(); ++k) {
    boxes[k].strip = strip_at(boxes[k].lower.y(), width);
    const int last = strip_at(boxes[k].upper.y(), width);
    for (int strip = boxes[k].strip; strip <= last; ++strip) entries.push_back({strip, boxes[k].lower.x(), k});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.strip, a.lower_x, a.box) < std::tie(b.strip, b.lower_x, b.box);
  });
  fill_lanes(entries, boxes, lanes);
  BIN_SCENES_ASSERT(entries.size() >= boxes.size() && lanes.size() * lane_count >= entries.size());
  // Of this thread, whichever thread works on a piece.
  const std::vector<Bounds>& all_boxes = boxes;
  const std::vector<Entry>& all_entries = entries;
  const std::vector<EntryLanes>& all_lanes = lanes;
  for_each_piece(entries.size(), found, [&](std::size_t begin, std::size_t end, std::vector<Pair>& pairs) {
    const auto meeting = [&](std::size_t i, std::size_t j) {
      const Bounds &p = all_boxes[all_entries[i].box], &r = all_boxes[all_entries[j].box];
      if (std::max(p.strip, r.strip) != all_entries[i].strip) return;  // met in an earlier strip
      if (may_touch(world, p, r)) pairs.emplace_back(std::min(p.body, r.body), std::max(p.body, r.body));
    };
    sweep(all_entries, all_boxes, all_lanes, begin, end, meeting);
  });
  sort_pairs(found, world.bodies.size());
  BIN_SCENES_ASSERT(ascends(found));
  adopt(world, found);
}

}  // namespace bin_scenes::sphere
