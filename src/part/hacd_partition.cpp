/// Cuts long edges, thins the mesh and runs HACD on each shell, in a child process where it may crash. Clusters are
/// carried back to the triangles of the fine mesh.
#include "hacd_partition.hpp"

#include "shells.hpp"

#include "bin_scenes/part/hull_geometry.hpp"
#include "mesh/contained.hpp"

#include <HACD/hacdHACD.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <tuple>

namespace bin_scenes {
namespace {

// Work of HACD is bounded by the triangles it gets (0.5 to 1 s for a run of 700).
constexpr std::size_t max_triangles = 700;
// Triangles longer than this / diagonal are cut, because a patch can only end at a triangle's edge.
constexpr double longest_edge = 0.12;

/// One shell, cut and thinned. `source` gives for every vertex of the fine mesh the vertex of the thinned one.
struct Thinned {
  Mesh mesh;
  std::vector<std::uint32_t> source;
};

std::vector<Mesh> shells(const Mesh& mesh) {
  const Shells labels = shells_of(mesh);
  std::vector<Mesh> result(labels.count);
  std::vector<std::int64_t> renamed(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Mesh& shell = result[labels.of_triangle[t]];
    Triangle local;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if (renamed[v] < 0) {
        renamed[v] = static_cast<std::int64_t>(shell.vertices.size());
        shell.vertices.push_back(mesh.vertices[v]);
      }
      local[k] = static_cast<std::uint32_t>(renamed[v]);
    }
    shell.triangles.push_back(local);
  }
  return result;
}

/// Halves every edge longer than `longest`, in all triangles at once so that no gap opens.
Mesh cut(Mesh mesh, double longest) {
  for (int round = 0; round < 6 && mesh.triangles.size() < 4 * max_triangles; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> centers;
    const auto center = [&](std::uint32_t a, std::uint32_t b) -> std::int64_t {
      if ((mesh.vertices[a] - mesh.vertices[b]).norm() <= longest) return -1;
      const auto [entry, added] =
          centers.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : mesh.triangles) {
      // Corners and cut edges in turn form a polygon of 3 to 6 points; ears between two cuts come off first.
      std::array<std::int64_t, 3> cuts;
      for (int k = 0; k < 3; ++k) cuts[k] = center(t[k], t[(k + 1) % 3]);
      std::vector<std::uint32_t> polygon;
      for (int k = 0; k < 3; ++k) {
        const std::int64_t before = cuts[(k + 2) % 3], after = cuts[k];
        if (before >= 0 && after >= 0) {
          finer.push_back({t[k], static_cast<std::uint32_t>(after), static_cast<std::uint32_t>(before)});
        } else {
          polygon.push_back(t[k]);
        }
        if (after >= 0) polygon.push_back(static_cast<std::uint32_t>(after));
      }
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) finer.push_back({polygon[0], polygon[k], polygon[k + 1]});
    }
    mesh.triangles = finer;
    if (centers.empty()) break;
  }
  return mesh;
}

/// Vertex clustering (Rossignac & Borrel 1993) with growing cells until few triangles are left. The sharpest vertex
/// stands for a cell, so that corners stay.
Thinned thin(const Mesh& mesh) {
  Thinned result;
  std::vector<Vec3> sum(mesh.vertices.size(), Vec3::Zero());
  std::vector<double> area(mesh.vertices.size(), 0.0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.area_vector(t);
    for (const std::uint32_t v : mesh.triangles[t]) sum[v] += a, area[v] += a.norm();
  }
  const auto flatness = [&](std::uint32_t v) { return area[v] > 0 ? sum[v].norm() / area[v] : 1.0; };
  const Aabb box = mesh.bounds();
  for (double cell = 1e-4 * box.diagonal();; cell *= 1.3) {
    std::map<std::tuple<int, int, int>, std::uint32_t> cells;
    std::vector<std::uint32_t> chosen(mesh.vertices.size());
    const auto key = [&](std::uint32_t v) {
      const Vec3 place = (mesh.vertices[v] - box.lower) / cell;
      return std::make_tuple(static_cast<int>(place.x()), static_cast<int>(place.y()), static_cast<int>(place.z()));
    };
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const auto [entry, added] = cells.try_emplace(key(v), v);
      if (!added && flatness(v) < flatness(entry->second) - 1e-9) entry->second = v;
    }
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) chosen[v] = cells[key(v)];
    std::map<Triangle, int> kept;  // by sorted corners: a pair of coincident triangles would break HACD's graph
    result = {};
    for (const Triangle& t : mesh.triangles) {
      const Triangle moved{chosen[t[0]], chosen[t[1]], chosen[t[2]]};
      if (moved[0] == moved[1] || moved[1] == moved[2] || moved[2] == moved[0]) continue;
      Triangle sorted = moved;
      std::sort(sorted.begin(), sorted.end());
      if (kept.emplace(sorted, 0).second) result.mesh.triangles.push_back(moved);
    }
    result.source = chosen;
    if (result.mesh.triangles.size() <= max_triangles) break;
    if (cell < 1e-3 * box.diagonal()) cell = std::max(cell, box.diagonal() / 60);
  }
  // Number the vertices that are still used.
  std::vector<std::int64_t> renamed(mesh.vertices.size(), -1);
  for (Triangle& t : result.mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (renamed[v] < 0) {
        renamed[v] = static_cast<std::int64_t>(result.mesh.vertices.size());
        result.mesh.vertices.push_back(mesh.vertices[v]);
      }
      v = static_cast<std::uint32_t>(renamed[v]);
    }
  }
  for (std::uint32_t& v : result.source) v = renamed[v] < 0 ? 0xffffffffu : static_cast<std::uint32_t>(renamed[v]);
  return result;
}

