#include "bin_scenes/pour/spawn.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

Aabb posed_bounds(const Mesh& mesh, const Quat& orientation) {
  const Mat3 rotation = orientation.toRotationMatrix();
  Aabb box;
  for (const Vec3& v : mesh.vertices) box.extend(Vec3(rotation * v));
  return box;
}

/// Between the walls, with its centre of mass in their middle.
bool fits(const PartModel& part, const Quat& orientation, const Vec3& size) {
  const Aabb bounds = posed_bounds(part.mesh(), orientation);
  const Vec3 center = orientation * part.mass().center;
  const Vec3 reach = (bounds.upper - center).cwiseMax(center - bounds.lower);
  return 2.0 * reach.x() <= size.x() && 2.0 * reach.y() <= size.y();
}

/// Adds the pieces of a triangle, none longer than `edge`, to the cells their middles lie in.
void scatter(const std::array<Vec3, 3>& triangle, const Aabb& bounds, double edge, const std::array<int, 3>& counts,
             std::vector<Aabb>& cells) {
  const auto& [a, b, c] = triangle;
  const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
  if (const double longest = std::max({ab, bc, ca}); longest > edge) {
    const int k = longest == ab ? 0 : longest == bc ? 1 : 2;
    const Vec3 &p = triangle[k], &q = triangle[(k + 1) % 3], &r = triangle[(k + 2) % 3], middle = 0.5 * (p + q);
    scatter({p, middle, r}, bounds, edge, counts, cells);
    scatter({middle, q, r}, bounds, edge, counts, cells);
    return;
  }
  const Vec3 at = ((a + b + c) / 3.0 - bounds.lower) / edge;
  std::size_t cell = 0;
  for (int k = 2; k >= 0; --k)
    cell = cell * counts[k] + static_cast<std::size_t>(std::clamp(static_cast<int>(at[k]), 0, counts[k] - 1));
  for (const Vec3& v : triangle) cells[cell].extend(v);
}

/// Height by which ball b must stand above its height now to clear ball a; -infinity if it passes beside it.
double lift(const Vec3& a, double ra, const Vec3& b, double rb) {
  const double reach = ra + rb, beside = (a - b).head<2>().squaredNorm();
  if (beside >= reach * reach) return -std::numeric_limits<double>::infinity();
  return a.z() - b.z() + std::sqrt(reach * reach - beside);
}

}  // namespace

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
  return result;
}

std::optional<Pose> Rain::place(const PartModel& part, const Cover& shape, const std::vector<Obstacle>& obstacles,
                                Random& random, int tries) const {
  std::optional<Pose> best;
  std::vector<Vec3> own(shape.balls.size());  // where its balls are, this try
  for (int t = 0; t < tries; ++t) {
    Pose pose;
    pose.orientation = random.orientation();
    const double u = random.uniform(), v = random.uniform();  // drawn before any test: one try, one set of numbers
    const Aabb bounds = posed_bounds(part.mesh(), pose.orientation);
    const Vec3 lower = opening_.lower - bounds.lower, upper = opening_.upper - bounds.upper;
    if (lower.x() > upper.x() || lower.y() > upper.y()) continue;  // this way it does not fit between the walls
    pose.position = {lower.x() + u * (upper.x() - lower.x()), lower.y() + v * (upper.y() - lower.y()), 0.0};

    double clear = opening_.lower.z() - bounds.lower.z(), heap = clear;
    const Vec3 middle = pose * shape.center;
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = pose * shape.balls[i].center;
    for (const Obstacle& other : obstacles) {
      const Vec3 center = other.pose * other.cover->center;
      const double highest = lift(center, other.cover->radius, middle, shape.radius);
      if (highest <= (other.settled ? heap : clear)) continue;
      for (const Cover::Ball& a : other.cover->balls) {
        const Vec3 ball = other.pose * a.center;
        if (lift(ball, a.radius, middle, shape.radius) <= (other.settled ? heap : clear)) continue;
        for (std::size_t i = 0; i < own.size(); ++i) {
          const double height = lift(ball, a.radius, own[i], shape.balls[i].radius);
          clear = std::max(clear, height);
          if (other.settled) heap = std::max(heap, height);
        }
      }
    }
    if (clear > heap + drop_height_) continue;  // something is still falling there
    pose.position.z() = clear + drop_height_;
    if (pose.position.z() + bounds.lower.z() > opening_.upper.z() + drop_height_) continue;  // full up to the rim
    if (!best || pose.position.z() < best->position.z()) best = pose;
  }
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
  std::vector<Pose> poses;
  poses.reserve(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
    const Vec3 center(0.5 * (opening.lower.x() + opening.upper.x()) + (x - 0.5 * (nx - 1.0)) * cell,
                      0.5 * (opening.lower.y() + opening.upper.y()) + (y - 0.5 * (ny - 1.0)) * cell,
                      opening.upper.z() + (z + 0.5) * cell);
    // A part longer than the opening is wide only fits some ways round.
    Quat orientation = random.orientation();
    for (int turn = 0; turn < 64 && !fits(*parts[i], orientation, size); ++turn) orientation = random.orientation();
    poses.push_back({center - orientation * parts[i]->mass().center, orientation});
  }
  return poses;
}

}  // namespace bin_scenes
