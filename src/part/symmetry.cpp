/// Tries the axes of symmetry_axes.hpp and measures how far the turned surface lies from the surface. Turns that pass
/// are completed to a group.
#include "bin_scenes/part/symmetry.hpp"

#include "core/in_parallel.hpp"
#include "symmetry_axes.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr std::size_t most_points = 600;      ///< of the surface that are moved at first
constexpr std::size_t many_vertices = 10000;  ///< that leave no part of a surface without one
constexpr int highest_order = 100;            ///< of a discrete symmetry
constexpr double nearly = 3.0;                ///< times the limit
constexpr double none = std::numeric_limits<double>::infinity();

/// Points all over the surface: vertices, and of meshes with few of them the centers of faces, since large faces have
/// few vertices.
std::vector<Vec3> surface_points(const Mesh& mesh) {
  std::vector<Vec3> points = mesh.vertices;
  if (points.size() > many_vertices) return points;
  for (const Triangle& t : mesh.triangles)
    points.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0);
  return points;
}

std::vector<Vec3> some_of(const std::vector<Vec3>& points) {
  const std::size_t step = points.size() / most_points + 1;
  std::vector<Vec3> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

struct Axis {
  Vec3 direction = Vec3::UnitZ();
  int order = 1;       ///< 0: any angle
  double error = 0.0;  ///< m
};

class Search {
 public:
  Search(const PartModel& part, double tolerance)
      : part_(part),
        center_(part.mass().center),
        all_(surface_points(part.mesh())),
        some_(some_of(all_)),
        limit_(tolerance * part.diagonal()) {}

  /// How far the turned surface lies from the surface (m), infinite beyond `cap`: by points all over it.
  double error(const Quat& turn, double cap) const { return error(some_, turn, cap); }
  /// The same by every point, so that no mark is missed; no more than the limit, or infinite.
  double exact_error(const Quat& turn) const {
    if (error(some_, turn, limit_) == none) return none;
    constexpr std::size_t at_once = 2048;
    std::vector<double> errors((all_.size() + at_once - 1) / at_once, 0.0);
    in_parallel(errors.size(), [&](std::size_t i) {
      const auto begin = all_.begin() + static_cast<std::ptrdiff_t>(i * at_once);
      const auto end = all_.begin() + static_cast<std::ptrdiff_t>(std::min(all_.size(), (i + 1) * at_once));
      errors[i] = error(std::vector<Vec3>(begin, end), turn, limit_);
    });
    return *std::max_element(errors.begin(), errors.end());
  }

  Axis examine(const Vec3& direction) const {
    const auto turned = [&](double angle) { return Quat(Eigen::AngleAxisd(angle, direction)); };
    // Angles that no order up to the highest has in common: a part that passes all of them is round.
    double round = 0.0;
    for (const double angle : {1.0, 0.37, 2.3})
      if (round < none) round = std::max(round, exact_error(turned(angle)));
    if (round < none) return {direction, 0, round};
    for (int n = highest_order; n > 1; --n) {
      // A small turn moves nothing far: the others of its order have to hold as well.
      bool all = true;
      for (int k = 1; k <= n / 2 && all; ++k) all = error(some_, turned(2.0 * M_PI * k / n), limit_) < none;
      const double exact = all ? exact_error(turned(2.0 * M_PI / n)) : none;
      if (exact < none) return {direction, n, exact};
    }
    return {direction, 1, 0.0};
  }

  /// The highest order that the axis nearly has, by points all over the part; order 1: none.
  SymmetryReport::Nearly examine_nearly(const Vec3& direction) const {
    for (const int n : {0, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2}) {
      const double error = error_of(some_, direction, n);
      if (error < none) return {direction, n, error};
    }
    return {direction, 1, 0.0};
  }
  /// Its error by every point; infinite beyond what counts as nearly.
  double exact_error(const SymmetryReport::Nearly& axis) const { return error_of(all_, axis.direction, axis.order); }

  Pose about_center(const Quat& turn) const { return {center_ - turn * center_, turn}; }
  const Vec3& center() const { return center_; }
  double limit() const { return limit_; }

 private:
  /// Of the turns of an order, 0: any angle; infinite beyond what counts as nearly.
  double error_of(const std::vector<Vec3>& points, const Vec3& direction, int order) const {
    std::vector<double> angles = {1.0, 0.37, 2.3};
    if (order > 0) angles.clear();
    for (int k = 1; k <= order / 2; ++k) angles.push_back(2.0 * M_PI * k / order);
    double worst = 0.0;
    for (const double angle : angles) {
      worst = std::max(worst, error(points, Quat(Eigen::AngleAxisd(angle, direction)), nearly * limit_));
      if (worst == none) break;
    }
    return worst;
  }
  double error(const std::vector<Vec3>& points, const Quat& turn, double cap) const {
    double worst = 0.0;
    for (const Vec3& point : points) {
      worst = std::max(worst, part_.query().nearest(center_ + turn * (point - center_), cap).distance);
      if (!(worst <= cap)) return none;
    }
    return worst;
  }

  const PartModel& part_;
  Vec3 center_;
  std::vector<Vec3> all_, some_;
  double limit_;
};

double angle_between(const Quat& a, const Quat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(a.dot(b))));
}

