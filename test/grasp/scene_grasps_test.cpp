/// Grasps of small scenes: an independent check of collisions on all triangles, and orders of removal that are known.
#include "bin_scenes/grasp/scene_grasps.hpp"

#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace bin_scenes {
namespace {

Gripper two_fingers() {
  Gripper gripper;
  gripper.name = "two";
  gripper.stroke = 0.06;
  gripper.finger_width = 0.010;
  gripper.pad_length = 0.010;
  gripper.finger_depth = 0.04;
  gripper.finger_thickness = 0.006;
  gripper.palm = Vec3(0.09, 0.04, 0.05);
  gripper.force = 60.0;
  return gripper;
}

Gripper cup() {
  Gripper gripper;
  gripper.name = "cup";
  gripper.type = Gripper::Type::suction;
  gripper.radius = 0.008;
  gripper.finger_depth = 0.06;
  gripper.palm = Vec3(0.03, 0.03, 0.05);
  return gripper;
}

/// Parts of some meshes at given poses, in a bin, at rest.
struct Stage {
  LoadedRequest loaded;
  Scene scene;

  explicit Stage(std::vector<Gripper> grippers) {
    loaded.request.grippers = std::move(grippers);
    loaded.request.bin.inner_size = Vec3(0.3, 0.2, 0.1);
  }
  std::size_t add(const Mesh& mesh) {
    loaded.parts.push_back(PartModel::from_mesh(mesh, "part"));
    loaded.request.parts.emplace_back();
    loaded.request.parts.back().density = 1000.0;
    return loaded.parts.size() - 1;
  }
  int put(std::size_t line, const Vec3& at, const Quat& turn = Quat::Identity()) {
    ScenePart part;
    part.id = static_cast<int>(scene.parts.size());
    part.line = line;
    part.pose = {at, turn};
    part.state = PartState::resting;
    scene.parts.push_back(part);
    return part.id;
  }
  SceneGrasps find(const std::vector<RangeImage>& images = {}) const { return Grasper().find(scene, loaded, images); }
};

const PartPick& pick_of(const SceneGrasps& found, int id) {
  return *std::find_if(found.parts.begin(), found.parts.end(), [&](const PartPick& p) { return p.id == id; });
}

std::size_t free_of(const SceneGrasps& found, int id) {
  return static_cast<std::size_t>(std::count_if(found.grasps.begin(), found.grasps.end(),
                                                [&](const SceneGrasp& g) { return g.part == id && g.free(); }));
}

TEST(SceneGrasps, StackOfPlatesComesOutFromTheTop) {
  Stage stage({cup()});
  const std::size_t plate = stage.add(test::box_mesh({0.08, 0.06, 0.005}));
  const int heights[] = {2, 0, 4, 1, 3};  // of ids 0..4
  for (const int height : heights) stage.put(plate, {0, 0, 0.0025 + 0.005 * height});
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.removal_order, (std::vector<int>{2, 4, 0, 3, 1}));
  EXPECT_EQ(pick_of(found, 2).depth, 0);
  EXPECT_EQ(pick_of(found, 1).depth, 4);
  EXPECT_EQ(pick_of(found, 0).blocked_by, (std::vector<int>{2, 4}));
  EXPECT_GT(free_of(found, 2), 0u);
  for (const int below : {0, 1, 3, 4}) EXPECT_EQ(free_of(found, below), 0u);
  for (const SceneGrasp& grasp : found.grasps) {
    if (grasp.part != 0) continue;
    EXPECT_EQ(reason_of(grasp, pick_of(found, 0)), "lift blocked by part 2, part 4");
  }
}

