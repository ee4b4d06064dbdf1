#include "raster/scenery_tree.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "raster/fronts.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace bin_scenes {

RTCDevice embree_device() {
  static const RTCDevice shared = rtcNewDevice(__builtin_cpu_supports("avx2") ? "isa=avx2" : "isa=sse4.2");
  if (!shared) throw environment_error("Embree gives no device", "sensors", "use a processor with SSE 4.2");
  return shared;
}

void commit(RTCScene scene) {
  tbb::task_arena alone(1);
  alone.execute([&] { rtcCommitScene(scene); });
}

namespace {

/// @param normals  at the corners
SmoothNormals between(const Vec3& a, const Vec3& b, const Vec3& c, const std::array<Vec3, 3>& normals) {
  const Vec3 ab = b - a, ac = c - a, twice = ab.cross(ac);
  const double all = twice.squaredNorm();
  if (!(all > 0.0)) return {};
  // Shares of b and c at a point grow along the plane across the edge on the other side.
  const Vec3 of_b = ac.cross(twice) / all, of_c = twice.cross(ab) / all;
  SmoothNormals smooth;
  smooth.slope = (normals[1] - normals[0]) * of_b.transpose() + (normals[2] - normals[0]) * of_c.transpose();
  smooth.at_origin = normals[0] - smooth.slope * a;
  smooth.even = false;
  return smooth;
}

std::vector<SmoothNormals> smooth_normals_of(const Mesh& mesh) {
  const double in_line = std::cos(35.0 * M_PI / 180.0);
  std::vector<std::vector<std::uint32_t>> around(mesh.vertices.size());
  std::vector<Vec3> areas;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t vertex : mesh.triangles[t]) around[vertex].push_back(t);
    areas.push_back(mesh.area_vector(t));
  }
  std::vector<SmoothNormals> smooth(mesh.triangles.size());
  for (std::size_t t = 0; t < smooth.size(); ++t) {
    const Vec3 own = areas[t].normalized();
    const Triangle& corners = mesh.triangles[t];
    std::array<Vec3, 3> normals;
    bool even = true;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 sum = Vec3::Zero();
      for (const std::uint32_t other : around[corners[k]])
        if (areas[other].dot(own) >= in_line * areas[other].norm()) sum += areas[other];
      normals[k] = sum.norm() > 0.0 ? Vec3(sum.normalized()) : own;
      even = even && normals[k].dot(own) > 1.0 - 1e-9;
    }
    if (!even)
      smooth[t] = between(mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]], normals);
  }
  return smooth;
}

}  // namespace

MeshTree::MeshTree(PartModelPtr model, Mesh alone) : owner(std::move(model)), own(std::move(alone)) {
  embree = rtcNewScene(embree_device());
  rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
  const Mesh& m = mesh();
  BIN_SCENES_ASSERT(indices_in_range(m));
  const RTCGeometry geometry = rtcNewGeometry(embree_device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corners = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                              3 * sizeof(float), m.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), m.triangles.size()));
  if (!corners || !indices) {
    throw environment_error("no memory for the triangles of a mesh", "sensors", "free memory, or use coarser meshes");
  }
  for (const Vec3& v : m.vertices) {
    for (int k = 0; k < 3; ++k) *corners++ = static_cast<float>(v[k]);
  }
  planes.reserve(m.triangles.size());
  for (const Triangle& t : m.triangles) {
    indices = std::copy(t.begin(), t.end(), indices);
    const Vec3& a = m.vertices[t[0]];
    const Vec3 normal = (m.vertices[t[1]] - a).cross(m.vertices[t[2]] - a).normalized();
    planes.push_back({normal, normal.dot(a)});
  }
  closed = shows_fronts_only(m);
  outermost = outermost_triangles(m);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(embree, geometry);
  rtcReleaseGeometry(geometry);
  commit(embree);
}

const std::vector<SmoothNormals>& MeshTree::smooth_normals() const {
  std::call_once(once_, [this] { smooth_ = smooth_normals_of(mesh()); });
  return smooth_;
}

}  // namespace bin_scenes
