/// A finished scene: true poses, states, report.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/scene/request.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

enum class PartState { resting, moving, escaped, fixed, not_poured, removed };
const char* name_of(PartState state);
/// Whether the part is in the scene. A part that was never poured, or was taken out, has no pose and is in no image.
inline bool is_there(PartState state) {
  return state != PartState::not_poured && state != PartState::removed;
}

struct ScenePart {
  int id = 0;            ///< stable across every output
  std::size_t line = 0;  ///< index into Request::parts
  std::string model;     ///< as the user wrote it
  Pose pose;  ///< model file's own frame (scaled to metres) in the bin frame; Pose::none() if not poured or removed
  Twist velocity;  ///< of the centre of mass, when the simulation ended
  PartState state = PartState::moving;
  std::map<std::string, double> visible_fraction;  ///< by sensor name
};

/// A contact of the finished scene. A part lies on another one, or on the bin.
struct SceneContact {
  int a = -1, b = -1;  ///< ids; b is -1 for the bin
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< from a to b
  Vec3 force = Vec3::Zero();    ///< N, on b with friction; on a acts its opposite
};

struct Scene {
  std::uint64_t seed = 0;
  std::size_t index = 0;
  std::vector<std::string> model_sha256;  ///< by part line: of the model file's bytes; empty: not known
  std::vector<ScenePart> parts;
  std::vector<SceneContact> contacts;  ///< empty if the solver reports no forces
  std::vector<Sensor> sensors;         ///< with pose and K filled in
  Report report;
};

}  // namespace bin_scenes
