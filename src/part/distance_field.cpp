/// Signed distance at the nodes of a grid: nearest points by the tree of MeshQuery, signs by field_sign.hpp. Between
/// nodes the field is interpolated.
#include "bin_scenes/part/distance_field.hpp"

#include "core/in_parallel.hpp"
#include "field_sign.hpp"
#include "triangle.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/mesh_query.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace bin_scenes {
namespace {

// Nodes closer to the surface than this (in cells) get the exact nearest triangle by rasterisation. The eight nodes
// around a point half a cell off the surface are less than sqrt(3) + 1/2 cells away: what a contact reads is exact.
constexpr double band = 3.0;

// What rounding does to a distance in grid units, seen generously: a triangle is passed over only if it is farther.
constexpr double rounding = 1e-6;

constexpr std::int32_t none = -1;

/// The nearest surface point known to a node, in grid units.
struct Nearest {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  float distance = std::numeric_limits<float>::infinity();
  std::int32_t triangle = none;
};

/// The smallest box around a triangle along its longest edge and its normal: shows at little cost that a node is far.
struct EdgeBox {
  Mat3 axes;  // a row each
  Vec3 lower, upper;

  EdgeBox(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    const Vec3 edges[3] = {b - a, c - b, a - c};
    const Vec3& longest = *std::max_element(
        edges, edges + 3, [](const Vec3& p, const Vec3& q) { return p.squaredNorm() < q.squaredNorm(); });
    // A sliver has no normal, and one of a single point not even an edge: any box around them will do.
    const bool flat = !normal.isZero();
    axes.row(0) = flat ? Vec3(longest.normalized()) : Vec3::UnitX();
    axes.row(1) = flat ? normal : Vec3::UnitY();
    axes.row(2) = axes.row(0).cross(axes.row(1));
    const Vec3 corners[3] = {axes * a, axes * b, axes * c};
    lower = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    upper = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  }

  /// From a point given along the axes.
  double squared_distance(const Vec3& p) const { return (lower - p).cwiseMax(p - upper).cwiseMax(0.0).squaredNorm(); }
};

/// Builds the field in four steps: rasterise, sweep, refine, sign.
class FieldBuilder {
 public:
  FieldBuilder(const MeshQuery& query, DistanceField& field) : query_(query), field_(field) {
    BIN_SCENES_ASSERT(field.cell > 0.0 && each_is(field.nodes, [](int count) { return count >= 2; }));
    stride_ = {1, field.nodes[0], static_cast<std::ptrdiff_t>(field.nodes[0]) * field.nodes[1]};
    nodes_.resize(static_cast<std::size_t>(stride_[2]) * field.nodes[2]);
    exact_.resize(nodes_.size());
    field.values.resize(nodes_.size());
    const Mesh& mesh = query.mesh();
    triangles_.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles_.emplace_back(to_grid(mesh.vertices[a]), to_grid(mesh.vertices[b]), to_grid(mesh.vertices[c]));
    }
  }

  void build() {
    in_slabs([&](int first, int end) { rasterise(first, end); });
    sweep();
    in_slabs([&](int first, int end) { refine(first, end); });
    BIN_SCENES_ASSERT(each_is(field_.values, [](float value) { return value >= 0.0f; }));
    sign_field(field_, query_);
    for (float& value : field_.values) value = static_cast<float>(value * field_.cell);
    BIN_SCENES_ASSERT(each_is(field_.values, [](float value) { return std::isfinite(value); }));
  }

 private:
  Vec3 to_grid(const Vec3& point) const { return (point - field_.origin) / field_.cell; }
  std::size_t index(int x, int y, int z) const { return static_cast<std::size_t>(x + stride_[1] * y + stride_[2] * z); }

  /// Slices of nodes, a few at a time.
  template <class Work>
  void in_slabs(const Work& work) const {
    constexpr int slices = 16;
    in_parallel(static_cast<std::size_t>((field_.nodes[2] + slices - 1) / slices), [&](std::size_t slab) {
      const int first = slices * static_cast<int>(slab);
      work(first, std::min(first + slices, field_.nodes[2]));
    });
  }

