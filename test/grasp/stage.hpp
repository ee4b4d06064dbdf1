/// Grippers, and small scenes for them to find grasps in.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace bin_scenes::test {

inline Gripper two_fingers() {
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

inline Gripper cup() {
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

inline const PartPick& pick_of(const SceneGrasps& found, int id) {
  return *std::find_if(found.parts.begin(), found.parts.end(), [&](const PartPick& p) { return p.id == id; });
}

inline std::size_t free_of(const SceneGrasps& found, int id) {
  return static_cast<std::size_t>(std::count_if(found.grasps.begin(), found.grasps.end(),
                                                [&](const SceneGrasp& g) { return g.part == id && g.free(); }));
}

}  // namespace bin_scenes::test
