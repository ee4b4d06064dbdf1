/// Cuts all triangles along the surfaces of other shells, keeps the pieces with the outside in front of them, and welds
/// these. Gives up, and leaves the shells as they are, where gaps would be left.
#include "unite.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "edge_uses.hpp"
#include "shells.hpp"
#include "t_junctions.hpp"
#include "weld.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace bin_scenes::repair {

std::size_t overlapping_pairs(const Mesh& mesh) {
  struct Solid {
    std::vector<std::uint32_t> triangles;
    Aabb box;
    double volume6 = 0.0;
  };
  const Shells labels = shells(mesh);
  if (labels.count < 2) return 0;
  std::vector<Solid> solids(labels.count);
  const Vec3 apex = mesh.bounds().center();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Solid& solid = solids[labels.of_triangle[t]];
    solid.triangles.push_back(t);
    const auto& [a, b, c] = mesh.triangles[t];
    for (const std::uint32_t v : mesh.triangles[t]) solid.box.extend(mesh.vertices[v]);
    solid.volume6 += (mesh.vertices[a] - apex).dot((mesh.vertices[b] - apex).cross(mesh.vertices[c] - apex));
  }
  const auto enters = [&](const Solid& one, const Solid& other) {
    const std::size_t step = std::max<std::size_t>(1, one.triangles.size() / 50);
    for (std::size_t i = 0; i < one.triangles.size(); i += step) {
      const auto& [a, b, c] = mesh.triangles[one.triangles[i]];
      const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      for (const Vec3& probe :
           {Vec3((p + q + r) / 3.0), Vec3((p + q) / 2.0), Vec3((q + r) / 2.0), Vec3((r + p) / 2.0)}) {
        Aabb point;
        point.extend(probe);
        // On the other's surface it is one half; well above that is inside.
        if (other.box.overlaps(point) && winding(mesh, other.triangles, probe) > 0.9) return true;
      }
    }
    return false;
  };
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      if (solids[i].volume6 <= 0.0 || solids[j].volume6 <= 0.0 || !solids[i].box.overlaps(solids[j].box)) continue;
      pairs += enters(solids[i], solids[j]) || enters(solids[j], solids[i]);
    }
  }
  return pairs;
}
namespace {

// Solid angles it may cost, at each tolerance, to find which pieces are inside another shell: about a second. To see
// whether a triangle cuts a piece costs as much as five.
constexpr double most_work = 2e7, work_of_cut = 5;

using Polygon = std::vector<Vec3>;

/// The parts of a convex polygon below and above the plane normal . p = offset; corners within `tolerance` are in it.
std::pair<Polygon, Polygon> cut(const Polygon& polygon, const Vec3& normal, double offset, double tolerance) {
  std::pair<Polygon, Polygon> sides;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = normal.dot(p) - offset, hq = normal.dot(q) - offset;
    if (hp <= tolerance) sides.first.push_back(p);
    if (hp >= -tolerance) sides.second.push_back(p);
    if ((hp < -tolerance && hq > tolerance) || (hp > tolerance && hq < -tolerance)) {
      const Vec3 crossing = p + hp / (hp - hq) * (q - p);
      sides.first.push_back(crossing);
      sides.second.push_back(crossing);
    }
  }
  return sides;
}

