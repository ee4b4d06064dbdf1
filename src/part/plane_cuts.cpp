/// Cuts pieces by the plane that leaves the least volume in the hulls of both sides, until errors are small or there
/// are enough pieces. Candidates are planes at concave edges and across the axes.
#include "plane_cuts.hpp"

#include "core/in_parallel.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/part/hull_geometry.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <unordered_map>

namespace bin_scenes {
namespace {

// An edge counts as concave if its faces turn inwards by more than this (rad).
constexpr double concave = 0.05;
// Concave edges whose planes are tried a piece: those nearest to where its hull sticks out most, and the strongest.
constexpr std::size_t nearest_edges = 4, strongest_edges = 4;
// Planes are judged on a sketch of the piece of about this many triangles.
constexpr std::size_t sketch_voxels = 700;
// A cut is worth it if it saves this share of what the hull encloses too much. Where none is, as on a ring or a plate
// with a hole, which take two, the piece is cut where its hull sticks out most.
constexpr double least_gain = 0.03;
// What an uneven cut costs against one that saves as much, / hull volume.
constexpr double uneven = 0.02;
// What a cut across all concave edges costs, / what the hull encloses too much.
constexpr double voxels_across = 0.3;

/// An edge where cutting may help, with the planes of its faces and the one halfway between them.
struct ConcaveEdge {
  Vec3 start, end;
  double strength;  // length times angle
  std::array<CutPlane, 3> planes;
};

CutPlane plane_through(const Vec3& point, const Vec3& normal) {
  return {normal, normal.dot(point)};
}

std::vector<ConcaveEdge> concave_edges(const Mesh& mesh) {
  struct Half {
    std::uint32_t low, high, triangle;
    bool operator<(const Half& o) const { return std::tie(low, high, triangle) < std::tie(o.low, o.high, o.triangle); }
  };
  std::vector<Half> halves;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      halves.push_back({low, high, t});
    }
  }
  std::sort(halves.begin(), halves.end());
  std::vector<ConcaveEdge> edges;
  for (std::size_t i = 0; i + 1 < halves.size(); ++i) {
    if (halves[i].low != halves[i + 1].low || halves[i].high != halves[i + 1].high) continue;
    const Vec3 one = mesh.area_vector(halves[i].triangle), other = mesh.area_vector(halves[i + 1].triangle);
    if (!(one.norm() > 0 && other.norm() > 0)) continue;
    const Vec3 m = one.normalized(), n = other.normalized();
    const Vec3 &a = mesh.vertices[halves[i].low], &b = mesh.vertices[halves[i].high];
    // Concave if the far corner of the other triangle lies before the first one's face.
    Vec3 far = Vec3::Zero();
    for (const std::uint32_t v : mesh.triangles[halves[i + 1].triangle]) far += mesh.vertices[v];
    far -= a + b;
    const double angle = std::acos(std::clamp(m.dot(n), -1.0, 1.0));
    if (angle < concave || m.dot(far - a) <= 0) continue;
    const Vec3 along = (b - a).normalized(), center = 0.5 * (a + b);
    Vec3 across = along.cross(m + n);
    if (across.norm() < 1e-6) across = m;
    edges.push_back({a,
                     b,
                     angle * (b - a).norm(),
                     {plane_through(center, across.normalized()), plane_through(center, m), plane_through(center, n)}});
  }
  return edges;
}