/// HACD's cluster of every triangle; empty if HACD gives up.
std::vector<long> clusters(const Mesh& mesh, int count) {
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const Vec3& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetCompacityWeight(1e-4);
  hacd.SetVolumeWeight(0.0);
  hacd.SetConnectDist(0.0);
  hacd.SetNClusters(static_cast<std::size_t>(count));
  hacd.SetNVerticesPerCH(64);
  hacd.SetConcavity(1e9);  // the count alone ends the merging
  hacd.SetAddFacesPoints(true);
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(true);
  if (!hacd.Compute() || hacd.GetPartition() == nullptr) return {};
  return {hacd.GetPartition(), hacd.GetPartition() + triangles.size()};
}

/// The same in a child: HACD crashes on some meshes of many shells.
std::vector<long> run_hacd(const Mesh& mesh, int count) {
  ContainedLimits limits;
  limits.cpu_seconds = 30;  // thirty times what it takes
  limits.bytes = std::size_t{1} << 30;
  const Contained child = run_contained(
      [&] {
        const std::vector<long> found = clusters(mesh, count);
        return std::string(reinterpret_cast<const char*>(found.data()), found.size() * sizeof(long));
      },
      limits);
  if (!child.finished || child.output.size() != mesh.triangles.size() * sizeof(long)) return {};
  std::vector<long> found(mesh.triangles.size());
  std::memcpy(found.data(), child.output.data(), child.output.size());
  return found;
}

double signed_volume(const Mesh& mesh) {
  double six = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    six += mesh.area_vector(t).dot(mesh.vertices[mesh.triangles[t][0]] - mesh.vertices[0]);
  }
  return six / 6;
}

bool is_convex(const Mesh& shell) {
  const Mesh hull = convex_hull(shell.vertices, std::numeric_limits<int>::max());
  return !hull.empty() && signed_volume(hull) < (1 + 1e-4) * signed_volume(shell);
}

void add_patches(const Mesh& shell, int count, std::vector<std::vector<Vec3>>& patches) {
  if (is_convex(shell)) {
    patches.push_back(shell.vertices);
    return;
  }
  const Mesh fine = cut(shell, longest_edge * shell.bounds().diagonal());
  const Thinned thinned = thin(fine);
  std::vector<long> cluster;
  const int wanted = std::min(count, static_cast<int>(thinned.mesh.triangles.size() / 4));
  if (wanted > 1) cluster = run_hacd(thinned.mesh, wanted);
  if (cluster.empty()) {
    patches.push_back(shell.vertices);
    return;
  }
  // Vertices of a triangle that survived go to its cluster; those of one that vanished go where its place went.
  std::map<Triangle, long> of_triangle;
  std::vector<long> of_vertex(thinned.mesh.vertices.size(), 0);
  for (std::size_t t = 0; t < thinned.mesh.triangles.size(); ++t) {
    Triangle sorted = thinned.mesh.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    of_triangle[sorted] = cluster[t];
    for (const std::uint32_t v : sorted) of_vertex[v] = cluster[t];
  }
  std::map<long, std::vector<std::uint32_t>> members;
  for (const Triangle& t : fine.triangles) {
    Triangle moved{thinned.source[t[0]], thinned.source[t[1]], thinned.source[t[2]]};
    std::sort(moved.begin(), moved.end());
    const auto found = of_triangle.find(moved);
    long home = 0;
    if (found != of_triangle.end()) {
      home = found->second;
    } else if (moved[0] < of_vertex.size()) {
      home = of_vertex[moved[0]];
    }
    members[home].insert(members[home].end(), t.begin(), t.end());
  }
  for (auto& [id, vertices] : members) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vec3> points;
    for (const std::uint32_t v : vertices) points.push_back(fine.vertices[v]);
    patches.push_back(std::move(points));
  }
}

}  // namespace

std::vector<std::vector<Vec3>> hacd_patches(const Mesh& mesh, int count) {
  std::vector<Mesh> solid;
  for (Mesh& shell : shells(mesh)) {
    if (signed_volume(shell) > 0) solid.push_back(std::move(shell));
  }
  double total = 0;
  for (const Mesh& shell : solid) total += shell.bounds().diagonal();
  std::vector<std::vector<Vec3>> patches;
  for (const Mesh& shell : solid) {
    add_patches(shell, std::max(4, static_cast<int>(count * shell.bounds().diagonal() / total)), patches);
  }
  return patches;
}

}  // namespace bin_scenes
