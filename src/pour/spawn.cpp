/// A part enters at the lowest place above what is there, found by balls that cover both, after several tries of turn
/// and place. Or parts stand on a grid.
#include "bin_scenes/pour/spawn.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace bin_scenes {

namespace {

Aabb posed_bounds(const PartModel& part, const Quat& orientation) {
  const Mat3 rotation = orientation.toRotationMatrix();
  Aabb box;
  for (const Vec3& v : part.corners()) box.extend(Vec3(rotation * v));
  return box;
}

/// Between the walls, with its centre of mass in their centre.
bool fits(const PartModel& part, const Quat& orientation, const Vec3& size) {
  const Aabb bounds = posed_bounds(part, orientation);
  const Vec3 center = orientation * part.mass().center;
  const Vec3 reach = (bounds.upper - center).cwiseMax(center - bounds.lower);
  return 2.0 * reach.x() <= size.x() && 2.0 * reach.y() <= size.y();
}

/// Adds the pieces of a triangle, none longer than `edge`, to the cells their centers lie in.
void scatter(const std::array<Vec3, 3>& triangle, const Aabb& bounds, double edge, const std::array<int, 3>& counts,
             std::vector<Aabb>& cells) {
  const auto& [a, b, c] = triangle;
  const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
  if (const double longest = std::max({ab, bc, ca}); longest > edge) {
    const int k = longest == ab ? 0 : longest == bc ? 1 : 2;
    const Vec3 &p = triangle[k], &q = triangle[(k + 1) % 3], &r = triangle[(k + 2) % 3], mid = 0.5 * (p + q);
    scatter({p, mid, r}, bounds, edge, counts, cells);
    scatter({mid, q, r}, bounds, edge, counts, cells);
    return;
  }
  const Vec3 at = ((a + b + c) / 3.0 - bounds.lower) / edge;
  std::size_t cell = 0;
  for (int k = 2; k >= 0; --k)
    cell = cell * counts[k] + static_cast<std::size_t>(std::clamp(static_cast<int>(at[k]), 0, counts[k] - 1));
  for (const Vec3& v : triangle) cells[cell].extend(v);
}

struct Turned {
  Quat orientation;
  Aabb bounds;  ///< of the part turned so, its frame at the origin
};

/// Uniform among the orientations that fit between the walls; none if that takes too many draws.
std::optional<Turned> turned_to_fit(const PartModel& part, const Opening& opening, Random& random) {
  constexpr int draws = 64;
  const Vec3 room = opening.upper - opening.lower;
  for (int i = 0; i < draws; ++i) {
    const Quat orientation = random.orientation();
    const Aabb bounds = posed_bounds(part, orientation);
    if (bounds.size().x() <= room.x() && bounds.size().y() <= room.y()) return Turned{orientation, bounds};
  }
  return std::nullopt;
}

/// The sides of the opening, moved inwards so that the frame of a part may go as far as they say.
std::vector<Opening::Side> for_frames(std::vector<Opening::Side> sides, const PartModel& part,
                                      const Quat& orientation) {
  const Mat3 rotation = orientation.toRotationMatrix();
  for (Opening::Side& side : sides) {
    double reach = -std::numeric_limits<double>::infinity();
    for (const Vec3& v : part.corners())
      reach = std::max(reach, rotation.row(0).dot(v) * side.normal_x + rotation.row(1).dot(v) * side.normal_y);
    side.distance -= reach;
  }
  return sides;
}

bool within(const std::vector<Opening::Side>& sides, const Vec3& x) {
  return std::all_of(sides.begin(), sides.end(), [&](const Opening::Side& side) {
    return side.normal_x * x.x() + side.normal_y * x.y() <= side.distance;
  });
}

/// Height by which ball b must stand above its height now to clear ball a; -infinity if it passes beside it.
double lift(const Vec3& a, double ra, const Vec3& b, double rb) {
  const double reach = ra + rb, beside = (a - b).head<2>().squaredNorm();
  if (beside >= reach * reach) return -std::numeric_limits<double>::infinity();
  return a.z() - b.z() + std::sqrt(reach * reach - beside);
}

}  // namespace