double distance(const ConcaveEdge& edge, const Vec3& p) {
  const Vec3 along = edge.end - edge.start;
  const double part = std::clamp((p - edge.start).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (edge.start + part * along - p).norm();
}

/// A piece of the solid: its surface inside a convex cell.
struct Piece {
  Mesh surface, cell, hull;
  std::vector<std::uint32_t> edges;  // concave ones in it
  double surplus = 0;                // share of its hull that is outside the solid
  double protrusion = 0;
  Vec3 worst = Vec3::Zero();  // where the hull sticks out most
  bool final = false;         // no cut helps
};

double hull_volume(const Mesh& hull) {
  double six = 0;  // an empty one has none
  for (std::size_t t = 0; t < hull.triangles.size(); ++t) {
    six += hull.area_vector(t).dot(hull.vertices[hull.triangles[t][0]] - hull.vertices[0]);
  }
  return six / 6;
}

/// A surface with few triangles: vertices clustered (Rossignac & Borrel 1993), the first of a cell standing for it.
Mesh sketch(const Mesh& mesh) {
  if (mesh.triangles.size() <= sketch_voxels) return mesh;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += 0.5 * mesh.area_vector(t).norm();
  const double cell = std::sqrt(2 * area / static_cast<double>(sketch_voxels));
  const Aabb box = mesh.bounds();
  Mesh rough;
  std::unordered_map<std::uint64_t, std::uint32_t> cells;  // looked up by key only
  std::vector<std::uint32_t> chosen;
  for (const Vec3& v : mesh.vertices) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
      key = (key << 20) | static_cast<std::uint64_t>((v[axis] - box.lower[axis]) / cell);
    }
    const auto [entry, added] = cells.try_emplace(key, static_cast<std::uint32_t>(rough.vertices.size()));
    if (added) rough.vertices.push_back(v);
    chosen.push_back(entry->second);
  }
  for (const Triangle& t : mesh.triangles) {
    const Triangle moved{chosen[t[0]], chosen[t[1]], chosen[t[2]]};
    if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) rough.triangles.push_back(moved);
  }
  return rough;
}

constexpr int all_vertices = std::numeric_limits<int>::max();

class Cutter {
 public:
  Cutter(const Mesh& mesh, const SolidMeasure& measure)
      : edges_(concave_edges(mesh)), measure_(measure), tolerance_(1e-6 * mesh.bounds().diagonal()) {
    Piece whole;
    whole.surface = mesh;
    const Aabb box = mesh.bounds();
    for (int i = 0; i < 8; ++i) {
      whole.cell.vertices.push_back({(i & 1 ? box.upper : box.lower).x(), (i & 2 ? box.upper : box.lower).y(),
                                     (i & 4 ? box.upper : box.lower).z()});
    }
    whole.cell = convex_hull(whole.cell.vertices, all_vertices);
    for (std::uint32_t e = 0; e < edges_.size(); ++e) whole.edges.push_back(e);
    add(std::move(whole));
  }

