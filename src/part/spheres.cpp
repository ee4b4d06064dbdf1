/// Voxels whose centre is inside become spheres, but for those in the interior, which touch nothing. Where the surface
/// is flat a sphere keeps its normal.
#include "bin_scenes/part/spheres.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/mesh_query.hpp"
#include "triangle.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace bin_scenes {
namespace {

// A sphere lies on a face if the surface near it turns by less than this (cosine of 37 degrees).
constexpr double flat_limit = 0.8;
// How far "near it" is, in radii: reaches the second face at an edge, not the next sphere's.
constexpr double near_limit = 1.5;

constexpr std::size_t max_voxels = 256u << 20;

/// Spheres of one radius on a regular lattice whose outermost spheres touch the bounding box from inside.
struct Lattice {
  Vec3 first;  // centre of voxel (0, 0, 0)
  double pitch, radius;
  std::array<int, 3> count;

  Lattice(const Aabb& box, double pitch_, double radius_) : pitch(pitch_), radius(radius_) {
    double total = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = (box.size()[axis] - 2 * radius) / pitch;
      total *= std::max(1.0, std::ceil(cells) + 1);
    }
    if (!(total <= static_cast<double>(max_voxels))) {
      throw input_error("a voxel grid of " + std::to_string(total) + " cells", "VoxelOptions",
                        "use fewer voxels or larger radii");
    }
    for (int axis = 0; axis < 3; ++axis) {
      // Rounding must not add a layer to a side that is a whole number of voxels.
      count[axis] = 1 + std::max(0, static_cast<int>(std::ceil((box.size()[axis] - 2 * radius) / pitch - 1e-6)));
    }
    first = box.center() - 0.5 * pitch * Vec3(count[0] - 1, count[1] - 1, count[2] - 1);
  }

  std::size_t size() const { return static_cast<std::size_t>(count[0]) * count[1] * count[2]; }
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           count[0] * (static_cast<std::size_t>(y) + static_cast<std::size_t>(count[1]) * z);
  }
  Vec3 center(int x, int y, int z) const { return first + pitch * Vec3(x, y, z); }
  bool holds(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < count[0] && y < count[1] && z < count[2];
  }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (int z = 0; z < count[2]; ++z)
      for (int y = 0; y < count[1]; ++y)
        for (int x = 0; x < count[0]; ++x) visit(x, y, z);
  }
};

/// Outward normal of the surface at a sphere if it is flat there, else zero.
Vec3 face_normal(const MeshQuery& query, const std::vector<PreparedTriangle>& triangles, const Vec3& center,
                 double reach) {
  const NearestPoint nearest = query.nearest(center, reach);
  if (!(nearest.distance <= reach)) return Vec3::Zero();
  const Vec3 normal = triangles[nearest.triangle].normal;
  bool flat = !normal.isZero();
  query.overlapping({center - Vec3::Constant(reach), center + Vec3::Constant(reach)}, [&](std::size_t t) {
    const PreparedTriangle& triangle = triangles[t];
    flat = flat && (triangle.normal.isZero() || triangle.normal.dot(normal) > flat_limit ||
                    (triangle.nearest(center) - center).norm() > reach);
  });
  return flat ? normal : Vec3::Zero();
}

/// Fills voxels whose centre is inside; then, where the part is thinner than a voxel, those its surface lies in.
std::vector<std::uint8_t> fill(const MeshQuery& query, const Lattice& lattice) {
  std::vector<std::uint8_t> filled(lattice.size(), 0);
  lattice.for_each(
      [&](int x, int y, int z) { filled[lattice.index(x, y, z)] = query.inside(lattice.center(x, y, z)); });

  // Every surface point should have a filled voxel within half a voxel's diagonal.
  const double near = 0.5 * std::sqrt(3.0) * lattice.pitch;
  const auto cover = [&](const Vec3& point) {
    const Vec3 place = (point - lattice.first) / lattice.pitch;
    std::array<int, 3> own;
    for (int axis = 0; axis < 3; ++axis) {
      own[axis] = std::clamp(static_cast<int>(std::lround(place[axis])), 0, lattice.count[axis] - 1);
    }
    for (int z = own[2] - 1; z <= own[2] + 1; ++z)
      for (int y = own[1] - 1; y <= own[1] + 1; ++y)
        for (int x = own[0] - 1; x <= own[0] + 1; ++x) {
          if (!lattice.holds(x, y, z) || !filled[lattice.index(x, y, z)]) continue;
          if ((lattice.center(x, y, z) - point).norm() <= near) return;
        }
    filled[lattice.index(own[0], own[1], own[2])] = 1;
  };
  // Points of each triangle at half a pitch, a hair below the surface so that a face between two voxels picks its own.
  const Mesh& mesh = query.mesh();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 &a = mesh.vertices[mesh.triangles[t][0]], &b = mesh.vertices[mesh.triangles[t][1]],
               &c = mesh.vertices[mesh.triangles[t][2]];
    const Vec3 below = -1e-6 * lattice.pitch * mesh.area_vector(t).normalized();
    const double longest = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const int steps = 1 + static_cast<int>(longest / (0.5 * lattice.pitch));
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) cover(a + (b - a) * i / steps + (c - a) * j / steps + below);
  }
  return filled;
}

