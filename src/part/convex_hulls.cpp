/// Makes hulls of pieces, merges them while the error stays small, and takes the better of two decompositions
/// (plane_cuts.hpp, hacd_partition.hpp).
#include "bin_scenes/part/convex_hulls.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "bin_scenes/part/shape_error.hpp"
#include "core/formatted.hpp"
#include "core/in_parallel.hpp"
#include "hacd_partition.hpp"
#include "plane_cuts.hpp"
#include "round_holes.hpp"
#include "shells.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace bin_scenes {
namespace {

// Cell of the field that measures how far a hull sticks out, and distance between the points where it is evaluated,
// both / diagonal.
constexpr double field_cell = 0.008, step = 0.02;
// Distance of the places where the error is measured, / diagonal.
constexpr double measure_step = 0.015;
// What a hull may stick out at first / max_error, and how often less of it is tried.
constexpr double first_limit = 0.75;
constexpr int tries = 4;
// Cuts may make this many times the pieces that are allowed: merging makes fewer of them.
constexpr int spare = 3;
// Patches of HACD to merge from.
constexpr int patches = 64;
// What hulls beside a hole may lack of the solid / max_error.
constexpr double hole_loss = 0.8;
constexpr int all_vertices = std::numeric_limits<int>::max();
constexpr int most_more = 8;            // times as many vertices as asked for may a convex part get
constexpr double convex_enough = 1e-3;  // of its volume may be missing from its hull

/// A piece of the part that becomes a hull.
struct Piece {
  std::vector<Vec3> points;  // vertices of its hull, or all of them while they are flat
  Mesh hull;                 // empty while flat
  Aabb bounds;
};

Piece piece_of(std::vector<Vec3> points) {
  Piece piece;
  for (const Vec3& p : points) piece.bounds.extend(p);
  piece.hull = convex_hull(points, std::numeric_limits<int>::max());
  piece.points = piece.hull.empty() ? std::move(points) : piece.hull.vertices;
  return piece;
}

Piece merged(const Piece& a, const Piece& b) {
  std::vector<Vec3> points = a.points;
  points.insert(points.end(), b.points.begin(), b.points.end());
  return piece_of(std::move(points));
}

/// How far hulls stick out of a solid, read from its distance field.
class Protrusion {
 public:
  explicit Protrusion(const MeshQuery& query)
      : field_(distance_field(query, {field_cell})), step_(step * query.mesh().bounds().diagonal()) {}

  /// Largest distance (m) before the surface, and where.
  std::pair<double, Vec3> operator()(const Mesh& hull) const {
    std::pair<double, Vec3> worst{0.0, hull.vertices[0]};
    for (const SurfacePoint& s : dense_surface_points(hull, step_)) {
      const double distance = field_.distance(s.point);
      if (distance > worst.first) worst = {distance, s.point};
    }
    return worst;
  }
  bool inside(const Vec3& point) const { return field_.distance(point) < 0; }

