/// A search for free grasps of two fingers by other geometry than the library's: columns of points instead of meshes
/// against meshes, rays against all triangles, and triangles clipped at the sides of boxes. Slow and plain.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "stage.hpp"

#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace bin_scenes::test {

class BruteForce {
 public:
  using Corners = std::array<Vec3, 3>;

  explicit BruteForce(const Stage& stage, std::size_t gripper = 0)
      : stage_(stage), gripper_(stage.loaded.request.grippers[gripper]) {
    for (const ScenePart& part : stage.scene.parts) {
      const Mesh& mesh = stage.loaded.parts[part.line]->mesh();
      bodies_.emplace_back();
      for (const Triangle& t : mesh.triangles)
        bodies_.back().push_back(
            {part.pose * mesh.vertices[t[0]], part.pose * mesh.vertices[t[1]], part.pose * mesh.vertices[t[2]]});
    }
  }

  /// Whether nothing of another part is above any point of this one, in columns of a grid of half a millimetre.
  bool uncovered(int id) const {
    using Cell = std::pair<long, long>;
    std::map<Cell, double> lowest;
    each_column(bodies_[index(id)], [&](const Cell& cell, double z) {
      const auto [at, is_new] = lowest.insert({cell, z});
      if (!is_new) at->second = std::min(at->second, z);
    });
    bool covered = false;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (i == index(id)) continue;
      each_column(bodies_[i], [&](const Cell& cell, double z) {
        const auto at = lowest.find(cell);
        covered = covered || (at != lowest.end() && z > at->second + 1e-4);
      });
    }
    return !covered;
  }

  /// The first free grasp that is found: pose and width. `tried` counts the poses.
  std::optional<std::pair<Pose, double>> free_grasp(int id, int points, std::size_t& tried) const {
    const std::vector<Corners>& body = bodies_[index(id)];
    const ScenePart& part = stage_.scene.parts[index(id)];
    const double cone = std::sqrt(gripper_.friction * stage_.loaded.request.parts[part.line].friction);
    Random random(11, static_cast<std::uint64_t>(id), Stream::probe);
    for (int i = 0; i < points; ++i) {
      const auto [start, normal] = surface_point(body, random);
      const auto exit = last_hit(body, start + 1e-7 * -normal, -normal, gripper_.travel());
      if (!exit || exit->second.dot(-normal) < 1.0 / std::hypot(1.0, cone)) continue;
      const Vec3 middle = start - 0.5 * exit->first * normal;
      for (int turn = 0; turn < 24; ++turn) {
        const Vec3 z = Eigen::AngleAxisd(turn * M_PI / 12, normal) * steepest(normal);
        if (std::acos(std::clamp(-z.z(), -1.0, 1.0)) > gripper_.tilt) continue;
        Mat3 frame;
        frame << normal, z.cross(normal), z;
        for (const double back : {0.0, 0.2, 0.35, 0.45}) {
          ++tried;
          Pose pose{middle - back * gripper_.pad_length * z, Quat(frame).normalized()};
          if (const auto width = closes(body, pose, exit->first, cone))
            if (is_free(id, pose, *width)) return std::make_pair(pose, *width);
        }
      }
    }
    return std::nullopt;
  }

 private:
  struct Box {
    Vec3 lower, upper;  ///< gripper's frame
  };

  std::size_t index(int id) const { return static_cast<std::size_t>(id); }

  template <class Use>
  static void each_column(const std::vector<Corners>& body, const Use& use) {
    constexpr double step = 5e-4;
    for (const Corners& t : body) {
      const Eigen::Vector2d a = t[0].head<2>(), b = t[1].head<2>(), c = t[2].head<2>();
      const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
      if (std::abs(area) < 1e-14) continue;
      const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
      for (long i = std::lround(std::ceil(low.x() / step)); i * step <= high.x(); ++i)
        for (long j = std::lround(std::ceil(low.y() / step)); j * step <= high.y(); ++j) {
          const Eigen::Vector2d p(i * step, j * step);
          const double u = ((p - a).x() * (c - a).y() - (p - a).y() * (c - a).x()) / area;
          const double v = ((b - a).x() * (p - a).y() - (b - a).y() * (p - a).x()) / area;
          if (u >= 0.0 && v >= 0.0 && u + v <= 1.0)
            use({i, j}, t[0].z() + u * (t[1].z() - t[0].z()) + v * (t[2].z() - t[0].z()));
        }
    }
  }

  static std::pair<Vec3, Vec3> surface_point(const std::vector<Corners>& body, Random& random) {
    double total = 0.0;
    for (const Corners& t : body) total += (t[1] - t[0]).cross(t[2] - t[0]).norm();
    double at = random.uniform(0.0, total);
    for (const Corners& t : body) {
      const Vec3 area = (t[1] - t[0]).cross(t[2] - t[0]);
      at -= area.norm();
      if (at > 0.0) continue;
      double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      return {t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), area.normalized()};
    }
    return {body[0][0], Vec3::UnitZ()};
  }

  /// Distance and normal of the surface that a ray meets first from its side `facing` (-1: against the ray).
  static std::optional<std::pair<double, Vec3>> hit(const std::vector<Corners>& body, const Vec3& from,
                                                    const Vec3& along, double limit, double facing) {
    std::optional<std::pair<double, Vec3>> best;
    for (const Corners& t : body) {
      const Vec3 area = (t[1] - t[0]).cross(t[2] - t[0]);
      const double fall = area.dot(along);
      if (!(fall * facing > 0.0)) continue;
      const double distance = area.dot(t[0] - from) / fall;
      if (!(distance > 0.0) || distance > limit || (best && distance >= best->first)) continue;
      const Vec3 p = from + distance * along;
      bool inside = true;
      for (int k = 0; k < 3; ++k)
        inside = inside && (t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(area) >= -1e-12 * area.squaredNorm();
      if (inside) best = std::make_pair(distance, area.normalized());
    }
    return best;
  }
  static std::optional<std::pair<double, Vec3>> last_hit(const std::vector<Corners>& body, const Vec3& from,
                                                         const Vec3& along, double limit) {
    return hit(body, from, along, limit, 1.0);
  }

  static Vec3 steepest(const Vec3& axis) {
    const Vec3 down = -Vec3::UnitZ() + axis.z() * axis;
    return down.norm() > 1e-6 ? Vec3(down.normalized()) : axis.unitOrthogonal();
  }

  /// Both pads pressed on as grids of rays: the width at which they touch, and whether they hold.
  std::optional<double> closes(const std::vector<Corners>& body, Pose& pose, double guess, double cone) const {
    constexpr int grid = 7;
    const double opened = std::min(0.5 * guess + gripper_.opening, 0.5 * gripper_.travel());
    std::array<double, 2> height{};
    std::array<std::array<double, 4>, 2> bounds{};
    for (int side = 0; side < 2; ++side) {
      const Vec3 in = pose.orientation * Vec3(side ? 1.0 : -1.0, 0, 0);
      std::vector<std::array<double, 3>> hits;  // height, y, z
      std::vector<Vec3> normals;
      for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
          const double y = (i + 0.5 - 0.5 * grid) / grid * gripper_.finger_width,
                       z = (j + 0.5 - 0.5 * grid) / grid * gripper_.pad_length;
          const Vec3 from = pose * Vec3(0, y, z) - opened * in;
          if (const auto found = hit(body, from, in, opened, -1.0)) {
            hits.push_back({opened - found->first, y, z});
            normals.push_back(found->second);
          }
        }
      if (hits.empty()) return std::nullopt;
      height[side] = 0.0;
      for (const auto& h : hits) height[side] = std::max(height[side], h[0]);
      Vec3 normal = Vec3::Zero();
      bounds[side] = {1.0, -1.0, 1.0, -1.0};
      for (std::size_t k = 0; k < hits.size(); ++k) {
        if (hits[k][0] < height[side] - gripper_.pad_give) continue;
        normal += normals[k];
        bounds[side] = {std::min(bounds[side][0], hits[k][1]), std::max(bounds[side][1], hits[k][1]),
                        std::min(bounds[side][2], hits[k][2]), std::max(bounds[side][2], hits[k][2])};
      }
      if (-normal.normalized().dot(in) < 1.0 / std::hypot(1.0, cone)) return std::nullopt;
    }
    for (const int k : {0, 2})
      if (bounds[0][k] > bounds[1][k + 1] || bounds[1][k] > bounds[0][k + 1]) return std::nullopt;
    const double width = height[0] + height[1];
    pose.position += 0.5 * (height[0] - height[1]) * (pose.orientation * Vec3::UnitX());
    return width + 2.0 * gripper_.finger_clearance <= gripper_.travel() ? std::optional<double>(width) : std::nullopt;
  }

  bool is_free(int id, const Pose& pose, double width) const {
    const double open = std::min(0.5 * width + gripper_.opening, 0.5 * gripper_.travel());
    constexpr double far = 0.25;
    const double tip = 0.5 * gripper_.pad_length, root = tip - gripper_.finger_depth,
                 half = 0.5 * gripper_.finger_width, thick = gripper_.finger_thickness;
    const Vec3 palm = 0.5 * gripper_.palm;
    std::vector<Box> coming = {{{open, -half, root - far}, {open + thick, half, tip}},
                               {{-open - thick, -half, root - far}, {-open, half, tip}},
                               {{-palm.x(), -palm.y(), root - far}, {palm.x(), palm.y(), root}}};
    const std::vector<Box> closing = {{{0.5 * width, -half, root}, {open + thick, half, tip}},
                                      {{-open - thick, -half, root}, {-0.5 * width, half, tip}}};
    for (const Box& box : closing)
      if (meets(bodies_[index(id)], pose, box, -1e-4)) return false;
    for (const Box& box : coming)
      if (meets(bodies_[index(id)], pose, box, -1e-4)) return false;
    coming.insert(coming.end(), closing.begin(), closing.end());
    const double clearance = gripper_.clearance;
    for (const Box& box : coming)
      if (meets_others(id, pose, box, clearance)) return false;
    if ((pose.orientation * Vec3::UnitZ()).z() < -std::cos(0.02)) return true;
    for (double up = 0.0; up < 0.12; up += 0.004) {
      Pose raised = pose;
      raised.position.z() += up;
      const double w = 0.5 * width;
      for (const Box& box :
           {Box{{w, -half, root}, {w + thick, half, tip}}, Box{{-w - thick, -half, root}, {-w, half, tip}},
            Box{{-palm.x(), -palm.y(), root - gripper_.palm.z()}, {palm.x(), palm.y(), root}}})
        if (meets_others(id, raised, box, clearance)) return false;
    }
    return true;
  }

  bool meets_others(int id, const Pose& pose, const Box& box, double margin) const {
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (i != index(id) && meets(bodies_[i], pose, box, margin)) return true;
    const Vec3 room = 0.5 * stage_.loaded.request.bin.inner_size;
    for (int corner = 0; corner < 8; ++corner) {  // the inside of a bin is convex, but open above its rim
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = corner >> k & 1 ? box.upper[k] + margin : box.lower[k] - margin;
      x = pose * x;
      if (x.z() < 0.0) return true;
    }
    return meets(walls(room, stage_.loaded.request.bin.inner_size.z()), pose, box, margin);
  }

  static std::vector<Corners> walls(const Vec3& room, double height) {
    std::vector<Corners> all;
    for (int k = 0; k < 2; ++k)
      for (const double side : {-1.0, 1.0}) {
        Vec3 corner = Vec3::Zero(), along = Vec3::Zero();
        corner[k] = side * room[k];
        corner[1 - k] = -room[1 - k];
        along[1 - k] = 2.0 * room[1 - k];
        const Vec3 up = height * Vec3::UnitZ();
        all.push_back({corner, corner + along, corner + up});
        all.push_back({corner + along, corner + along + up, corner + up});
      }
    return all;
  }

  static bool meets(const std::vector<Corners>& body, const Pose& pose, const Box& box, double margin) {
    const Vec3 lower = box.lower - Vec3::Constant(margin), upper = box.upper + Vec3::Constant(margin);
    const Pose into = pose.inverse();
    for (const Corners& t : body) {
      std::vector<Vec3> polygon = {into * t[0], into * t[1], into * t[2]};
      const Vec3 low = polygon[0].cwiseMin(polygon[1]).cwiseMin(polygon[2]),
                 high = polygon[0].cwiseMax(polygon[1]).cwiseMax(polygon[2]);
      if ((low.array() >= upper.array()).any() || (high.array() <= lower.array()).any()) continue;
      for (int k = 0; k < 3 && !polygon.empty(); ++k)
        for (const double sign : {-1.0, 1.0}) {
          const double limit = sign > 0.0 ? upper[k] : -lower[k];
          std::vector<Vec3> kept;
          for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double x = sign * a[k] - limit, y = sign * b[k] - limit;
            if (x < 0.0) kept.push_back(a);
            if ((x < 0.0) != (y < 0.0)) kept.push_back(a + x / (x - y) * (b - a));
          }
          polygon = kept;
        }
      if (!polygon.empty()) return true;
    }
    return false;
  }

  const Stage& stage_;
  const Gripper& gripper_;
  std::vector<std::vector<Corners>> bodies_;
};

}  // namespace bin_scenes::test