  void run(double limit, int max_pieces) {
    while (static_cast<int>(pieces_.size()) < max_pieces) {
      stop_if_cancelled();
      const auto worst = std::max_element(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) {
        return (a.final ? -1.0 : a.protrusion) < (b.final ? -1.0 : b.protrusion);
      });
      if (worst->final || worst->protrusion <= limit) return;
      if (!split(*worst)) worst->final = true;
    }
  }

  std::vector<std::vector<Vec3>> points() const {
    std::vector<std::vector<Vec3>> result;
    for (const Piece& piece : pieces_) result.push_back(piece.hull.vertices);
    return result;
  }

 private:
  /// Of what is left of the surface, and of the corners of the cell that lie inside the solid: there three cuts meet.
  Mesh hull_of(const Mesh& surface, const Mesh& cell) const {
    std::vector<Vec3> points = surface.vertices;
    for (const Vec3& corner : cell.vertices) {
      if (measure_.inside(corner)) points.push_back(corner);
    }
    return convex_hull(points, all_vertices);
  }

  void add(Piece piece) {
    piece.hull = hull_of(piece.surface, piece.cell);
    if (piece.hull.empty()) return;  // flat: its neighbours cover it
    piece.surplus = surplus(piece.hull);
    std::tie(piece.protrusion, piece.worst) = measure_.protrusion(piece.hull);
    BIN_SCENES_ASSERT(piece.surplus >= 0.0 && piece.surplus <= 1.0 && piece.protrusion >= 0.0);
    pieces_.push_back(std::move(piece));
  }

  /// By the points of a quasi-random sequence (R3, Roberts 2018).
  double surplus(const Mesh& hull) const {
    constexpr int most_points = 2000;
    const HullPlanes planes(hull);
    const Vec3 lower = planes.bounds().lower, size = planes.bounds().size();
    const Vec3 step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
    int inside = 0, outside = 0;
    for (int i = 0; i < most_points; ++i) {
      Vec3 place = Vec3::Constant(0.5) + i * step;
      place -= place.array().floor().matrix();
      const Vec3 p = lower + place.cwiseProduct(size);
      if (!planes.outside_by_more(p, 0)) ++(measure_.inside(p) ? inside : outside);
    }
    return outside / std::max(1.0, static_cast<double>(inside + outside));
  }

  /// Share of a piece's concave edges that a plane cuts across, which leaves them in both sides.
  double crossed(const Piece& piece, const CutPlane& plane) const {
    double all = 0, across = 0;
    for (const std::uint32_t e : piece.edges) {
      const double start = plane.height(edges_[e].start), end = plane.height(edges_[e].end);
      all += edges_[e].strength;
      if (std::min(start, end) < -tolerance_ && std::max(start, end) > tolerance_) across += edges_[e].strength;
    }
    return all > 0 ? across / all : 0.0;
  }

  /// The plane of least cost, which is what the hulls of both sides enclose / what the piece's hull does.
  std::pair<double, CutPlane> cheapest(const Piece& piece, const Mesh& surface, double whole,
                                       const std::vector<CutPlane>& planes) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    std::vector<double> costs(planes.size(), never);
    in_parallel(planes.size(), [&](std::size_t i) {
      const auto surfaces = clip(surface, planes[i], tolerance_), cells = clip(piece.cell, planes[i], tolerance_);
      if (surfaces.first.empty() || surfaces.second.empty()) return;
      const double low = hull_volume(hull_of(surfaces.first, cells.first)) / whole;
      const double high = hull_volume(hull_of(surfaces.second, cells.second)) / whole;
      if (!(std::min(low, high) > 0)) return;
      costs[i] =
          low + high + uneven * (low * low + high * high) + voxels_across * piece.surplus * crossed(piece, planes[i]);
    });
    std::pair<double, CutPlane> best{never, {}};
    BIN_SCENES_ASSERT(each_is(costs, [](double cost) { return cost > 0.0; }));
    for (std::size_t i = 0; i < planes.size(); ++i)
      if (costs[i] < best.first) best = {costs[i], planes[i]};
    return best;
  }

  bool split(Piece& piece) {
    const Mesh rough = sketch(piece.surface);
    const double whole = hull_volume(hull_of(rough, piece.cell));
    const double enough = 1 + uneven - least_gain * piece.surplus;
    auto [cost, best] = cheapest(piece, rough, whole, planes_of_edges(piece));
    auto across = cheapest(piece, rough, whole, planes_across(piece, piece.hull.bounds().center()));
    if (across.first < cost) std::tie(cost, best) = across;
    if (cost > enough) std::tie(cost, best) = cheapest(piece, rough, whole, planes_across(piece, piece.worst));
    if (cost == std::numeric_limits<double>::infinity()) return false;
    auto surfaces = clip(piece.surface, best, tolerance_);
    auto cells = clip(piece.cell, best, tolerance_);
    Piece below, above;
    below.surface = std::move(surfaces.first);
    above.surface = std::move(surfaces.second);
    below.cell = convex_hull(cells.first.vertices, all_vertices);
    above.cell = convex_hull(cells.second.vertices, all_vertices);
    for (const std::uint32_t e : piece.edges) {
      const double start = best.height(edges_[e].start), end = best.height(edges_[e].end);
      if (std::min(start, end) < -tolerance_) below.edges.push_back(e);
      if (std::max(start, end) > tolerance_) above.edges.push_back(e);
    }
    const double before = piece.protrusion;
    std::swap(piece, pieces_.back());
    pieces_.pop_back();
    const std::size_t others = pieces_.size();
    add(std::move(below));
    add(std::move(above));
    // Where a surface overlaps itself, a cut may leave no volume on one side and nearly all of the protrusion on the
    // other. It adds no piece, so max_pieces would never end a row of such cuts.
    if (pieces_.size() == others + 1 && pieces_.back().protrusion > 0.9 * before) pieces_.back().final = true;
    return true;
  }

  std::vector<CutPlane> planes_of_edges(const Piece& piece) const {
    std::vector<CutPlane> planes;
    const auto take = [&](std::size_t count, auto&& less) {
      std::vector<std::uint32_t> chosen = piece.edges;
      count = std::min(count, chosen.size());
      std::partial_sort(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(count), chosen.end(), less);
      for (std::size_t i = 0; i < count; ++i) {
        planes.insert(planes.end(), edges_[chosen[i]].planes.begin(), edges_[chosen[i]].planes.end());
      }
    };
    take(nearest_edges, [&](std::uint32_t a, std::uint32_t b) {
      return std::make_pair(distance(edges_[a], piece.worst), a) < std::make_pair(distance(edges_[b], piece.worst), b);
    });
    take(strongest_edges, [&](std::uint32_t a, std::uint32_t b) {
      return std::make_pair(-edges_[a].strength, a) < std::make_pair(-edges_[b].strength, b);
    });
    return planes;
  }

  /// Across the piece's own axes and those of the model, through a point.
  std::vector<CutPlane> planes_across(const Piece& piece, const Vec3& point) const {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& v : piece.hull.vertices) mean += v / static_cast<double>(piece.hull.vertices.size());
    Mat3 spread = Mat3::Zero();
    for (const Vec3& v : piece.hull.vertices) spread += (v - mean) * (v - mean).transpose();
    const Mat3 axes = Eigen::SelfAdjointEigenSolver<Mat3>(spread).eigenvectors();
    std::vector<CutPlane> planes;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Vec3& normal : {Vec3(axes.col(axis)), Vec3(Vec3::Unit(axis))}) {
        planes.push_back(plane_through(point, normal));
      }
    }
    return planes;
  }

  std::vector<ConcaveEdge> edges_;
  const SolidMeasure& measure_;
  double tolerance_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::pair<Mesh, Mesh> clip(const Mesh& surface, const CutPlane& plane, double tolerance) {
  constexpr std::uint32_t none = 0xffffffffu;
  BIN_SCENES_ASSERT(is_unit(plane.normal) && tolerance >= 0.0);
  std::pair<Mesh, Mesh> sides;
  std::vector<double> height(surface.vertices.size());
  std::vector<int> side(surface.vertices.size());
  for (std::size_t v = 0; v < height.size(); ++v) {
    height[v] = plane.height(surface.vertices[v]);
    side[v] = height[v] < -tolerance ? -1 : height[v] > tolerance ? 1 : 0;
  }
  std::array<std::vector<std::uint32_t>, 2> renamed{std::vector<std::uint32_t>(height.size(), none),
                                                    std::vector<std::uint32_t>(height.size(), none)};
  const auto old_vertex = [&](int which, std::uint32_t v) {
    Mesh& mesh = which ? sides.second : sides.first;
    if (renamed[which][v] == none) {
      renamed[which][v] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(surface.vertices[v]);
    }
    return renamed[which][v];
  };
  // Looked up by key only: its order decides nothing.
  std::array<std::unordered_map<std::uint64_t, std::uint32_t>, 2> crossings;
  const auto crossing = [&](int which, std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    Mesh& mesh = which ? sides.second : sides.first;
    const auto [entry, added] = crossings[which].try_emplace((static_cast<std::uint64_t>(low) << 32) | high,
                                                             static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) {
      const double part = height[low] / (height[low] - height[high]);
      mesh.vertices.push_back(surface.vertices[low] + part * (surface.vertices[high] - surface.vertices[low]));
    }
    return entry->second;
  };
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    const std::array<int, 3> s{side[t[0]], side[t[1]], side[t[2]]};
    const bool flat = s[0] == 0 && s[1] == 0 && s[2] == 0;
    const int lowest = std::min({s[0], s[1], s[2]}), highest = std::max({s[0], s[1], s[2]});
    for (int which = 0; which < 2; ++which) {
      const int mine = which ? 1 : -1;
      if (flat ? (surface.area_vector(i).dot(plane.normal) > 0) != (which == 0) : (which ? highest : -lowest) <= 0) {
        continue;
      }
      std::array<std::uint32_t, 4> polygon;
      int corners = 0;
      for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        if (s[k] != -mine) polygon[corners++] = old_vertex(which, t[k]);
        if (s[k] * s[next] < 0) polygon[corners++] = crossing(which, t[k], t[next]);
      }
      Mesh& mesh = which ? sides.second : sides.first;
      for (int k = 1; k + 1 < corners; ++k) {
        mesh.triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
      }
    }
  }
  BIN_SCENES_ASSERT(indices_in_range(sides.first) && indices_in_range(sides.second));
  return sides;
}

std::vector<std::vector<Vec3>> plane_cut_pieces(const Mesh& mesh, const SolidMeasure& measure, double limit,
                                                int max_pieces) {
  Cutter cutter(mesh, measure);
  cutter.run(limit, max_pieces);
  return cutter.points();
}

}  // namespace bin_scenes