class Union {
 public:
  Union(const Mesh& mesh, double tolerance)
      : mesh_(mesh), tolerance_(tolerance), labels_(shells(mesh)), members_(labels_.count), boxes_(labels_.count) {
    volume_.assign(labels_.count, 0.0);
    const Vec3 apex = mesh.bounds().center();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t shell = labels_.of_triangle[t];
      members_[shell].push_back(t);
      normals_.push_back(mesh.area_vector(t).normalized());
      triangle_boxes_.emplace_back();
      for (const std::uint32_t v : mesh.triangles[t]) triangle_boxes_[t].extend(mesh.vertices[v]);
      boxes_[shell].extend(triangle_boxes_[t].lower);
      boxes_[shell].extend(triangle_boxes_[t].upper);
      volume_[shell] += (mesh.vertices[mesh.triangles[t][0]] - apex).dot(mesh.area_vector(t));
    }
    for (std::uint32_t s = 0; s < labels_.count; ++s) largest_first_.push_back(s);
    std::stable_sort(largest_first_.begin(), largest_first_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return volume_[a] > volume_[b]; });
    all_solid_ = volume_.empty() || volume_[largest_first_.back()] > 0;
  }

  /// The boundary as loose triangles; empty if it would take too long.
  Mesh boundary() {
    find_others();
    Mesh result;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      stop_if_cancelled();
      for (const Polygon& piece : pieces(t)) {
        if (work_ > most_work) return {};
        if (piece.size() < 3 || !outer(piece, t)) continue;
        const auto first = static_cast<std::uint32_t>(result.vertices.size());
        for (const Vec3& p : piece) result.vertices.push_back(p);
        for (std::uint32_t k = 1; k + 1 < piece.size(); ++k)
          result.triangles.push_back({first, first + k, first + k + 1});
      }
    }
    return result;
  }

 private:
  /// For each triangle those of other shells whose boxes meet its own, by a sweep along x.
  void find_others() {
    std::vector<std::uint32_t> order(mesh_.triangles.size());
    for (std::uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::make_pair(triangle_boxes_[a].lower.x(), a) < std::make_pair(triangle_boxes_[b].lower.x(), b);
    });
    others_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      stop_if_cancelled();
      const std::uint32_t a = order[i];
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const std::uint32_t b = order[j];
        if (triangle_boxes_[b].lower.x() > triangle_boxes_[a].upper.x() + tolerance_) break;
        if (labels_.of_triangle[a] == labels_.of_triangle[b]) continue;
        if (!triangle_boxes_[a].overlaps(triangle_boxes_[b], tolerance_)) continue;
        others_[a].push_back(b);
        others_[b].push_back(a);
      }
    }
    for (auto& list : others_) std::sort(list.begin(), list.end());
  }

  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return {mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]};
  }

  bool coplanar(std::uint32_t t, std::uint32_t u) const {
    const std::array<Vec3, 3> other = corners(u);
    return std::all_of(other.begin(), other.end(), [&](const Vec3& p) {
      return std::abs(normals_[t].dot(p - mesh_.vertices[mesh_.triangles[t][0]])) <= tolerance_;
    });
  }

  /// The triangle cut so finely that no other shell's surface crosses a piece.
  std::vector<Polygon> pieces(std::uint32_t t) {
    const std::array<Vec3, 3> whole = corners(t);
    std::vector<Polygon> list(1, Polygon(whole.begin(), whole.end()));
    for (const std::uint32_t u : others_[t]) {
      work_ += work_of_cut * static_cast<double>(list.size());
      if (work_ > most_work) break;
      const std::array<Vec3, 3> other = corners(u);
      if (coplanar(t, u)) {
        for (int k = 0; k < 3; ++k) {
          const Vec3 across = (other[(k + 1) % 3] - other[k]).cross(normals_[u]).normalized();
          split(list, across, across.dot(other[k]), other);
        }
      } else {
        split(list, normals_[u], normals_[u].dot(other[0]), other);
      }
    }
    return list;
  }

  /// Cuts those pieces by a plane that the triangle `other` touches along the cut.
  void split(std::vector<Polygon>& list, const Vec3& normal, double offset, const std::array<Vec3, 3>& other) const {
    const std::size_t count = list.size();
    for (std::size_t i = 0; i < count; ++i) {
      auto [below, above] = cut(list[i], normal, offset, tolerance_);
      const auto beyond = [&](double side) {
        return std::any_of(list[i].begin(), list[i].end(),
                           [&](const Vec3& p) { return side * (normal.dot(p) - offset) > tolerance_; });
      };
      if (!beyond(-1) || !beyond(1) || apart(below, above, other)) continue;
      list[i] = std::move(below);
      list.push_back(std::move(above));
    }
  }

  /// Whether a triangle does not reach the cut, which is the line the two pieces share.
  bool apart(const Polygon& below, const Polygon& above, const std::array<Vec3, 3>& other) const {
    Aabb line, reach;
    for (const Vec3& p : below) {
      for (const Vec3& q : above) {
        if ((p - q).norm() <= tolerance_) line.extend(p);
      }
    }
    for (const Vec3& p : other) reach.extend(p);
    return !line.overlaps(reach, tolerance_);
  }

  /// Whether the space before a piece is outside of all solids. Of pieces that cover each other one is enough.
  bool outer(const Polygon& piece, std::uint32_t t) {
    const std::uint32_t own = labels_.of_triangle[t];
    Vec3 center = Vec3::Zero();
    for (const Vec3& p : piece) center += p / static_cast<double>(piece.size());
    const Vec3 before = center + 2 * tolerance_ * normals_[t];
    Aabb point;
    point.extend(before);
    double around = volume_[own] < 0 ? -1.0 : 0.0;  // before the wall of a cavity its own shell counts as minus one
    for (const std::uint32_t s : largest_first_) {
      if (s == own || !boxes_[s].overlaps(point)) continue;
      around += winding(mesh_, members_[s], before);
      work_ += static_cast<double>(members_[s].size());
      // No cavity can take back what one solid says. Shells within shells by the hundred need this.
      if (all_solid_ && around > 0.5) return false;
    }
    if (around > 0.5) return false;
    return std::none_of(others_[t].begin(), others_[t].end(), [&](std::uint32_t u) {
      if (u > t || normals_[t].dot(normals_[u]) <= 0 || !coplanar(t, u)) return false;
      const std::array<Vec3, 3> other = corners(u);
      for (int k = 0; k < 3; ++k) {
        if ((other[(k + 1) % 3] - other[k]).cross(center - other[k]).dot(normals_[u]) < 0) return false;
      }
      return true;
    });
  }

  const Mesh& mesh_;
  double tolerance_;
  Shells labels_;
  std::vector<std::vector<std::uint32_t>> members_;  // triangles of each shell
  std::vector<Aabb> boxes_;
  std::vector<double> volume_;  // of each shell, times six
  std::vector<std::uint32_t> largest_first_;
  bool all_solid_ = true;  // no shell is a cavity
  double work_ = 0;        // solid angles asked for
  std::vector<Vec3> normals_;
  std::vector<Aabb> triangle_boxes_;
  std::vector<std::vector<std::uint32_t>> others_;
};

/// Makes one closed surface of loose triangles; false if gaps are left.
bool close(Mesh& united, double tolerance) {
  weld(united, tolerance);
  for (int round = 0; round < 10; ++round) {
    // The corners of pieces lie on each other's edges but for rounding and welding.
    if (remove_slivers(united, tolerance) + split_t_junctions(united, 4 * tolerance) == 0) break;
  }
  return !united.empty() && open_edges(united) == 0;
}

}  // namespace

bool unite(Mesh& mesh, double tolerance) {
  // Where planes cross at small angles, rounding and welding may leave gaps at one tolerance that another does not.
  for (const double share : {1.0, 0.3, 3.0, 0.1}) {
    Mesh united = Union(mesh, share * tolerance).boundary();
    if (united.empty()) return false;
    if (!close(united, share * tolerance)) continue;
    BIN_SCENES_ASSERT(indices_in_range(united) && open_edges(united) == 0);
    mesh = std::move(united);
    return true;
  }
  return false;
}

}  // namespace bin_scenes::repair