  /// Exact nearest triangle of every node within the band: each triangle visits the nodes of its own neighbourhood.
  void rasterise(int first_z, int end_z) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const PreparedTriangle& triangle = triangles_[t];
      const Vec3 b = triangle.a + triangle.ab, c = triangle.a + triangle.ac;
      const Vec3 lower = triangle.a.cwiseMin(b).cwiseMin(c).array() - band;
      const Vec3 upper = triangle.a.cwiseMax(b).cwiseMax(c).array() + band;
      const int lowest_z = std::max(first_z, static_cast<int>(std::ceil(lower[2])));
      const int highest_z = std::min(end_z - 1, static_cast<int>(std::floor(upper[2])));
      if (lowest_z > highest_z) continue;
      const EdgeBox box(triangle.a, b, c, triangle.normal);
      const auto first = [&](int axis) { return std::max(0, static_cast<int>(std::ceil(lower[axis]))); };
      const auto last = [&](int axis) {
        return std::min(field_.nodes[axis] - 1, static_cast<int>(std::floor(upper[axis])));
      };
      for (int z = lowest_z; z <= highest_z; ++z) {
        for (int y = first(1); y <= last(1); ++y) {
          // Only the part of the row inside the slab |n.(p - a)| <= band can be within the band: without this cut a
          // large oblique triangle would visit its whole bounding box.
          double row_lower = lower[0], row_upper = upper[0];
          const double offset = triangle.normal.dot(Vec3(0, y, z) - triangle.a), slope = triangle.normal[0];
          if (std::abs(slope) > 1e-9) {
            const double x1 = (-band - offset) / slope, x2 = (band - offset) / slope;
            row_lower = std::max(row_lower, std::min(x1, x2));
            row_upper = std::min(row_upper, std::max(x1, x2));
          } else if (std::abs(offset) > band) {
            continue;
          }
          const int x_last = std::min(field_.nodes[0] - 1, static_cast<int>(std::floor(row_upper)));
          const Vec3 row = box.axes * Vec3(0, y, z);
          for (int x = std::max(0, static_cast<int>(std::ceil(row_lower))); x <= x_last; ++x) {
            Nearest& best = nodes_[index(x, y, z)];
            // Most triangles are farther away than one seen before.
            const double beaten = best.distance * (1 + rounding) + rounding;
            if (box.squared_distance(row + x * box.axes.col(0)) > beaten * beaten) continue;
            const Vec3 node(x, y, z);
            const Vec3 nearest = triangle.nearest(node);
            const float distance = static_cast<float>((node - nearest).norm());
            if (distance < best.distance) best = {nearest.cast<float>(), distance, static_cast<std::int32_t>(t)};
          }
        }
      }
    }
    // What lies outside the band has not seen every triangle: it starts over from its neighbours, but may keep the
    // candidate it has.
    for (std::size_t i = index(0, 0, first_z); i < index(0, 0, end_z); ++i) exact_[i] = nodes_[i].distance <= band;
  }

  /// Hands nearest points from node to node away from the band (vector distance transform, Danielsson 1980,
  /// "Euclidean distance mapping"): down and up the slices, inside a slice down and up the rows, inside a row both
  /// ways.
  void sweep() {
    const auto [nx, ny, nz] = field_.nodes;
    const auto offer = [&](std::size_t to, std::ptrdiff_t step, int x, int y, int z) {
      const Nearest& from = nodes_[to + step];
      if (exact_[to] || from.triangle == none) return;
      const float distance = (Eigen::Vector3f(x, y, z) - from.point).norm();
      if (distance < nodes_[to].distance) nodes_[to] = {from.point, distance, from.triangle};
    };
    for (int down = 0; down < 2; ++down) {
      for (int k = 0; k < nz; ++k) {
        const int z = down ? nz - 1 - k : k;
        if (k > 0) {
          for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) offer(index(x, y, z), down ? stride_[2] : -stride_[2], x, y, z);
        }
        for (int back = 0; back < 2; ++back) {
          for (int j = 0; j < ny; ++j) {
            const int y = back ? ny - 1 - j : j;
            if (j > 0) {
              for (int x = 0; x < nx; ++x) offer(index(x, y, z), back ? stride_[1] : -stride_[1], x, y, z);
            }
            for (int x = 1; x < nx; ++x) offer(index(x, y, z), -1, x, y, z);
            for (int x = nx - 2; x >= 0; --x) offer(index(x, y, z), 1, x, y, z);
          }
        }
      }
    }
  }

  /// A nearest point handed on was nearest to another node. Asking the triangles that this node and its neighbours
  /// know makes the distance exact again for all but a few nodes near the medial axis.
  void refine(int first_z, int end_z) {
    const auto [nx, ny, nz] = field_.nodes;
    for (int z = first_z; z < end_z; ++z) {
      for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) {
          const std::size_t i = index(x, y, z);
          double distance = nodes_[i].distance;
          if (!exact_[i]) {
            const Vec3 node(x, y, z);
            std::array<std::int32_t, 7> known;
            int count = 0;
            const auto ask = [&](std::int32_t t) {
              if (std::find(known.begin(), known.begin() + count, t) != known.begin() + count) return;
              known[count++] = t;
              distance = std::min(distance, (node - triangles_[t].nearest(node)).norm());
            };
            ask(nodes_[i].triangle);
            if (x > 0) ask(nodes_[i - 1].triangle);
            if (x + 1 < nx) ask(nodes_[i + 1].triangle);
            if (y > 0) ask(nodes_[i - stride_[1]].triangle);
            if (y + 1 < ny) ask(nodes_[i + stride_[1]].triangle);
            if (z > 0) ask(nodes_[i - stride_[2]].triangle);
            if (z + 1 < nz) ask(nodes_[i + stride_[2]].triangle);
          }
          field_.values[i] = static_cast<float>(distance);
        }
      }
    }
  }

  const MeshQuery& query_;
  DistanceField& field_;
  std::array<std::ptrdiff_t, 3> stride_;
  std::vector<PreparedTriangle> triangles_;
  std::vector<Nearest> nodes_;
  std::vector<std::uint8_t> exact_;
};