bool interior(const std::vector<std::uint8_t>& filled, const Lattice& lattice, int x, int y, int z) {
  const auto has = [&](int i, int j, int k) { return lattice.holds(i, j, k) && filled[lattice.index(i, j, k)]; };
  return has(x - 1, y, z) && has(x + 1, y, z) && has(x, y - 1, z) && has(x, y + 1, z) && has(x, y, z - 1) &&
         has(x, y, z + 1);
}

bool inside_of_one(const std::vector<Sphere>& spheres, std::size_t count, const Sphere& sphere) {
  return std::any_of(spheres.begin(), spheres.begin() + count, [&](const Sphere& big) {
    return (big.center - sphere.center).norm() + sphere.radius <= big.radius * (1 + 1e-9);
  });
}

/// Spheres of one large radius wherever they fit into the part and their centre is not inside a larger one.
void add_large(const MeshQuery& query, const Lattice& lattice, SphereSet& set) {
  const std::size_t larger = set.spheres.size();
  lattice.for_each([&](int x, int y, int z) {
    const Vec3 center = lattice.center(x, y, z);
    for (std::size_t i = 0; i < larger; ++i) {
      if ((set.spheres[i].center - center).norm() < set.spheres[i].radius) return;
    }
    if (query.nearest(center, lattice.radius * (1 - 1e-6)).distance < lattice.radius * (1 - 1e-6)) return;
    if (query.inside(center)) set.spheres.push_back({center, lattice.radius, Vec3::Zero()});
  });
}

void add_voxels(const MeshQuery& query, const Lattice& lattice, bool keep_interior, SphereSet& set) {
  const std::size_t larger = set.spheres.size();
  const std::vector<std::uint8_t> filled = fill(query, lattice);
  lattice.for_each([&](int x, int y, int z) {
    if (!filled[lattice.index(x, y, z)]) return;
    const Sphere sphere{lattice.center(x, y, z), lattice.radius, Vec3::Zero()};
    if (!keep_interior && (interior(filled, lattice, x, y, z) || inside_of_one(set.spheres, larger, sphere))) {
      ++set.interior_removed;
      return;
    }
    set.spheres.push_back(sphere);
  });
}

}  // namespace

SphereSet voxel_spheres(const MeshQuery& query, const VoxelOptions& options) {
  const Aabb box = query.mesh().bounds();
  const double longest = query.mesh().empty() ? 0.0 : box.size().maxCoeff();
  if (!(longest > 0)) {
    throw input_error("a mesh without surface has no voxels", "voxel_spheres", "give a closed mesh");
  }
  if (options.voxels < 1 || !(options.tightness > 0.05) || options.tightness > 1.0) {
    throw input_error(std::to_string(options.voxels) + " voxels of tightness " + std::to_string(options.tightness),
                      "VoxelOptions", "use at least 1 voxel and a tightness above 0.05, at most 1");
  }
  std::vector<double> radii = options.radii;
  if (radii.empty()) {
    const double pitch = longest / (options.voxels - 1 + 1 / options.tightness);
    radii = {0.5 * pitch / options.tightness};
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (!(radii[i] > 0) || (i > 0 && radii[i] >= radii[i - 1])) {
      throw input_error("radius " + std::to_string(radii[i]) + " m out of order", "VoxelOptions.radii",
                        "give radii above 0, largest first");
    }
  }
  SphereSet set;
  for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
    add_large(query, Lattice(box, 2 * radii[i] * options.tightness, radii[i]), set);
  }
  set.pitch = 2 * radii.back() * options.tightness;
  add_voxels(query, Lattice(box, set.pitch, radii.back()), options.keep_interior, set);

  BIN_SCENES_ASSERT(set.pitch > 0.0);
  BIN_SCENES_ASSERT(each_is(set.spheres, [](const Sphere& s) { return s.center.allFinite() && s.radius > 0.0; }));
  const Mesh& mesh = query.mesh();
  std::vector<PreparedTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.emplace_back(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  }
  for (Sphere& sphere : set.spheres) {
    sphere.normal = face_normal(query, triangles, sphere.center, near_limit * sphere.radius);
  }
  return set;
}

SphereSet voxel_spheres(const Mesh& mesh, const VoxelOptions& options) {
  return voxel_spheres(MeshQuery(mesh), options);
}

}  // namespace bin_scenes
