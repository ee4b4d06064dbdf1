/// Free grasps by an independent check: the gripper as triangles of boxes, put at many places of its way, against all
/// triangles of all others by exact crossing of segments with triangles, and corners inside.
#include "bin_scenes/core/random.hpp"
#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"
#include "stage.hpp"

#include <gtest/gtest.h>

#include <array>

namespace bin_scenes {
namespace {

using test::Stage, test::two_fingers;

bool crosses(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& t) {
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  if (volume(t[0], t[1], t[2], from) * volume(t[0], t[1], t[2], to) > 0) return false;
  const double a = volume(from, to, t[0], t[1]), b = volume(from, to, t[1], t[2]), c = volume(from, to, t[2], t[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool boxes_meet(const Mesh& box, const Vec3& half, const Pose& pose, const Mesh& mesh, const Pose& placed) {
  const Pose into = pose.inverse() * placed;
  for (const Triangle& t : mesh.triangles) {
    const std::array<Vec3, 3> there = {into * mesh.vertices[t[0]], into * mesh.vertices[t[1]],
                                       into * mesh.vertices[t[2]]};
    Aabb bounds;
    for (const Vec3& v : there) {
      if ((v.cwiseAbs() - half).maxCoeff() < 0.0) return true;
      bounds.extend(v);
    }
    if ((bounds.lower.array() > half.array()).any() || (bounds.upper.array() < -half.array()).any()) continue;
    for (const Triangle& s : box.triangles)
      for (int i = 0; i < 3; ++i) {
        if (crosses(box.vertices[s[i]], box.vertices[s[(i + 1) % 3]], there)) return true;
        if (crosses(there[i], there[(i + 1) % 3], {box.vertices[s[0]], box.vertices[s[1]], box.vertices[s[2]]}))
          return true;
      }
  }
  return false;
}

struct Body {
  Vec3 center, half;
};

/// The two-finger gripper with its pads `width` apart.
std::vector<Body> bodies_of(const Gripper& g, double width, double grown) {
  const double tip = 0.5 * g.pad_length, x = 0.5 * width + 0.5 * g.finger_thickness;
  const Vec3 finger(0.5 * g.finger_thickness + grown, 0.5 * g.finger_width + grown, 0.5 * g.finger_depth + grown);
  const double palm = tip - g.finger_depth - 0.5 * g.palm.z();
  return {{Vec3(x, 0, tip - 0.5 * g.finger_depth), finger},
          {Vec3(-x, 0, tip - 0.5 * g.finger_depth), finger},
          {Vec3(0, 0, palm), 0.5 * g.palm + Vec3::Constant(grown)}};
}

class Oracle {
 public:
  Oracle(const Stage& stage) : stage_(stage) {
    const Vec3 size = stage.loaded.request.bin.inner_size;
    const double t = 0.005;
    walls_ = {test::box_mesh({size.x() + 2 * t, size.y() + 2 * t, t}, {0, 0, -0.5 * t})};
    for (const double sign : {-1.0, 1.0}) {
      walls_.push_back(
          test::box_mesh({t, size.y() + 2 * t, size.z()}, {sign * 0.5 * (size.x() + t), 0, 0.5 * size.z()}));
      walls_.push_back(test::box_mesh({size.x(), t, size.z()}, {0, sign * 0.5 * (size.y() + t), 0.5 * size.z()}));
    }
  }

  /// Whether the gripper meets others or the bin anywhere on its way, in steps of 2 mm.
  bool meets(const SceneGrasp& grasp, double grown) const {
    const Gripper& g = stage_.loaded.request.grippers[grasp.gripper];
    const double open = grasp.width + 2.0 * std::min(g.opening, 0.5 * (g.travel() - grasp.width));
    const Vec3 along = grasp.pose.orientation * Vec3::UnitZ();
    constexpr double step = 0.002;
    for (double back = 0.0; back < 0.25; back += step)
      if (meets_at(grasp, bodies_of(g, open, grown), -back * along)) return true;
    for (double width = grasp.width; width < open; width += step)
      if (meets_at(grasp, bodies_of(g, width, grown), Vec3::Zero())) return true;
    for (double up = 0.0; up < 0.2; up += step)
      if (meets_at(grasp, bodies_of(g, grasp.width, grown), Vec3(0, 0, up))) return true;
    return false;
  }

  /// Whether corners of the part, going up, come into others, or theirs into it.
  bool part_meets(int id) const {
    const ScenePart& part = stage_.scene.parts[static_cast<std::size_t>(id)];
    const MeshQuery& mesh = stage_.loaded.parts[part.line]->query();
    for (double up = 0.0; up < 0.15; up += 0.002) {
      Pose pose = part.pose;
      pose.position.z() += up;
      for (const ScenePart& other : stage_.scene.parts) {
        if (other.id == id) continue;
        const MeshQuery& there = stage_.loaded.parts[other.line]->query();
        const Pose into_other = other.pose.inverse() * pose, into_part = pose.inverse() * other.pose;
        for (const Vec3& v : mesh.mesh().vertices)
          if (there.inside(into_other * v)) return true;
        for (const Vec3& v : there.mesh().vertices)
          if (mesh.inside(into_part * v)) return true;
      }
    }
    return false;
  }

 private:
  bool meets_at(const SceneGrasp& grasp, const std::vector<Body>& bodies, const Vec3& moved) const {
    for (const Body& body : bodies) {
      Pose pose = grasp.pose * Pose{body.center, Quat::Identity()};
      pose.position += moved;
      const Mesh box = test::box_mesh(2.0 * body.half);
      for (const ScenePart& part : stage_.scene.parts)
        if (part.id != grasp.part && near(pose, body, part) &&
            boxes_meet(box, body.half, pose, stage_.loaded.parts[part.line]->mesh(), part.pose))
          return true;
      for (const Mesh& wall : walls_)
        if (boxes_meet(box, body.half, pose, wall, Pose())) return true;
    }
    return false;
  }
  bool near(const Pose& pose, const Body& body, const ScenePart& part) const {
    const PartModel& model = *stage_.loaded.parts[part.line];
    return (pose.position - part.pose * model.mass().center).norm() < body.half.norm() + model.radius();
  }

  const Stage& stage_;
  std::vector<Mesh> walls_;
};

/// Parts strewn over the floor, none upon another, close to each other and to the walls.
Stage strewn(std::uint64_t seed) {
  Stage stage({two_fingers()});
  stage.loaded.request.bin.inner_size = Vec3(0.16, 0.14, 0.06);
  stage.loaded.request.slight_overlap = 0.0;  // else parts that are hardly covered count as free to lift
  const std::size_t lines[] = {stage.add(test::box_mesh({0.03, 0.02, 0.025})),
                               stage.add(test::ring(0.02, 0.013, 0.012, 24).mesh),
                               stage.add(test::prism_mesh(0.009, 0.05, 16))};
  Random random(seed, 0, Stream::probe);
  for (int i = 0; i < 6; ++i) {
    const Vec3 at(0.045 * (i % 3 - 1) + random.uniform(-0.004, 0.004), 0.05 * (i / 3) - 0.025,
                  0.03 + random.uniform(-0.005, 0.02));
    stage.put(lines[random.below(3)], at, random.orientation());
  }
  return stage;
}

TEST(SceneGrasps, FreeGraspsMeetNothingByAnIndependentCheck) {
  std::size_t free = 0, met = 0, missed = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Stage stage = strewn(seed);
    const Oracle oracle(stage);
    const SceneGrasps found = stage.find();
    std::size_t tried = 0;
    for (const SceneGrasp& grasp : found.grasps) {
      const bool collides = grasp.obstacle == SceneGrasp::Obstacle::approach ||
                            grasp.obstacle == SceneGrasp::Obstacle::closing ||
                            grasp.obstacle == SceneGrasp::Obstacle::lift;
      if (!collides && !grasp.free()) continue;
      if (!grasp.free() && tried++ % 3) continue;
      const double clearance = two_fingers().clearance;
      if (grasp.free()) {
        ++free;
        EXPECT_FALSE(oracle.meets(grasp, clearance - 1e-6)) << seed << " part " << grasp.part;
        EXPECT_FALSE(oracle.part_meets(grasp.part)) << seed << " part " << grasp.part;
      } else {
        ++met;  // boxes of a sweep have corners that their steps do not: they reach a little farther
        missed += !oracle.meets(grasp, clearance + 1e-3);
      }
    }
  }
  EXPECT_GT(free, 30u);
  EXPECT_GT(met, 30u);
  EXPECT_EQ(missed, 0u);
}

}  // namespace
}  // namespace bin_scenes