 private:
  DistanceField field_;
  double step_;
};

/// Larger of what the hulls stick out of the mesh and what they leave bare of it, / diagonal. Without a field every
/// face of a hull counts; with one, those inside the solid do not: there two hulls meet, and nothing touches them.
double surface_error(const std::vector<Mesh>& hulls, const MeshQuery& query, const Protrusion* protrusion) {
  const double diagonal = query.mesh().bounds().diagonal();
  std::vector<HullPlanes> planes;
  double worst = 0;
  for (const Mesh& hull : hulls) {
    planes.emplace_back(hull);
    for (const SurfacePoint& s : dense_surface_points(hull, measure_step * diagonal)) {
      if (protrusion && protrusion->inside(s.point)) continue;
      // Only points further off than the worst so far matter: a point has to be looked up only if none is that near.
      if (query.nearest(s.point, worst).distance > worst) worst = query.nearest(s.point).distance;
    }
  }
  std::size_t last = 0;  // the hull that held a point mostly holds the next one
  for (const SurfacePoint& s : dense_surface_points(query.mesh(), measure_step * diagonal)) {
    const auto holds = [&](const HullPlanes& hull) {
      return hull.to_box(s.point) <= worst && !hull.outside_by_more(s.point, worst);
    };
    if (holds(planes[last])) continue;
    const auto holder = std::find_if(planes.begin(), planes.end(), holds);
    if (holder != planes.end()) {
      last = static_cast<std::size_t>(holder - planes.begin());
    } else {
      worst = std::max(worst, distance_to_union(planes, s.point));
    }
  }
  return worst / diagonal;
}

/// Merges the pair of pieces whose common hull sticks out least, until no pair stays below the limit and few enough are
/// left. Pieces further apart than `touch` are not tried unless few are left.
std::vector<Piece> merge(const std::vector<std::vector<Vec3>>& parts, const Protrusion& protrusion, double limit,
                         double touch, int max_pieces) {
  std::vector<Piece> pieces;
  for (const std::vector<Vec3>& points : parts) pieces.push_back(piece_of(points));
  constexpr std::size_t all_pairs = 16;  // so few that pieces which do not touch are tried, too
  const double never = std::numeric_limits<double>::infinity();
  // cost[a][b], a < b; NaN = not asked yet
  const std::size_t n = pieces.size();
  std::vector<double> cost(n * n, std::nan(""));
  std::vector<std::uint8_t> alive(n, 1);
  std::size_t count = n;
  for (;;) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs, unknown;
    for (std::size_t a = 0; a < n; ++a) {
      stop_if_cancelled();
      for (std::size_t b = a + 1; b < n; ++b) {
        if (!alive[a] || !alive[b]) continue;
        if (count > all_pairs && !pieces[a].bounds.overlaps(pieces[b].bounds, touch)) continue;
        pairs.emplace_back(a, b);
        if (std::isnan(cost[a * n + b])) unknown.emplace_back(a, b);
      }
    }
    in_parallel(unknown.size(), [&](std::size_t i) {
      const auto [a, b] = unknown[i];
      const Piece both = merged(pieces[a], pieces[b]);
      cost[a * n + b] = both.hull.empty() ? 0.0 : protrusion(both.hull).first;
    });
    double best = never;
    std::size_t best_a = 0, best_b = 0;
    double best_size = 0;
    for (const auto& [a, b] : pairs) {
      // Equal costs (most are zero at first): the smaller piece first, which keeps pieces compact.
      const double size = (pieces[a].bounds.diagonal() + pieces[b].bounds.diagonal());
      const double rounded = std::max(cost[a * n + b], 0.1 * limit);
      if (rounded < best || (rounded == best && size < best_size)) {
        best = rounded;
        best_size = size;
        best_a = a;
        best_b = b;
      }
    }
    if (best == never || (best > limit && count <= static_cast<std::size_t>(max_pieces))) break;
    pieces[best_a] = merged(pieces[best_a], pieces[best_b]);
    alive[best_b] = 0;
    --count;
    for (std::size_t i = 0; i < n; ++i) cost[std::min(i, best_a) * n + std::max(i, best_a)] = std::nan("");
  }
  std::vector<Piece> left;
  for (std::size_t i = 0; i < n; ++i) {
    if (alive[i]) left.push_back(std::move(pieces[i]));
  }
  BIN_SCENES_ASSERT(left.size() == count);
  return left;
}

/// Round holes wider than the surface error that is allowed: parts that fit into them must fit between the hulls.
std::vector<RoundHole> wide_holes(const MeshQuery& query, double allowed) {
  std::vector<RoundHole> holes = round_holes(query);
  const auto narrow = [&](const RoundHole& hole) { return hole.radius < allowed; };
  holes.erase(std::remove_if(holes.begin(), holes.end(), narrow), holes.end());
  return holes;
}

/// Hulls that stay out of holes, of each as far as they are then not too many.
std::vector<Mesh> cleared(std::vector<Mesh> hulls, const std::vector<RoundHole>& holes, double loss, int most) {
  for (const RoundHole& hole : holes) {
    std::vector<Mesh> clear = cleared(hulls, hole, loss);
    if (!clear.empty() && clear.size() <= std::max(static_cast<std::size_t>(most), hulls.size()))
      hulls = std::move(clear);
  }
  return hulls;
}

Mesh whole_hull(const Mesh& mesh, const HullOptions& options) {
  Mesh whole = convex_hull(mesh.vertices, options.max_vertices);
  if (whole.empty())
    throw input_error("all vertices lie in one plane", "convex_hulls", "give a closed mesh with a volume");
  return whole;
}

void check_options(const HullOptions& options) {
  if (options.max_hulls < 1 || options.max_vertices < 4 || !(options.max_error > 0) ||
      !(options.max_volume_error > 0)) {
    throw input_error("hull options out of range", "HullOptions",
                      "use max_hulls >= 1, max_vertices >= 4 and errors > 0");
  }
}

}  // namespace