std::vector<Opening::Side> outline(const Mesh& mesh) {
  const auto before = [](const Vec3& a, const Vec3& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
  const auto turns_left = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 0.0;
  };
  std::vector<Vec3> points = mesh.vertices, hull;
  std::sort(points.begin(), points.end(), before);
  for (int half = 0; half < 2; ++half) {  // Andrew's monotone chain: there below, and back above
    const std::size_t first = hull.size();
    for (const Vec3& p : points) {
      while (hull.size() >= first + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();  // the other half begins with it
    std::reverse(points.begin(), points.end());
  }
  std::vector<Opening::Side> sides;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec3 &a = hull[i], along = hull[(i + 1) % hull.size()] - a;
    const double length = along.head<2>().norm();
    if (!(length > 0.0)) continue;
    const double x = along.y() / length, y = -along.x() / length;
    BIN_SCENES_ASSERT(is_unit(Vec3(x, y, 0.0)));
    sides.push_back({x, y, x * a.x() + y * a.y()});
  }
  return sides;
}

Cover cover(const Mesh& mesh, int cells) {
  const Aabb bounds = mesh.bounds();
  const double edge = bounds.size().maxCoeff() / cells;
  std::array<int, 3> counts;
  for (int k = 0; k < 3; ++k) counts[k] = std::clamp(static_cast<int>(std::ceil(bounds.size()[k] / edge)), 1, cells);
  std::vector<Aabb> boxes(static_cast<std::size_t>(counts[0]) * counts[1] * counts[2]);
  for (const auto& [a, b, c] : mesh.triangles)
    scatter({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, bounds, edge, counts, boxes);
  Cover result;
  result.center = bounds.center();
  for (const Aabb& box : boxes) {
    if (box.empty()) continue;
    result.balls.push_back({box.center(), 0.5 * box.diagonal()});
    result.radius = std::max(result.radius, (box.center() - result.center).norm() + 0.5 * box.diagonal());
  }
  BIN_SCENES_ASSERT(std::isfinite(result.radius) && (mesh.empty() || !result.balls.empty()));
  return result;
}

void Rain::add(const Cover& cover, const Pose& pose, bool settled) {
  const Vec3 center = pose * cover.center;
  const std::pair<double, std::size_t> entry(center.z() + cover.radius, obstacles_.size());
  BIN_SCENES_ASSERT(is_rigid(pose));
  obstacles_.push_back({&cover, pose, settled, center, {}});
  order_.insert(sorted_ ? std::upper_bound(order_.begin(), order_.end(), entry, std::greater<>()) : order_.end(),
                entry);
}

void Rain::sort() {
  if (sorted_) return;
  std::sort(order_.begin(), order_.end(), std::greater<>());
  sorted_ = true;
}

const std::vector<Vec3>& Rain::balls_of(Obstacle& obstacle) {
  if (obstacle.balls.empty())
    for (const Cover::Ball& ball : obstacle.cover->balls) obstacle.balls.push_back(obstacle.pose * ball.center);
  return obstacle.balls;
}

std::optional<Pose> Rain::place(const PartModel& part, const Cover& shape, Random& random, int tries) {
  // One orientation for all tries: the lowest of several would stand and hang where its frame lies low.
  const auto turned = turned_to_fit(part, opening_, random);
  if (!turned) return std::nullopt;
  const auto& [orientation, bounds] = *turned;
  const Vec3 lower = opening_.lower - bounds.lower, upper = opening_.upper - bounds.upper;
  const std::vector<Opening::Side> sides = for_frames(opening_.sides, part, orientation);
  std::optional<Pose> best;
  std::vector<Cover::Ball> own = shape.balls;  // turned, the lowest first
  for (Cover::Ball& ball : own) ball.center = orientation * ball.center;
  std::sort(own.begin(), own.end(), [](const Cover::Ball& a, const Cover::Ball& b) {
    return a.center.z() - a.radius < b.center.z() - b.radius;
  });
  constexpr double rounding = 1e-12;  // m: of the bound below, which falls from ball to ball but for this
  sort();
  for (int t = 0; t < tries; ++t) {
    const double u = random.uniform(), v = random.uniform();  // drawn before any test: one try, one set of numbers
    Pose pose{{lower.x() + u * (upper.x() - lower.x()), lower.y() + v * (upper.y() - lower.y()), 0.0}, orientation};
    if (!within(sides, pose.position)) continue;

    double clear = opening_.lower.z() - bounds.lower.z(), heap = clear;
    const Vec3 mid = pose * shape.center;
    const auto too_high = [&] {
      const double z = clear + drop_height_;
      return (best && z >= best->position.z()) || z + bounds.lower.z() > opening_.upper.z() + drop_height_;
    };
    for (const auto& [top, number] : order_) {  // the highest first, so that most of those below need no test
      if (too_high() || top - mid.z() + shape.radius < heap) break;
      Obstacle& other = obstacles_[number];
      const double& known = other.settled ? heap : clear;
      if (lift(other.center, other.cover->radius, mid, shape.radius) <= known) continue;
      const std::vector<Vec3>& balls = balls_of(other);
      for (std::size_t k = 0; k < balls.size(); ++k) {
        const Vec3& ball = balls[k];
        const double radius = other.cover->balls[k].radius;
        if (lift(ball, radius, mid, shape.radius) <= known) continue;
        for (const Cover::Ball& mine : own) {
          if (ball.z() - mine.center.z() + radius + mine.radius < known - rounding) break;
          const double height = lift(ball, radius, pose.position + mine.center, mine.radius);
          clear = std::max(clear, height);
          if (other.settled) heap = std::max(heap, height);
        }
      }
    }
    if (too_high()) continue;                   // no better than an earlier try, or full up to the rim
    if (clear > heap + drop_height_) continue;  // something is still falling there
    pose.position.z() = clear + drop_height_;
    best = pose;
  }
  BIN_SCENES_ASSERT(!best || is_rigid(*best));
  return best;
}

std::vector<Pose> grid_poses(const std::vector<const PartModel*>& parts, const Opening& opening, double spacing,
                             Random& random) {
  double diameter = 0.0;
  for (const PartModel* part : parts) diameter = std::max(diameter, 2.0 * part->radius());
  const double cell = spacing * diameter;
  const Vec3 size = opening.upper - opening.lower;
  const auto columns = [&](double length) { return std::max<std::size_t>(1, static_cast<std::size_t>(length / cell)); };
  const std::size_t nx = columns(size.x()), ny = columns(size.y());
  std::vector<Opening::Side> sides = opening.sides;
  for (Opening::Side& side : sides) side.distance -= 0.5 * diameter;
  const Vec3 mid = 0.5 * (opening.lower + opening.upper);
  std::vector<Vec3> places;  // of the columns, on the rim
  for (std::size_t y = 0; y < ny; ++y)
    for (std::size_t x = 0; x < nx; ++x) {
      const Vec3 place(mid.x() + (x - 0.5 * (nx - 1.0)) * cell, mid.y() + (y - 0.5 * (ny - 1.0)) * cell,
                       opening.upper.z());
      if (within(sides, place)) places.push_back(place);
    }
  if (places.empty()) places.emplace_back(mid.x(), mid.y(), opening.upper.z());
  std::vector<Pose> poses;
  poses.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t layer = i / places.size();
    const Vec3 center = places[i % places.size()] + Vec3(0.0, 0.0, (layer + 0.5) * cell);
    // A part longer than the opening is wide only fits in some orientations.
    Quat orientation = random.orientation();
    for (int turn = 0; turn < 64 && !fits(*parts[i], orientation, size); ++turn) orientation = random.orientation();
    poses.push_back({center - orientation * parts[i]->mass().center, orientation});
  }
  BIN_SCENES_ASSERT(poses.size() == parts.size() && each_is(poses, is_rigid));
  return poses;
}

}  // namespace bin_scenes
