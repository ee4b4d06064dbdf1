#include "bin_scenes/part/symmetry.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr double equal_moments = 0.02;    ///< relative difference up to which an axis between two is tried
constexpr int directions_between = 48;    ///< of those that are tried over half a turn
constexpr std::size_t most_points = 600;  ///< of the surface that are moved
constexpr int highest_order = 12;         ///< of a discrete symmetry; from there on a part counts as round

/// Points all over the surface: vertices, and the middles of faces, since large faces have few vertices.
std::vector<Vec3> surface_points(const Mesh& mesh) {
  std::vector<Vec3> points = mesh.vertices;
  for (const Triangle& t : mesh.triangles)
    points.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
  const std::size_t step = points.size() / most_points + 1;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

class Search {
 public:
  Search(const PartModel& part, double tolerance)
      : part_(part),
        center_(part.mass().center),
        points_(surface_points(part.mesh())),
        limit_(tolerance * part.diagonal()) {}

  bool symmetric(const Quat& turn) const {
    return std::all_of(points_.begin(), points_.end(), [&](const Vec3& point) {
      return part_.query().nearest(center_ + turn * (point - center_), limit_).distance <= limit_;
    });
  }
  /// The order of the axis: 0 = any angle, 1 = none.
  int order(const Vec3& axis) const {
    const auto turned = [&](double angle) { return symmetric(Quat(Eigen::AngleAxisd(angle, axis))); };
    // Angles that no order up to the highest has in common: a part that passes all of them is round.
    if (turned(1.0) && turned(0.37) && turned(2.3)) return 0;
    for (int n = highest_order; n > 1; --n)
      if (turned(2.0 * M_PI / n)) return n;
    return 1;
  }
  Pose about_center(const Quat& turn) const { return {center_ - turn * center_, turn}; }
  const Vec3& center() const { return center_; }

 private:
  const PartModel& part_;
  Vec3 center_;
  std::vector<Vec3> points_;
  double limit_;
};

/// Axes of inertia, and axes between two with equal moments: there the principal axes are no more special than others.
std::vector<Vec3> candidates(const PartModel& part) {
  const Vec3 moments = part.mass().principal;
  const Mat3 axes = part.mass().principal_axes.toRotationMatrix();
  std::vector<Vec3> all = {axes.col(0), axes.col(1), axes.col(2), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (int i = 0; i < 3; ++i) {
    const int a = i, b = (i + 1) % 3;
    if (std::abs(moments[a] - moments[b]) > equal_moments * moments.maxCoeff()) continue;
    for (int k = 1; k < directions_between; ++k) {
      const double angle = M_PI * k / directions_between;
      all.push_back(std::cos(angle) * axes.col(a) + std::sin(angle) * axes.col(b));
    }
  }
  std::vector<Vec3> distinct;
  for (const Vec3& axis : all) {
    const bool known = std::any_of(distinct.begin(), distinct.end(),
                                   [&](const Vec3& other) { return std::abs(axis.dot(other)) > 1.0 - 1e-6; });
    if (!known) distinct.push_back(axis);
  }
  return distinct;
}

bool same(const Quat& a, const Quat& b) {
  return std::abs(a.dot(b)) > 1.0 - 1e-4;
}

/// All products of the rotations found: the group that they span.
std::vector<Quat> closed(std::vector<Quat> turns) {
  constexpr std::size_t largest_group = 60;  // of the icosahedron; more: rounding has run away
  for (std::size_t i = 0; i < turns.size() && turns.size() <= largest_group; ++i) {
    for (std::size_t j = 0; j <= i && turns.size() <= largest_group; ++j) {
      for (const Quat& next : {(turns[i] * turns[j]).normalized(), (turns[j] * turns[i]).normalized()}) {
        const bool known = same(next, Quat::Identity()) ||
                           std::any_of(turns.begin(), turns.end(), [&](const Quat& q) { return same(q, next); });
        if (!known) turns.push_back(next);
      }
    }
  }
  return turns;
}

}  // namespace

Symmetries find_symmetries(const PartModel& part, double tolerance) {
  Symmetries found;
  const Search search(part, tolerance);
  std::vector<Quat> turns;
  for (const Vec3& axis : candidates(part)) {
    const auto along = [&](const Symmetries::Axis& round) { return std::abs(round.direction.dot(axis)) > 0.999; };
    if (std::any_of(found.continuous.begin(), found.continuous.end(), along)) continue;
    const int order = search.order(axis);
    if (order == 0) found.continuous.push_back({axis, search.center()});
    for (int k = 1; k < order; ++k) {
      const Quat turn(Eigen::AngleAxisd(2.0 * M_PI * k / order, axis));
      if (std::none_of(turns.begin(), turns.end(), [&](const Quat& q) { return same(q, turn); })) turns.push_back(turn);
    }
  }
  if (!found.continuous.empty()) {
    // Around a round axis one half turn across it says all: the others are that one, turned about the axis.
    const Vec3 axis = found.continuous[0].direction;
    const auto across = [&](const Quat& q) { return std::abs(q.vec().normalized().dot(axis)) < 0.05; };
    turns.erase(std::remove_if(turns.begin(), turns.end(), [&](const Quat& q) { return !across(q); }), turns.end());
    if (turns.size() > 1) turns.resize(1);
  } else {
    turns = closed(turns);
    turns.erase(std::remove_if(turns.begin(), turns.end(), [&](const Quat& q) { return !search.symmetric(q); }),
                turns.end());
  }
  for (const Quat& turn : turns) found.discrete.push_back(search.about_center(turn));
  return found;
}

double diameter(const Mesh& mesh) {
  // Only vertices far from the middle can be ends of the longest distance: in order of that, most pairs are never
  // tried.
  const Vec3 middle = mesh.bounds().center();
  std::vector<std::pair<double, const Vec3*>> far;
  for (const Vec3& vertex : mesh.vertices) far.emplace_back((vertex - middle).norm(), &vertex);
  std::sort(far.begin(), far.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  double longest = 0.0;
  for (std::size_t i = 0; i < far.size() && 2.0 * far[i].first > longest; ++i)
    for (std::size_t j = i + 1; j < far.size() && far[i].first + far[j].first > longest; ++j)
      longest = std::max(longest, (*far[i].second - *far[j].second).norm());
  return longest;
}

}  // namespace bin_scenes
