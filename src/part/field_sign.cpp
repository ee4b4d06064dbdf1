/// Winding numbers along rows of a grid for closed meshes; for others one winding number a region that no surface
/// crosses.
#include "field_sign.hpp"

#include "ray_parity.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

namespace bin_scenes {
namespace {

std::size_t node_index(const DistanceField& field, int x, int y, int z) {
  return static_cast<std::size_t>(x) +
         field.nodes[0] * (static_cast<std::size_t>(y) + static_cast<std::size_t>(field.nodes[1]) * z);
}

Vec3 node_position(const DistanceField& field, int x, int y, int z) {
  return field.origin + field.cell * Vec3(x, y, z);
}

/// The sign of a closed mesh, row by row along x: each surface that a row meets changes the winding number by one.
/// Triangles are drawn into the yz plane as polygons are drawn on a screen: edges belong to one of their two triangles
/// only, so that no row slips through between them or meets both.
class RowSigns {
 public:
  RowSigns(DistanceField& field, const MeshQuery& query) : field_(field), query_(query) {
    crossings_.resize(static_cast<std::size_t>(field.nodes[1]) * field.nodes[2]);
    const Mesh& mesh = query.mesh();
    points_.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) points_.push_back((v - field.origin) / field.cell);
    for (const Triangle& t : mesh.triangles) draw(t);
  }

  void apply() {
    for (int z = 0; z < field_.nodes[2]; ++z) {
      for (int y = 0; y < field_.nodes[1]; ++y) apply_to_row(y, z);
    }
  }

 private:
  struct Crossing {
    double x;
    int change;  // of the winding number, going towards +x
    bool operator<(const Crossing& o) const { return std::tie(x, change) < std::tie(o.x, o.change); }
  };

  /// Twice the area of (a, b, (y, z)), the same to the last bit but for the sign when a and b change places.
  double edge(std::uint32_t a, std::uint32_t b, double y, double z) const {
    const bool swapped = a > b;
    if (swapped) std::swap(a, b);
    const Vec3 &p = points_[a], &q = points_[b];
    const double area = (q.y() - p.y()) * (z - p.z()) - (q.z() - p.z()) * (y - p.y());
    return swapped ? -area : area;
  }

  /// Whether a place to the left of the edge or on it belongs to its triangle, which lies on the left.
  bool covers(std::uint32_t a, std::uint32_t b, double area) const {
    if (area != 0.0) return area > 0.0;
    const double dz = points_[b].z() - points_[a].z();
    return dz != 0.0 ? dz < 0.0 : points_[b].y() > points_[a].y();
  }

  void draw(const Triangle& t) {
    const Vec3 normal = (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
    if (normal.x() == 0.0) return;
    // Counter-clockwise in the yz plane if it looks along +x: going along +x one leaves there.
    const bool leaves = normal.x() > 0.0;
    const std::uint32_t a = t[0], b = leaves ? t[1] : t[2], c = leaves ? t[2] : t[1];
    const auto range = [&](int axis) {
      const auto [low, high] = std::minmax({points_[a][axis], points_[b][axis], points_[c][axis]});
      return std::make_pair(std::max(0, static_cast<int>(std::ceil(low))),
                            std::min(field_.nodes[axis] - 1, static_cast<int>(std::floor(high))));
    };
    const auto [first_y, last_y] = range(1);
    const auto [first_z, last_z] = range(2);
    for (int z = first_z; z <= last_z; ++z) {
      for (int y = first_y; y <= last_y; ++y) {
        const double of_c = edge(a, b, y, z), of_a = edge(b, c, y, z), of_b = edge(c, a, y, z);
        if (!covers(a, b, of_c) || !covers(b, c, of_a) || !covers(c, a, of_b)) continue;
        const double sum = of_a + of_b + of_c;
        if (!(sum > 0.0)) continue;
        const double x = (of_a * points_[a].x() + of_b * points_[b].x() + of_c * points_[c].x()) / sum;
        crossings_[y + static_cast<std::size_t>(field_.nodes[1]) * z].push_back({x, leaves ? -1 : 1});
      }
    }
  }

  void apply_to_row(int y, int z) {
    auto& crossings = crossings_[y + static_cast<std::size_t>(field_.nodes[1]) * z];
    if (crossings.empty()) return;
    std::sort(crossings.begin(), crossings.end());
    BIN_SCENES_ASSERT(std::isfinite(crossings.front().x) && std::isfinite(crossings.back().x));
    int total = 0;
    for (const Crossing& crossing : crossings) total += crossing.change;
    // Rounding has let the row slip between two triangles.
    const bool trusted = total == 0;
    int winding = 0;
    std::size_t next = 0;
    for (int x = 0; x < field_.nodes[0]; ++x) {
      for (; next < crossings.size() && crossings[next].x <= x; ++next) winding += crossings[next].change;
      float& value = field_.values[node_index(field_, x, y, z)];
      if (trusted ? winding > 0 : query_.inside(node_position(field_, x, y, z))) value = -value;
    }
  }

  DistanceField& field_;
  const MeshQuery& query_;
  std::vector<Vec3> points_;  // in grid units
  std::vector<std::vector<Crossing>> crossings_;
};

/// The sign of any mesh.
class RegionSigns {
 public:
  RegionSigns(DistanceField& field, const MeshQuery& query) : field_(field), query_(query) {}

