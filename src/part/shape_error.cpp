/// Distances both ways between a shape and the mesh, at dense points, and the volume that only one of them fills. All
/// shapes share the code; each brings its own distance.
#include "bin_scenes/part/shape_error.hpp"

#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/mass_properties.hpp"
#include "core/in_parallel.hpp"

#include <algorithm>

namespace bin_scenes {
namespace {

constexpr double step_share = 0.005;  // / diagonal

/// Mean and maximum of distances, weighted.
struct Distances {
  double sum = 0, weight = 0, max = 0;

  void add(double distance, double w) {
    sum += w * distance;
    weight += w;
    max = std::max(max, distance);
  }
  void add(const Distances& o) {
    sum += o.sum;
    weight += o.weight;
    max = std::max(max, o.max);
  }
  double mean() const { return weight > 0 ? sum / weight : 0.0; }
};

/// What measure(i) returns for every i below the count, put together in order.
template <class Measure>
Distances put_together(std::size_t count, const Measure& measure) {
  std::vector<Distances> pieces(count);
  in_parallel(count, [&](std::size_t i) { pieces[i] = measure(i); });
  Distances all;
  for (const Distances& piece : pieces) all.add(piece);
  return all;
}

/// Fraction of a box that is inside, by the points of a quasi-random sequence (R3, Roberts 2018).
template <class Inside>
double volume_by_counting(const Aabb& box, int points, Inside&& inside) {
  const Vec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  int count = 0;
  for (int i = 0; i < points; ++i) {
    Vec3 place = Vec3::Constant(0.5) + i * step;
    place -= place.array().floor().matrix();
    count += inside(Vec3(box.lower + place.cwiseProduct(box.size()))) ? 1 : 0;
  }
  return box.size().prod() * count / points;
}

/// `from_mesh` asks the proxy for its distance at points of the mesh; the rest is the same for every proxy.
template <class ProxyDistance>
ShapeError errors(const MeshQuery& query, const Distances& to_mesh, double proxy_volume, ProxyDistance&& distance) {
  const double diagonal = query.mesh().bounds().diagonal();
  const std::vector<SurfacePoint> points = dense_surface_points(query.mesh(), step_share * diagonal);
  constexpr std::size_t run = 1024;
  const Distances from_mesh = put_together((points.size() + run - 1) / run, [&](std::size_t r) {
    Distances some;
    for (std::size_t i = r * run; i < std::min(points.size(), (r + 1) * run); ++i)
      some.add(std::abs(distance(points[i].point)), points[i].weight);
    return some;
  });
  const double volume = mass_properties(query.mesh()).volume;
  ShapeError error;
  error.to_mesh_mean = to_mesh.mean() / diagonal;
  error.to_mesh_max = to_mesh.max / diagonal;
  error.from_mesh_mean = from_mesh.mean() / diagonal;
  error.from_mesh_max = from_mesh.max / diagonal;
  error.volume = volume > 0 ? proxy_volume / volume - 1 : 0.0;
  return error;
}

/// Distances at places of which each is near the one before: the distance there bounds the next one, and within it no
/// surface is crossed, so that inside remains inside.
class DistanceWalk {
 public:
  explicit DistanceWalk(const MeshQuery& query) : query_(query) {
    const Aabb box = query.mesh().bounds();
    rounding_ = 1e-12 * box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs()).norm();
  }

  double go_to(const Vec3& p) {
    const double moved = (p - place_).norm();
    known_ = known_ && moved < distance_;
    // Distances are off by the rounding of places: where one vertex is come to twice, by more than the whole move.
    distance_ = query_.nearest(p, distance_ + moved + rounding_).distance;
    place_ = p;
    return distance_;
  }
  bool inside() {
    if (!known_) inside_ = query_.inside(place_);
    known_ = true;
    return inside_;
  }

 private:
  const MeshQuery& query_;
  double rounding_;  // of places, and more
  Vec3 place_ = Vec3::Zero();
  double distance_ = std::numeric_limits<double>::infinity();
  bool known_ = false, inside_ = false;
};

/// Spheres by place: which of them are near a point.
class SphereGrid {
 public:
  explicit SphereGrid(const std::vector<Sphere>& spheres) : spheres_(spheres) {
    for (const Sphere& s : spheres) {
      box_.extend(Vec3(s.center - Vec3::Constant(s.radius)));
      box_.extend(Vec3(s.center + Vec3::Constant(s.radius)));
    }
    double largest = 0;
    for (const Sphere& s : spheres) largest = std::max(largest, s.radius);
    cell_ = std::max(2 * largest, box_.size().maxCoeff() / 64);
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>(box_.size()[axis] / cell_) + 1;
    cells_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
      visit_cells(spheres[i].center, spheres[i].radius, [&](std::size_t cell) { cells_[cell].push_back(i); });
    }
  }

