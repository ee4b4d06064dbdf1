#include "bin_scenes/part/convex_hulls.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "bin_scenes/part/shape_error.hpp"
#include "hacd_partition.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace bin_scenes {
namespace {

// Patches of HACD to merge from.
constexpr int kFewPatches = 16, kManyPatches = 128;

/// Largest distance from the outer surface of the hulls to the mesh, / diagonal.
double surface_error(const std::vector<Mesh>& hulls, const MeshQuery& query) {
  const double diagonal = query.mesh().bounds().diagonal();
  std::vector<HullPlanes> planes;
  for (const Mesh& hull : hulls) planes.emplace_back(hull);
  double worst = 0;
  for (std::size_t h = 0; h < hulls.size(); ++h) {
    for (const SurfacePoint& s : dense_surface_points(hulls[h], 0.015 * diagonal)) {
      bool covered = false;
      for (std::size_t other = 0; other < hulls.size() && !covered; ++other) {
        covered = other != h && planes[other].covers(s.point, s.normal, 1e-4 * diagonal);
      }
      // Only points further off than the worst so far matter: a point has to be looked up only if none is that near.
      if (covered || query.nearest(s.point, worst).distance <= worst) continue;
      worst = query.nearest(s.point).distance;
    }
  }
  return worst / diagonal;
}

/// A piece of the part on its way to a hull.
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

/// How far a hull sticks out of the mesh (m); looks no further once it is more than `enough`. A point is outside if it
/// lies before its nearest triangle.
double protrusion(const Mesh& hull, const MeshQuery& query, double step, double enough) {
  double worst = 0;
  for (const SurfacePoint& s : dense_surface_points(hull, step)) {
    if (worst > enough) break;
    if (query.nearest(s.point, worst).distance <= worst) continue;
    const NearestPoint nearest = query.nearest(s.point);
    if ((s.point - nearest.point).dot(query.mesh().area_vector(nearest.triangle)) > 0) worst = nearest.distance;
  }
  return worst;
}

/// Merges the pair whose common hull sticks out least, until no pair stays below the limit and few enough are left.
/// HACD's own measure of concavity is looser, and its hulls of surface patches are hollow: merging by the measured
/// protrusion lets opposite sides grow together and ends at the fewest pieces the goal allows.
std::vector<Piece> merge(std::vector<Piece> pieces, const MeshQuery& query, double limit, int max_pieces) {
  const double step = 0.03 * query.mesh().bounds().diagonal();
  const double touch = 1e-3 * query.mesh().bounds().diagonal();
  constexpr std::size_t kAllPairs = 16;  // so few that pieces which do not touch are tried, too
  // Costs above the limit matter only while there are more pieces than allowed.
  const double enough = pieces.size() > static_cast<std::size_t>(max_pieces) ? 8 * limit : limit;
  const double never = std::numeric_limits<double>::infinity();
  // cost[a][b], a < b; NaN = not asked yet
  const std::size_t n = pieces.size();
  std::vector<double> cost(n * n, std::nan(""));
  std::vector<std::uint8_t> alive(n, 1);
  std::size_t count = n;
  for (;;) {
    double best = never;
    std::size_t best_a = 0, best_b = 0;
    double best_size = 0;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        if (!alive[a] || !alive[b]) continue;
        if (count > kAllPairs && !pieces[a].bounds.overlaps(pieces[b].bounds, touch)) continue;
        if (std::isnan(cost[a * n + b])) {
          const Piece both = merged(pieces[a], pieces[b]);
          cost[a * n + b] = both.hull.empty() ? 0.0 : protrusion(both.hull, query, step, enough);
        }
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
  return left;
}

}  // namespace

ConvexHulls convex_hulls(const MeshQuery& query, const HullOptions& options) {
  const Mesh& mesh = query.mesh();
  if (mesh.empty()) throw input_error("a mesh without triangles has no hull", "convex_hulls", "give a closed mesh");
  if (options.max_hulls < 1 || options.max_vertices < 4 || !(options.max_error > 0)) {
    throw input_error("hull options out of range", "HullOptions",
                      "use max_hulls >= 1, max_vertices >= 4 and max_error > 0");
  }
  ConvexHulls best;
  best.hulls = {convex_hull(mesh.vertices, options.max_vertices)};
  if (best.hulls[0].empty()) {
    throw input_error("all vertices lie in one plane", "convex_hulls", "give a closed mesh with a volume");
  }
  best.surface_error = surface_error(best.hulls, query);
  if (best.surface_error > options.max_error && options.max_hulls > 1) {
    // Few patches first; more, which cost more, only where they do not meet the goal.
    for (int patches = 2 * kFewPatches; patches <= kManyPatches; patches *= 2) {
      std::vector<Piece> pieces;
      for (std::vector<Vec3>& points : hacd_patches(mesh, patches)) pieces.push_back(piece_of(std::move(points)));
      pieces = merge(std::move(pieces), query, 0.8 * options.max_error * mesh.bounds().diagonal(), options.max_hulls);
      std::vector<Mesh> hulls;
      for (const Piece& piece : pieces) {
        Mesh hull = convex_hull(piece.points, options.max_vertices);
        if (!hull.empty()) hulls.push_back(std::move(hull));
      }
      const double error = hulls.empty() ? 1.0 : surface_error(hulls, query);
      if (error < best.surface_error) {
        best.hulls = std::move(hulls);
        best.surface_error = error;
      }
      if (best.surface_error <= options.max_error) break;
    }
  }
  best.met = best.surface_error <= options.max_error;
  const double volume = mass_properties(mesh).volume;
  best.volume_error = volume > 0 ? union_volume(best.hulls) / volume - 1 : 0.0;
  return best;
}

ConvexHulls convex_hulls(const Mesh& mesh, const HullOptions& options) {
  return convex_hulls(MeshQuery(mesh), options);
}

void write_hulls_obj(const ConvexHulls& hulls, const std::string& path) {
  std::string text = "# convex hulls, metres\n";
  char line[128];
  std::size_t first = 1;
  for (std::size_t h = 0; h < hulls.hulls.size(); ++h) {
    const Mesh& hull = hulls.hulls[h];
    text += "o hull_" + std::to_string(h) + "\n";
    for (const Vec3& v : hull.vertices) {
      std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
      text += line;
    }
    for (const auto& [a, b, c] : hull.triangles) {
      std::snprintf(line, sizeof line, "f %zu %zu %zu\n", first + a, first + b, first + c);
      text += line;
    }
    first += hull.vertices.size();
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw environment_error("cannot write the hulls", path, "check the folder and the space left");
}

}  // namespace bin_scenes