TEST(SceneGrasps, PartsSideBySideDoNotBlockEachOther) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0.04 - 1e-6, 0, 0.02});  // overlaps a little, as parts of heaps do
  stage.put(cube, {0.1, 0, 0.02 - 1e-6});   // and the floor
  const SceneGrasps found = stage.find();
  for (const PartPick& pick : found.parts) EXPECT_TRUE(pick.blocked_by.empty()) << pick.id;
  EXPECT_EQ(found.removal_order.size(), 3u);
  // The touching faces of the first two leave no room for a finger.
  for (const SceneGrasp& grasp : found.grasps) {
    const Vec3 closing = grasp.pose.orientation * Vec3::UnitX();
    if (grasp.part > 1 || !grasp.free()) continue;
    EXPECT_LT(std::abs(closing.x()), 0.5);
  }
  EXPECT_GT(free_of(found, 0), 0u);
}

TEST(SceneGrasps, WhatIsOnlyGrazedDoesNotBlock) {
  for (const double over : {2e-5, 5e-4}) {  // m, by which the upper cube stands over the lower one's rim
    Stage stage({two_fingers()});
    const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
    stage.put(cube, {0, 0, 0.02});
    stage.put(cube, {0.04 - over, 0, 0.07});
    const std::vector<int> expected = over < 1e-4 ? std::vector<int>{} : std::vector<int>{1};
    EXPECT_EQ(pick_of(stage.find(), 0).blocked_by, expected) << over;
  }
}

TEST(SceneGrasps, HookedPartsNeverComeFree) {
  // Two links of a chain, one through the other.
  Stage stage({two_fingers()});
  const std::size_t ring = stage.add(test::torus_mesh(0.02, 0.004, 40, 16));
  stage.put(ring, {0, 0, 0.03});
  stage.put(ring, {0.02, 0, 0.03}, Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX())));
  stage.put(ring, {-0.1, 0, 0.004});
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.removal_order, (std::vector<int>{2}));
  EXPECT_EQ(pick_of(found, 0).depth, -1);
  EXPECT_EQ(pick_of(found, 0).blocked_by, (std::vector<int>{1}));
  EXPECT_EQ(pick_of(found, 1).blocked_by, (std::vector<int>{0}));
}

TEST(SceneGrasps, LoadAndPullComeFromContactForces) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0, 0, 0.06});
  const double weight = 9.81 * 1000.0 * 0.04 * 0.04 * 0.04;
  stage.scene.contacts.push_back({0, 1, Vec3(0, 0, 0.04), Vec3::UnitZ(), Vec3(0, 0, weight)});
  stage.scene.contacts.push_back({0, -1, Vec3::Zero(), -Vec3::UnitZ(), Vec3(0, 0, -2.0 * weight)});
  stage.scene.contacts.push_back({1, -1, Vec3(0.02, 0, 0.06), Vec3::UnitX(), Vec3(3.0, 0, 0)});  // a wall squeezes
  const SceneGrasps found = stage.find();
  EXPECT_NEAR(pick_of(found, 0).load, weight, 1e-12);
  EXPECT_NEAR(pick_of(found, 1).load, 0.0, 1e-12);
  // To where their lowest points pass the rim of the bin.
  EXPECT_LT((pick_of(found, 0).lift - Vec3(0, 0, 0.10)).norm(), 1e-9);
  EXPECT_LT((pick_of(found, 1).lift - Vec3(0, 0, 0.06)).norm(), 1e-9);
  // The upper one: its weight, and friction sqrt(0.5 * 0.5) of the wall. The lower one: both weights, and the friction
  // with which the upper one presses on it.
  EXPECT_NEAR(pick_of(found, 1).pull, weight + 0.5 * 3.0, 1e-9);
  EXPECT_NEAR(pick_of(found, 0).pull, 2.0 * weight + 0.5 * weight, 1e-9);
}

TEST(SceneGrasps, FrictionAtASideIsLoadButNoPartThatLiesOnIt) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.put(cube, {0.04, 0, 0.02});
  const double weight = 9.81 * 1000.0 * 0.04 * 0.04 * 0.04;
  stage.scene.contacts.push_back({0, 1, Vec3(0.02, 0, 0.02), Vec3::UnitX(), Vec3(0.8, 0, 0.4 * weight)});
  const SceneGrasps found = stage.find();
  EXPECT_NEAR(pick_of(found, 0).load, 0.4 * weight, 1e-12);
  EXPECT_TRUE(pick_of(found, 0).blocked_by.empty());
  EXPECT_TRUE(pick_of(found, 1).blocked_by.empty());
}