/// The turns after which the part looks the same, without the identity.
class Group {
 public:
  Group(const Search& search, double tolerance) : search_(search), one_angle_(std::max(0.02, 2.0 * tolerance)) {}

  bool near(const Quat& turn, double angle) const {
    return std::any_of(turns_.begin(), turns_.end(), [&](const Quat& q) { return angle_between(q, turn) < angle; });
  }
  /// With all products; nothing is added where one of them is no symmetry: then the axis stands beside the one that is
  /// meant, by what the tolerance allows.
  void add(const Axis& axis) {
    std::vector<Quat> grown = turns_;
    for (int k = 1; k < axis.order; ++k) {
      const Quat turn(Eigen::AngleAxisd(2.0 * M_PI * k / axis.order, axis.direction));
      if (!near(turn, one_angle_)) grown.push_back(turn);
    }
    if (grown.size() == turns_.size() || !close(grown)) return;
    turns_ = grown;
  }
  const std::vector<Quat>& turns() const { return turns_; }

 private:
  bool close(std::vector<Quat>& turns) const {
    constexpr std::size_t largest = 2 * highest_order;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        for (const Quat& next : {(turns[i] * turns[j]).normalized(), (turns[j] * turns[i]).normalized()}) {
          const auto is_one = [&](const Quat& q) { return angle_between(q, next) < one_angle_; };
          if (is_one(Quat::Identity()) || std::any_of(turns.begin(), turns.end(), is_one)) continue;
          if (turns.size() >= largest || !holds(next)) return false;
          turns.push_back(next);
        }
      }
    }
    return true;
  }
  /// A small turn moves nothing far: its multiples have to hold as well.
  bool holds(const Quat& turn) const {
    constexpr double no_longer_small = 0.6;  // rad
    Quat power = turn;
    for (int k = 0; k < highest_order; ++k) {
      if (search_.error(power, search_.limit()) == none) return false;
      if (angle_between(power, Quat::Identity()) > no_longer_small) return true;
      power = (power * turn).normalized();
    }
    return false;
  }

  const Search& search_;
  double one_angle_;  ///< rad: turns that differ by less are one
  std::vector<Quat> turns_;
};

/// The best ones, away from what is a symmetry and from each other.
void thin_out(std::vector<SymmetryReport::Nearly>& nearly, const std::vector<Axis>& axes, const Group& group) {
  constexpr double apart = 0.5;  // rad
  const auto turn_of = [](const SymmetryReport::Nearly& axis) {
    return Quat(Eigen::AngleAxisd(axis.order == 0 ? 1.0 : 2.0 * M_PI / axis.order, axis.direction));
  };
  std::stable_sort(nearly.begin(), nearly.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
  std::vector<SymmetryReport::Nearly> kept;
  for (const SymmetryReport::Nearly& one : nearly) {
    const bool round = std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) {
      const double along = std::abs(axis.direction.dot(one.direction));
      return axis.order == 0 && (along < 0.1 || along > 0.9);
    });
    const auto beside = [&](const auto& other) { return angle_between(turn_of(other), turn_of(one)) < apart; };
    if (!round && !group.near(turn_of(one), apart) && std::none_of(kept.begin(), kept.end(), beside))
      kept.push_back(one);
  }
  nearly = kept;
}

/// Whether an axis adds nothing to those found. Across a round axis one direction is as good as any
/// other, and beside it there is none. Across an axis of order n, above 4, lie axes of order 2 alone, pi / n apart: one
/// shows where all are. (Order 4 has others across it in a cube.)
bool is_implied(const Vec3& direction, const std::vector<Axis>& axes, const std::vector<Vec3>& examined) {
  constexpr double across = 0.02;  // rad, nearly
  const auto is_across = [&](const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) < across; };
  for (const Axis& main : axes) {
    if (main.order == 0) {
      if (!is_across(main.direction, direction)) return true;
      if (std::any_of(examined.begin(), examined.end(), [&](const Vec3& e) { return is_across(main.direction, e); }))
        return true;
    }
    if (main.order < 5 || !is_across(main.direction, direction)) continue;
    for (const Axis& other : axes) {
      if (other.order != 2 || !is_across(main.direction, other.direction)) continue;
      const double angle =
          std::atan2(main.direction.dot(other.direction.cross(direction)), other.direction.dot(direction));
      const double apart = M_PI / main.order;
      if (std::abs(std::remainder(angle, apart)) < std::min(across, 0.1 * apart)) return true;
    }
  }
  return false;
}

}  // namespace