ConvexHulls convex_hulls(const MeshQuery& query, const HullOptions& options) {
  const Mesh& mesh = query.mesh();
  if (mesh.empty()) throw input_error("a mesh without triangles has no hull", "convex_hulls", "give a closed mesh");
  check_options(options);
  const double volume = mass_properties(mesh).volume;
  ConvexHulls best;
  double excess = std::numeric_limits<double>::infinity();  // its larger error / what is allowed
  // Keeps hulls that are better than the best so far.
  const double allowed = options.max_error * mesh.bounds().diagonal();
  const std::vector<RoundHole> holes = wide_holes(query, allowed);
  const auto judge = [&](std::vector<Mesh> hulls, const Protrusion* protrusion) {
    hulls = cleared(std::move(hulls), holes, hole_loss * allowed, options.max_hulls);
    const double surface = surface_error(hulls, query, protrusion);
    const double volume_error = volume > 0 ? union_volume(hulls) / volume - 1 : 0.0;
    const double found = std::max(surface / options.max_error, volume_error / options.max_volume_error);
    BIN_SCENES_ASSERT(surface >= 0.0 && std::isfinite(volume_error));
    if (found >= excess) return;
    excess = found;
    best = {std::move(hulls), surface, volume_error, found <= 1};
  };
  judge({whole_hull(mesh, options)}, nullptr);
  // Cutting a convex part helps nothing: a round one needs more vertices instead.
  if (!best.met && mass_properties(convex_hull(mesh.vertices, all_vertices)).volume < (1 + convex_enough) * volume) {
    for (int more = 2; more <= most_more && !best.met; more *= 2) {
      judge({convex_hull(mesh.vertices, more * options.max_vertices)}, nullptr);
    }
  }
  // Each shell is a piece at least: of far more than may be kept, merging would choose between millions of pairs.
  const std::size_t most_pieces = static_cast<std::size_t>(spare) * static_cast<std::size_t>(options.max_hulls);
  if (!best.met && options.max_hulls > 1 && shells_of(mesh).count <= most_pieces) {
    const double diagonal = mesh.bounds().diagonal();
    const Protrusion protrusion(query);
    const SolidMeasure measure{protrusion, [&](const Vec3& p) { return protrusion.inside(p); }};
    // The hulls of the pieces, merged and with few vertices; returns how many.
    const auto try_pieces = [&](const std::vector<std::vector<Vec3>>& pieces, double limit) {
      std::vector<Mesh> hulls;
      for (const Piece& piece : merge(pieces, protrusion, limit, 1e-3 * diagonal, options.max_hulls)) {
        Mesh hull = convex_hull(piece.points, options.max_vertices);
        if (!hull.empty()) hulls.push_back(std::move(hull));
      }
      const int count = static_cast<int>(hulls.size());
      if (count > 0) judge(std::move(hulls), &protrusion);
      return count;
    };
    double limit = first_limit * options.max_error * diagonal;
    for (int i = 0; i < tries; ++i) {
      const int count = try_pieces(plane_cut_pieces(mesh, measure, limit, static_cast<int>(most_pieces)), limit);
      // More pieces than may be kept do not help.
      if (best.met || count >= options.max_hulls) break;
      // What sticks out adds to the volume in proportion.
      limit *= std::clamp(0.9 / excess, 0.3, 2.0 / 3.0);
    }
    if (best.surface_error > options.max_error)
      try_pieces(hacd_patches(mesh, patches), first_limit * options.max_error * diagonal);
  }
  BIN_SCENES_ASSERT(!best.hulls.empty() && each_is(best.hulls, indices_in_range));
  BIN_SCENES_ASSERT(best.met == (excess <= 1));
  return best;
}

ConvexHulls convex_hulls(const Mesh& mesh, const HullOptions& options) {
  return convex_hulls(MeshQuery(mesh), options);
}

void write_hulls_obj(const ConvexHulls& hulls, const std::string& path) {
  std::string text = "# convex hulls, metres\n";
  std::size_t first = 1;
  for (std::size_t h = 0; h < hulls.hulls.size(); ++h) {
    const Mesh& hull = hulls.hulls[h];
    text += "o hull_" + std::to_string(h) + "\n";
    for (const Vec3& v : hull.vertices) text += formatted("v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
    for (const auto& [a, b, c] : hull.triangles) text += formatted("f %zu %zu %zu\n", first + a, first + b, first + c);
    first += hull.vertices.size();
  }
  // Under another name first, so that no half of it is left.
  const std::string unfinished = path + ".unfinished";
  std::ofstream file(unfinished, std::ios::binary);
  file << text;
  file.close();
  std::error_code failed;
  if (file) std::filesystem::rename(unfinished, path, failed);
  if (file && !failed) return;
  std::filesystem::remove(unfinished, failed);
  throw environment_error("cannot write the hulls", path, "check the folder and the space left");
}

}  // namespace bin_scenes
