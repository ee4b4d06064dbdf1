/// A finished scene: the true poses and states of all parts, the contacts between them, and the report. It is plain
/// data. Heap::scene() makes it, quality and sensors complete it, and output and ROS publish it.
#pragma once

#include "bin_scenes/core/types.hpp"
#include "bin_scenes/scene/report.hpp"
#include "bin_scenes/scene/request.hpp"

#include <map>
#include <string>
#include <vector>

namespace bin_scenes {

/// The state of a part at the end of the simulation.
enum class PartState { resting, moving, escaped, fixed, not_poured, removed };
const char* name_of(PartState state);
/// Whether the part is in the scene. A part that was never poured, or that was removed, has no pose and appears in no
/// image.
inline bool is_there(PartState state) {
  return state != PartState::not_poured && state != PartState::removed;
}

/// One part of a scene.
struct ScenePart {
  int id = 0;            ///< the same in every output and for the whole life of a heap
  std::size_t line = 0;  ///< index into Request::parts
  std::string model;     ///< the model file as the user wrote it
  Pose pose;  ///< from the frame of the model file (scaled to metres) to the bin frame; Pose::none() if the part was
              ///< not poured or was removed
  Twist velocity;  ///< of the centre of mass at the end of the simulation, bin frame
  PartState state = PartState::moving;
  bool distractor = false;  ///< whether it is seen without a label (PartLine::distractor)
  /// Share of the part's silhouette that each sensor sees, by sensor name.
  std::map<std::string, double> visible_fraction;
};

/// What a contact does, as a trace shows it (pour/contact_action.hpp decides it).
enum class ContactAction {
  resting,       ///< it carries a load, and the surfaces do not move along each other
  sliding,       ///< the surfaces move along each other
  pushed_apart,  ///< the parts overlap, and the solver separates them
  impact         ///< the parts hit each other since the last sample
};
const char* name_of(ContactAction action);

/// A contact of the finished scene, at which one part touches another part or the bin (bin frame, SI).
struct SceneContact {
  int a = -1, b = -1;  ///< ids of the parts; b is -1 for the bin
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit vector from a to b
  Vec3 force = Vec3::Zero();    ///< N, the force on b including friction; the opposite force acts on a
  ContactAction action = ContactAction::resting;  ///< only in traces
};

/// A scene with the seed and index that identify it.
struct Scene {
  std::uint64_t seed = 0;
  std::size_t index = 0;
  std::vector<std::string> model_sha256;  ///< digests of the model files, by part line; empty if not known
  std::vector<ScenePart> parts;
  std::vector<SceneContact> contacts;  ///< empty if the solver reports no forces
  std::vector<Sensor> sensors;         ///< with poses and camera matrices filled in
  Report report;
};

}  // namespace bin_scenes
