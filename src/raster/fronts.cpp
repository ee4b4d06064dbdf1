#include "raster/fronts.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace bin_scenes {

namespace {

/// Each edge is passed equally often in both directions.
bool closed(const Mesh& mesh) {
  std::vector<std::uint64_t> there, back;
  there.reserve(3 * mesh.triangles.size());
  back.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[(k + 1) % 3];
      there.push_back(a << 32 | b);
      back.push_back(b << 32 | a);
    }
  }
  std::sort(there.begin(), there.end());
  std::sort(back.begin(), back.end());
  return there == back;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t vertex) {
  while (parents[vertex] != vertex) vertex = parents[vertex] = parents[parents[vertex]];
  return vertex;
}

/// A shell turned inside out, as that of a cavity is, has a negative volume.
bool all_face_outward(const Mesh& mesh) {
  std::vector<std::uint32_t> parents(mesh.vertices.size());
  std::iota(parents.begin(), parents.end(), 0u);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t vertex : {t[1], t[2]}) parents[root_of(parents, vertex)] = root_of(parents, t[0]);
  }
  std::vector<double> volumes(mesh.vertices.size(), 0.0);
  for (const Triangle& t : mesh.triangles) {
    volumes[root_of(parents, t[0])] += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  }
  return std::all_of(volumes.begin(), volumes.end(), [](double volume) { return volume >= 0.0; });
}

}  // namespace

bool shows_fronts_only(const Mesh& mesh) {
  return closed(mesh) && all_face_outward(mesh);
}

std::vector<char> outermost_triangles(const Mesh& mesh) {
  constexpr double flat = 1e-6;  // m: less than rays begin above a surface
  constexpr double most = 2e8;   // comparisons, a second
  BIN_SCENES_ASSERT(indices_in_range(mesh));
  std::vector<char> out(mesh.triangles.size(), 0);
  double left = most;
  for (std::size_t t = 0; t < out.size() && left > 0.0; ++t) {
    const Vec3 normal = mesh.area_vector(t).normalized();
    const double offset = normal.dot(mesh.vertices[mesh.triangles[t][0]]) + flat;
    std::size_t v = 0;
    while (v < mesh.vertices.size() && normal.dot(mesh.vertices[v]) <= offset) ++v;
    out[t] = v == mesh.vertices.size() && normal.squaredNorm() > 0.5;
    left -= static_cast<double>(v);
  }
  return out;
}

}  // namespace bin_scenes