SymmetryReport examine_symmetries(const PartModel& part, double tolerance) {
  SymmetryReport report;
  Symmetries& found = report.symmetries;
  const Search search(part, tolerance);
  report.limit = search.limit();
  std::vector<Axis> axes;
  std::vector<Vec3> examined;
  for (const Vec3& direction : candidate_axes(part)) {
    const auto along = [&](const auto& axis) { return std::abs(axis.direction.dot(direction)) > 0.999; };
    const auto known = std::find_if(axes.begin(), axes.end(), along);
    if (known != axes.end() && known->order == 0) continue;
    if (known == axes.end() && is_implied(direction, axes, examined)) continue;
    examined.push_back(direction);
    const Axis axis = search.examine(direction);
    if (known != axes.end()) {
      // Of axes within the tolerance of each other one is meant: the more exact one.
      constexpr double clearly = 0.9;
      if (axis.order == 0 || (axis.order >= known->order && axis.error < clearly * known->error)) *known = axis;
    } else if (axis.order != 1) {
      axes.push_back(axis);
      const auto round = [](const Axis& one) { return one.order == 0; };
      if (std::count_if(axes.begin(), axes.end(), round) == 2) break;  // a ball, which two axes describe
    } else if (std::none_of(report.nearly.begin(), report.nearly.end(), along)) {
      const SymmetryReport::Nearly close = search.examine_nearly(direction);
      if (close.order != 1) report.nearly.push_back(close);
    }
  }
  std::stable_sort(axes.begin(), axes.end(), [](const Axis& a, const Axis& b) { return a.order > b.order; });
  Group group(search, tolerance);
  for (const Axis& axis : axes) {
    if (axis.order > 0) group.add(axis);
    if (axis.order > 0) continue;
    found.continuous.push_back({axis.direction, search.center()});
    report.continuous_error.push_back(axis.error);
  }
  thin_out(report.nearly, axes, group);
  for (SymmetryReport::Nearly& axis : report.nearly) axis.error = search.exact_error(axis);
  const auto far = [](const SymmetryReport::Nearly& axis) { return axis.error == none; };
  report.nearly.erase(std::remove_if(report.nearly.begin(), report.nearly.end(), far), report.nearly.end());
  std::vector<Quat> turns = group.turns();
  if (!found.continuous.empty()) {
    // Around a round axis one half turn across it says all: the others are that one, turned about the axis.
    const Vec3 axis = found.continuous[0].direction;
    const auto across = [&](const Quat& q) { return std::abs(q.vec().normalized().dot(axis)) < 0.05; };
    turns.erase(std::remove_if(turns.begin(), turns.end(), [&](const Quat& q) { return !across(q); }), turns.end());
    if (turns.size() > 1) turns.resize(1);
  }
  for (const Quat& turn : turns) {
    const double error = search.error(turn, search.limit());
    if (error == none) continue;
    found.discrete.push_back(search.about_center(turn));
    report.discrete_error.push_back(error);
  }
  BIN_SCENES_ASSERT(report.continuous_error.size() == found.continuous.size());
  BIN_SCENES_ASSERT(report.discrete_error.size() == found.discrete.size());
  BIN_SCENES_ASSERT(each_is(found.continuous, [](const Symmetries::Axis& axis) { return is_unit(axis.direction); }));
  BIN_SCENES_ASSERT(each_is(found.discrete, is_rigid));
  BIN_SCENES_ASSERT(each_is(report.discrete_error, [&](double error) { return error <= report.limit; }));
  return report;
}

Symmetries find_symmetries(const PartModel& part, double tolerance) {
  return examine_symmetries(part, tolerance).symmetries;
}

double diameter(const Mesh& mesh) {
  // Only vertices far from the centre can be ends of the longest distance: in order of that, most pairs are never
  // tried.
  const Vec3 center = mesh.bounds().center();
  std::vector<std::pair<double, const Vec3*>> far;
  for (const Vec3& vertex : mesh.vertices) far.emplace_back((vertex - center).norm(), &vertex);
  std::sort(far.begin(), far.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  double longest = 0.0;
  for (std::size_t i = 0; i < far.size() && 2.0 * far[i].first > longest; ++i)
    for (std::size_t j = i + 1; j < far.size() && far[i].first + far[j].first > longest; ++j)
      longest = std::max(longest, (*far[i].second - *far[j].second).norm());
  return longest;
}

}  // namespace bin_scenes