  const Aabb& box() const { return box_; }

  bool inside(const Vec3& p) const {
    bool found = false;
    visit_cells(p, 0.0, [&](std::size_t cell) {
      for (const std::uint32_t i : cells_[cell]) {
        found = found || (spheres_[i].center - p).norm() < spheres_[i].radius * (1 - 1e-9);
      }
    });
    return found;
  }

  /// Signed distance to the union; searches rings of cells until none can be nearer.
  double distance(const Vec3& p) const {
    double best = std::numeric_limits<double>::infinity();
    for (double reach = cell_;; reach *= 2) {
      visit_cells(p, reach, [&](std::size_t cell) {
        for (const std::uint32_t i : cells_[cell]) {
          best = std::min(best, (spheres_[i].center - p).norm() - spheres_[i].radius);
        }
      });
      if (best <= reach || reach > 4 * box_.diagonal()) return best;
    }
  }

 private:
  template <class Visit>
  void visit_cells(const Vec3& p, double reach, Visit&& visit) const {
    std::array<int, 3> lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = p[axis] - box_.lower[axis];
      lower[axis] = std::clamp(static_cast<int>((place - reach) / cell_), 0, count_[axis] - 1);
      upper[axis] = std::clamp(static_cast<int>((place + reach) / cell_), 0, count_[axis] - 1);
    }
    for (int z = lower[2]; z <= upper[2]; ++z)
      for (int y = lower[1]; y <= upper[1]; ++y)
        for (int x = lower[0]; x <= upper[0]; ++x) visit(x + count_[0] * (y + static_cast<std::size_t>(count_[1]) * z));
  }

  const std::vector<Sphere>& spheres_;
  Aabb box_;
  double cell_;
  std::array<int, 3> count_;
  std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace

// Shells within shells have more surface than anybody needs to see: a part with six times its box's has 500,000.
constexpr double most_points = 1e6;

std::vector<SurfacePoint> dense_surface_points(const Mesh& mesh, double step) {
  std::vector<SurfacePoint> points;
  double twice_area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) twice_area += mesh.area_vector(t).norm();
  step = std::max(step, std::sqrt(0.5 * twice_area / most_points));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 area = mesh.area_vector(t);
    if (!(area.norm() > 0)) continue;
    // Rows parallel to the longest side, so that slivers get few points.
    int apex = 0;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 side = mesh.vertices[mesh.triangles[t][(k + 2) % 3]] - mesh.vertices[mesh.triangles[t][(k + 1) % 3]];
      if (side.norm() > longest) longest = side.norm(), apex = k;
    }
    const Vec3& a = mesh.vertices[mesh.triangles[t][apex]];
    const Vec3 ab = mesh.vertices[mesh.triangles[t][(apex + 1) % 3]] - a;
    const Vec3 ac = mesh.vertices[mesh.triangles[t][(apex + 2) % 3]] - a;
    const int rows = 1 + static_cast<int>(area.norm() / longest / step);
    const std::size_t first = points.size();
    for (int i = 0; i <= rows; ++i) {
      const double down = static_cast<double>(i) / rows;
      const int pieces = 1 + static_cast<int>(down * longest / step);
      for (int j = 0; j <= pieces; ++j) {
        const double across = static_cast<double>(j) / pieces;
        points.push_back({a + down * ((1 - across) * ab + across * ac), area.normalized(), 0.0});
      }
    }
    const double weight = 0.5 * area.norm() / static_cast<double>(points.size() - first);
    for (std::size_t i = first; i < points.size(); ++i) points[i].weight = weight;
  }
  return points;
}

double union_volume(const std::vector<Mesh>& hulls) {
  if (hulls.size() == 1) return mass_properties(hulls[0]).volume;
  Aabb box;
  std::vector<HullPlanes> planes;
  for (const Mesh& hull : hulls) {
    box.extend(hull.bounds());
    planes.emplace_back(hull);
  }
  return volume_by_counting(box, 1 << 16, [&](const Vec3& p) {
    return std::any_of(planes.begin(), planes.end(),
                       [&](const HullPlanes& hull) { return hull.to_box(p) <= 0 && !hull.outside_by_more(p, 0); });
  });
}