TEST(SceneGrasps, WhatIsTooHeavySlips) {
  Stage stage({two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  // Both pads hold 2 * 0.5 * 60 N: 6.1 kg through the middle of the cube.
  const auto free_with = [&](double mass) {
    stage.loaded.request.parts[0].mass = mass;
    stage.loaded.request.parts[0].density.reset();
    return free_of(stage.find(), 0);
  };
  EXPECT_GT(free_with(1.0), 0u);
  EXPECT_EQ(free_with(1.01 * 60.0 / 9.81), 0u);
}

TEST(SceneGrasps, TiltIsMeasuredAgainstGravity) {
  Gripper gripper = cup();
  gripper.tilt = 0.3;
  Stage stage({gripper});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02}, Quat(Eigen::AngleAxisd(0.29, Vec3::UnitX())));
  EXPECT_GT(stage.find().grasps.size(), 0u);
  stage.scene.parts[0].pose.orientation = Quat(Eigen::AngleAxisd(0.31, Vec3::UnitX()));
  const SceneGrasps found = stage.find();
  EXPECT_EQ(found.grasps.size(), 0u);
  EXPECT_EQ(found.parts[0].tilted, found.found[0].placed);
}

// The independent check: the gripper as triangles of boxes, put at many places of its way, against all triangles of all
// others by exact crossing of segments with triangles, and corners inside.

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

TEST(SceneGrasps, CamerasSeeTheContactsThatFaceThem) {
  Stage stage({cup(), two_fingers()});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.put(cube, {0, 0, 0.02});
  stage.loaded.request.sensors.emplace_back();
  stage.scene.sensors = resolved_sensors(stage.loaded);
  const std::vector<RangeImage> images = SensorRig().render(stage.scene, stage.loaded);
  std::size_t cups = 0;
  for (const SceneGrasp& grasp : stage.find(images).grasps) {
    ASSERT_EQ(grasp.visible.size(), 1u);
    if (grasp.gripper == 1) {  // sides of the cube, under a camera right above it
      EXPECT_LT(grasp.visible[0], 0.35);
      continue;
    }
    ++cups;
    EXPECT_EQ(grasp.visible[0], 1.0);
    EXPECT_EQ(grasp.measured[0], 1.0);
  }
  EXPECT_GT(cups, 5u);
}

TEST(SceneGrasps, NoGraspAtAllSaysWhy) {
  Gripper wide = cup();
  wide.radius = 0.03;
  Stage stage({wide});
  const std::size_t cube = stage.add(test::box_mesh({0.04, 0.04, 0.04}));
  stage.loaded.request.parts[cube].model = "cube.stl";
  stage.put(cube, {0, 0, 0.02});
  const auto flags = flags_of(stage.find(), stage.loaded.request);
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].code, "no_grasp");
  EXPECT_NE(flags[0].text.find("5000 where the ring leaves the part"), std::string::npos) << flags[0].text;
}

TEST(SceneGrasps, APalmThatCannotFollowIsTold) {
  Gripper broad = cup();
  broad.palm = {0.31, 0.32, 0.1};
  broad.finger_depth = 0.05;
  Stage stage({broad});
  Request& request = stage.loaded.request;
  request.bin.kind = Bin::Kind::box;
  const auto told = [&](const Vec3& room) {
    request.bin.inner_size = room;
    return flags_of({}, request);
  };
  const auto flags = told({0.4, 0.3, 0.2});
  ASSERT_EQ(flags.size(), 1u);
  EXPECT_EQ(flags[0].code, "palm_too_wide");
  EXPECT_NE(flags[0].text.find("no deeper than 50 mm below the rim"), std::string::npos) << flags[0].text;
  EXPECT_TRUE(told({0.4, 0.3, 0.05}).empty());   // its fingers reach the floor
  EXPECT_TRUE(told({0.4, 0.315, 0.2}).empty());  // it goes in, turned
}

}  // namespace
}  // namespace bin_scenes
