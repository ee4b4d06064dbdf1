/// grasps.json: what can be picked of a scene. One grasp a line.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "grasp/gripper_shape.hpp"
#include "scene/gripper_keys.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

using GraspJson = nlohmann::ordered_json;

constexpr const char* grasps_format = "bin_scenes/grasps/1";

GraspJson pose_json(const Pose& pose) {
  const Vec3& p = pose.position;
  const Quat& q = pose.orientation;
  return {{"position", {p.x(), p.y(), p.z()}}, {"orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

/// The values of a table of keys that are numbers.
struct NumbersJson {
  GraspJson json;
  void field(const Key& key, double value) { json[key.name] = value; }
  void field(const Key& key, const std::optional<double>& value) { json[key.name] = value.value(); }
};

GraspJson weights_json(ScoreWeights weights) {
  NumbersJson numbers;
  visit(numbers, weights);
  return std::move(numbers.json);
}

/// An infinite value is null.
GraspJson number_json(double value) {
  return std::isfinite(value) ? GraspJson(value) : GraspJson();
}

GraspJson columns_json(const GraspColumns& columns) {
  GraspJson json;
  for_each_column(columns, [&](const char* name, double value) { json[name] = number_json(value); });
  return json;
}

/// Lower and upper corner of each box.
GraspJson boxes_json(const std::vector<Aabb>& boxes) {
  GraspJson all = GraspJson::array();
  for (const Aabb& box : boxes)
    all.push_back({{box.lower.x(), box.lower.y(), box.lower.z()}, {box.upper.x(), box.upper.y(), box.upper.z()}});
  return all;
}

/// What draws a gripper and what labels depend on; keys as in the request.
GraspJson gripper_json(const Gripper& g) {
  GraspJson json = {{"name", g.name}};
  if (g.type == Gripper::Type::parallel) {
    json.update({{"type", "parallel"},
                 {"stroke", g.travel()},
                 {"opening", g.opening},
                 {"finger_width", g.finger_width},
                 {"finger_thickness", g.finger_thickness},
                 {"finger_boxes", boxes_json(finger_of(g))},
                 {"finger_clearance", g.finger_clearance},
                 {"inner", g.inner},
                 {"pad_length", g.pad_length},
                 {"pad_give", g.pad_give}});
  } else {
    json.update({{"type", "suction"},
                 {"stroke", g.travel()},
                 {"radius", g.radius},
                 {"lip", g.lip},
                 {"margin", g.margin},
                 {"stiffness", g.stiffness}});
  }
  json.update({{"finger_depth", g.finger_depth},
               {"palm", {g.palm.x(), g.palm.y(), g.palm.z()}},
               {"force", g.force},
               {"friction", g.friction},
               {"clearance", g.clearance},
               {"tool_rotation", {g.tool_rotation.x(), g.tool_rotation.y(), g.tool_rotation.z()}},
               {"acceleration", g.acceleration},
               {"tilt", g.tilt},
               {"most", g.most},
               {"free_wanted", g.free_wanted},
               {"tries", g.tries},
               {"score", weights_json(g.weights())}});
  return json;
}

GraspJson proof_json(const LiftProof& proof) {
  return {{"success", proof.outcome == LiftProof::Outcome::lifted},
          {"outcome", name_of(proof.outcome)},
          {"slip", proof.slip},
          {"turn", proof.turn},
          {"dragged", proof.dragged},
          {"moved", proof.moved}};
}

GraspJson grasp_json(const SceneGrasp& grasp, const PartPick& pick, const Scene& scene, const Request& request) {
  GraspJson json = {{"part", grasp.part},
                    {"gripper", request.grippers[grasp.gripper].name},
                    {"grasp", grasp.grasp ? static_cast<std::int64_t>(*grasp.grasp) : -1},
                    {"pose", pose_json(grasp.pose)},
                    {"flange", pose_json(grasp.pose * request.grippers[grasp.gripper].flange())},
                    {"width", grasp.width},
                    {"inner", grasp.inner},
                    {"score", grasp.score},
                    {"columns", columns_json(grasp.columns)},
                    {"friction", number_json(grasp.friction)},
                    {"free", grasp.free()},
                    {"reason", reason_of(grasp, pick)}};
  if (grasp.proof) json["proof"] = proof_json(*grasp.proof);
  json["visible"] = json["measured"] = json["pose_in_camera"] = GraspJson::object();
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    const std::string& name = scene.sensors[i].name;
    json["pose_in_camera"][name] = pose_json(scene.sensors[i].pose.value_or(Pose()).inverse() * grasp.pose);
    if (i >= grasp.visible.size()) continue;
    json["visible"][name] = grasp.visible[i];
    json["measured"][name] = grasp.measured[i];
  }
  return json;
}

GraspJson searches_json(const PartPick& pick, const Request& request) {
  GraspJson all = GraspJson::array();
  for (const PartSearch& search : pick.searches)
    all.push_back({{"gripper", request.grippers[search.gripper].name},
                   {"tried", search.tried},
                   {"free", search.free},
                   {"least_tilt", number_json(search.least_tilt)}});
  return all;
}

/// What covers a part, and by how much.
GraspJson overlap_json(const PartPick& pick) {
  GraspJson by = GraspJson::object();
  for (std::size_t i = 0; i < pick.blocked_areas.size(); ++i)
    by[std::to_string(pick.blocked_by[i])] = pick.blocked_areas[i];
  const Vec3& move = pick.overlap.move;
  return {{"area", pick.overlap.area},
          {"share", pick.overlap.share},
          {"move", {move.x(), move.y(), move.z()}},
          {"passes", pick.overlap.passes},
          {"by", std::move(by)}};
}

GraspJson held_json(const std::vector<SceneGrasps::HeldSet>& sets) {
  GraspJson all = GraspJson::array();
  for (const SceneGrasps::HeldSet& held : sets) {
    GraspJson forced = GraspJson::array();
    for (const SceneGrasps::Forced& lift : held.forced) forced.push_back({{"part", lift.part}, {"area", lift.overlap}});
    all.push_back({{"parts", held.ids},
                   {"least_overlap", {{"part", held.part}, {"by", held.by}, {"area", held.overlap}}},
                   {"forced", std::move(forced)}});
  }
  return all;
}

GraspJson found_json(const SceneGrasps::Found& found, const Request& request) {
  const GraspCounts& c = found.counts;
  return {{"line", found.line},
          {"model", request.parts[found.line].model},
          {"gripper", request.grippers[found.gripper].name},
          {"grasps", found.grasps},
          {"placed", found.placed},
          {"coverage", found.coverage},
          {"tried", c.tried},
          {"good", c.good},
          {"failed",
           {{"width", c.width},
            {"friction", c.friction},
            {"contact", c.contact},
            {"seal", c.seal},
            {"collision", c.collision}}}};
}

}  // namespace

std::string gripper_text(const Gripper& gripper) {
  return gripper_json(gripper).dump();
}

std::string grasps_json(const SceneGrasps& grasps, const Scene& scene, const Request& request) {
  GraspJson rest = {{"removal_order", grasps.removal_order}, {"held_sets", held_json(grasps.held_sets)}};
  rest["blocked_by"] = GraspJson::object();
  rest["parts"] = rest["models"] = rest["grippers"] = GraspJson::array();
  for (const PartPick& pick : grasps.parts) {
    if (!pick.blocked_by.empty()) rest["blocked_by"][std::to_string(pick.id)] = pick.blocked_by;
    rest["parts"].push_back({{"id", pick.id},
                             {"load", pick.load},
                             {"pull", pick.pull},
                             {"depth", pick.depth},
                             {"lift", {pick.lift.x(), pick.lift.y(), pick.lift.z()}},
                             {"slight", pick.slight},
                             {"overlap", overlap_json(pick)},
                             {"tilted", pick.tilted},
                             {"searched", searches_json(pick, request)}});
  }
  for (const auto& found : grasps.found) rest["models"].push_back(found_json(found, request));
  for (const Gripper& gripper : request.grippers) rest["grippers"].push_back(gripper_json(gripper));
  std::string text = "{\"format\": \"" + std::string(grasps_format) + "\",\n \"grasps\": [";
  auto pick = grasps.parts.begin();
  for (std::size_t i = 0; i < grasps.grasps.size(); ++i) {
    while (pick->id != grasps.grasps[i].part) ++pick;  // grasps are in the order of the parts
    text += (i ? ",\n  " : "\n  ") + grasp_json(grasps.grasps[i], *pick, scene, request).dump();
  }
  return text + "],\n" + rest.dump(1).substr(2) + "\n";
}

}  // namespace bin_scenes