ShapeError shape_error(const SphereSet& spheres, const SphereSet& whole, const MeshQuery& query) {
  // Of a sphere only the part that faces the surface within 60 degrees can touch anything: the rest is hidden by its
  // neighbours, or looks at the spheres inside that were left out.
  const SphereGrid grid(spheres.spheres), whole_grid(whole.spheres);
  const int points = std::clamp(20000 / static_cast<int>(spheres.spheres.size() + 1), 60, 4000);
  const double golden = M_PI * (3 - std::sqrt(5.0));
  const Distances to_mesh = put_together(spheres.spheres.size(), [&](std::size_t i) {
    const Sphere& s = spheres.spheres[i];
    Distances of_sphere;
    for (int k = 0; k < points; ++k) {
      const double z = 1 - (2 * k + 1.0) / points, r = std::sqrt(1 - z * z);
      const Vec3 direction(r * std::cos(golden * k), r * std::sin(golden * k), z), p = s.center + s.radius * direction;
      if (grid.inside(p)) continue;
      const NearestPoint nearest = query.nearest(p);
      if (direction.dot(query.mesh().area_vector(nearest.triangle).normalized()) < 0.5) continue;
      of_sphere.add(nearest.distance, s.radius * s.radius);
    }
    return of_sphere;
  });
  const double volume =
      volume_by_counting(whole_grid.box(), 1 << 16, [&](const Vec3& p) { return whole_grid.inside(p); });
  return errors(query, to_mesh, volume, [&](const Vec3& p) { return grid.distance(p); });
}

ShapeError shape_error(const DistanceField& field, const MeshQuery& query) {
  // The zero level of the trilinear interpolant, where it crosses the edges of the grid; and the volume by the part of
  // each node's cube that is inside if the surface there is flat.
  std::vector<double> volumes(static_cast<std::size_t>(field.nodes[2]), 0.0);
  const Distances to_mesh = put_together(volumes.size(), [&](std::size_t slice) {
    Distances of_slice;
    const int z = static_cast<int>(slice);
    for (int y = 0; y < field.nodes[1]; ++y) {
      for (int x = 0; x < field.nodes[0]; ++x) {
        const double here = field.at(x, y, z);
        volumes[slice] += std::clamp(0.5 - here / field.cell, 0.0, 1.0);
        for (int axis = 0; axis < 3; ++axis) {
          const std::array<int, 3> next{x + (axis == 0), y + (axis == 1), z + (axis == 2)};
          if (next[axis] >= field.nodes[axis]) continue;
          const double there = field.at(next[0], next[1], next[2]);
          if ((here < 0) == (there < 0)) continue;
          const Vec3 node = Vec3(x, y, z) + here / (here - there) * Vec3::Unit(axis);
          of_slice.add(query.nearest(field.origin + field.cell * node).distance, 1.0);
        }
      }
    }
    return of_slice;
  });
  double volume = 0;
  for (const double of_slice : volumes) volume += of_slice;
  return errors(query, to_mesh, volume * std::pow(field.cell, 3), [&](const Vec3& p) { return field.distance(p); });
}

ShapeError shape_error(const ConvexHulls& set, const MeshQuery& query) {
  const double diagonal = query.mesh().bounds().diagonal();
  const std::vector<HullPlanes> planes(set.hulls.begin(), set.hulls.end());
  const Distances to_mesh = put_together(set.hulls.size(), [&](std::size_t h) {
    Distances of_hull;
    DistanceWalk walk(query);
    for (const SurfacePoint& s : dense_surface_points(set.hulls[h], step_share * diagonal)) {
      // Faces inside the solid are where two hulls meet: nothing touches them. Outside they may be covered by another
      // hull, which then sticks out further.
      const double distance = walk.go_to(s.point);
      if (distance < 1e-4 * diagonal || !walk.inside()) of_hull.add(distance, s.weight);
    }
    return of_hull;
  });
  return errors(query, to_mesh, union_volume(set.hulls), [&](const Vec3& p) { return distance_to_union(planes, p); });
}

}  // namespace bin_scenes