  /// The sign can only change across the surface, and the straight line between two nodes meets no surface if their
  /// distances add up to more than its length. Nodes joined by such lines form regions; one winding number settles a
  /// region.
  void apply() {
    std::vector<std::uint8_t> seen(field_.values.size(), 0);
    std::vector<std::array<int, 3>> region;
    const auto [nx, ny, nz] = field_.nodes;
    for (int z = 0; z < nz; ++z) {
      for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) {
          if (seen[node_index(field_, x, y, z)]) continue;
          collect_region({x, y, z}, seen, region);
          sign_region(region);
        }
      }
    }
  }

 private:
  void collect_region(const std::array<int, 3>& start, std::vector<std::uint8_t>& seen,
                      std::vector<std::array<int, 3>>& region) const {
    static const float length[4] = {0.0f, 1.0001f, 1.4144f, 1.7323f};  // a little more than sqrt(1, 2, 3): rounding
    region.assign(1, start);
    seen[node_index(field_, start[0], start[1], start[2])] = 1;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const auto [x, y, z] = region[next];
      const float here = std::abs(field_.values[node_index(field_, x, y, z)]);
      for (int dz = -1; dz <= 1; ++dz) {
        if (z + dz < 0 || z + dz >= field_.nodes[2]) continue;
        for (int dy = -1; dy <= 1; ++dy) {
          if (y + dy < 0 || y + dy >= field_.nodes[1]) continue;
          for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || x + dx >= field_.nodes[0]) continue;
            const std::size_t there = node_index(field_, x + dx, y + dy, z + dz);
            if (seen[there]) continue;
            const int axes = std::abs(dx) + std::abs(dy) + std::abs(dz);
            // Signs of settled regions do not matter here: seen nodes are skipped above.
            if (here + field_.values[there] <= length[axes]) continue;
            seen[there] = 1;
            region.push_back({x + dx, y + dy, z + dz});
          }
        }
      }
    }
  }

  void sign_region(const std::vector<std::array<int, 3>>& region) {
    const auto inside = [&](const std::array<int, 3>& n) {
      return query_.inside(node_position(field_, n[0], n[1], n[2]));
    };
    const auto flip = [&](const std::array<int, 3>& n) {
      float& value = field_.values[node_index(field_, n[0], n[1], n[2])];
      value = -value;
    };
    // Through a hole wider than a cell a region leaks to the other side: its probes then disagree, and each node
    // is settled by itself.
    constexpr std::size_t probes = 8;
    const std::size_t step = std::max<std::size_t>(1, region.size() / probes);
    const bool first = inside(region.front());
    bool agree = true;
    for (std::size_t i = step; agree && i < region.size(); i += step) agree = inside(region[i]) == first;
    for (const auto& node : region) {
      if (agree ? first : inside(node)) flip(node);
    }
  }

  DistanceField& field_;
  const MeshQuery& query_;
};

}  // namespace

void sign_field(DistanceField& field, const MeshQuery& query) {
  if (closed(query.mesh())) {
    RowSigns(field, query).apply();
  } else {
    RegionSigns(field, query).apply();
  }
}

}  // namespace bin_scenes