/// Lays the grid over the bounding box; the cell grows until the grid fits into max_nodes.
DistanceField empty_field(const Aabb& box, const FieldOptions& options) {
  DistanceField field;
  const double padding = std::max(1.0, options.padding);
  field.cell = options.cell * box.diagonal();
  for (;;) {
    const Vec3 cells = box.size() / field.cell;
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) count *= std::ceil(cells[axis] + 2 * padding) + 1;
    if (count <= static_cast<double>(options.max_nodes)) break;
    field.cell *= std::max(1.01, std::cbrt(count / static_cast<double>(options.max_nodes)));
    field.coarsened = true;
  }
  for (int axis = 0; axis < 3; ++axis) {
    field.nodes[axis] = static_cast<int>(std::ceil(box.size()[axis] / field.cell + 2 * padding)) + 1;
  }
  BIN_SCENES_ASSERT(field.cell > 0.0 && padding >= 1.0);
  const Vec3 extent(field.nodes[0] - 1, field.nodes[1] - 1, field.nodes[2] - 1);
  field.origin = box.center() - 0.5 * field.cell * extent;
  return field;
}

/// The cell of a point inside the grid and the position in it, 0..1 an axis.
struct CellPosition {
  std::array<int, 3> node;
  Vec3 fraction;
};

CellPosition locate(const DistanceField& field, const Vec3& grid_point) {
  CellPosition position;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = std::clamp(grid_point[axis], 0.0, field.nodes[axis] - 1.0);
    position.node[axis] = std::min(static_cast<int>(x), field.nodes[axis] - 2);
    position.fraction[axis] = x - position.node[axis];
  }
  return position;
}

}  // namespace

double DistanceField::distance(const Vec3& point) const {
  const Vec3 grid_point = (point - origin) / cell;
  const auto [node, f] = locate(*this, grid_point);
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    const double weight = (dx ? f[0] : 1 - f[0]) * (dy ? f[1] : 1 - f[1]) * (dz ? f[2] : 1 - f[2]);
    value += weight * at(node[0] + dx, node[1] + dy, node[2] + dz);
  }
  const Vec3 nearest = Vec3(node[0], node[1], node[2]) + f;
  return value + cell * (grid_point - nearest).norm();
}

Vec3 DistanceField::normal(const Vec3& point) const {
  const auto [node, f] = locate(*this, (point - origin) / cell);
  Vec3 gradient = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    const double wx = dx ? f[0] : 1 - f[0], wy = dy ? f[1] : 1 - f[1], wz = dz ? f[2] : 1 - f[2];
    const double value = at(node[0] + dx, node[1] + dy, node[2] + dz);
    gradient += value * Vec3((dx ? 1 : -1) * wy * wz, (dy ? 1 : -1) * wx * wz, (dz ? 1 : -1) * wx * wy);
  }
  const double length = gradient.norm();
  return length > 1e-9 * cell ? Vec3(gradient / length) : Vec3::Zero();
}

DistanceField distance_field(const MeshQuery& query, const FieldOptions& options) {
  const Mesh& mesh = query.mesh();
  const Aabb box = mesh.bounds();
  if (mesh.empty() || !(box.diagonal() > 0)) {
    throw input_error("a mesh without surface has no distance field", "distance_field", "give a mesh with triangles");
  }
  if (!(options.cell > 0) || options.max_nodes < 1000) {
    throw input_error("field cell " + std::to_string(options.cell) + " with at most " +
                          std::to_string(options.max_nodes) + " nodes is no grid",
                      "FieldOptions", "use a cell above 0 (0.01 = 1 % of the diagonal) and at least 1000 nodes");
  }
  DistanceField field = empty_field(box, options);
  FieldBuilder(query, field).build();
  return field;
}

DistanceField distance_field(const Mesh& mesh, const FieldOptions& options) {
  return distance_field(MeshQuery(mesh), options);
}

}  // namespace bin_scenes
