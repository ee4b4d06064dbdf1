/// scene.json from scene, request and images, and back again.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/scene/sensor_name.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "output/boxes.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <limits>
#include <type_traits>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* scene_format = "bin_scenes/1";

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json json_of(const Pose& pose) {
  const Quat& q = pose.orientation;
  return {{"position", json_of(pose.position)}, {"orientation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

Json json_of(const Bin& bin) {
  Json json;
  switch (bin.kind) {
    case Bin::Kind::box:
      json["inner_size"] = json_of(bin.inner_size);
      json["wall_thickness"] = bin.wall_thickness;
      break;
    case Bin::Kind::mesh:
      json["mesh"] = bin.mesh;
      if (!bin.mesh_sha256.empty()) json["sha256"] = bin.mesh_sha256;
      if (bin.unit) json["unit"] = name_of(*bin.unit);
      json["pose"] = json_of(bin.pose);
      break;
    case Bin::Kind::floor:
      json["floor"] = true;
      break;
    case Bin::Kind::none:
      json["none"] = true;
      break;
  }
  json["friction"] = bin.friction;
  json["restitution"] = bin.restitution;
  return json;
}

/// The file of a part line, and how it was read as far as that was asked for.
Json model_of(const PartLine& line, const std::string& sha256) {
  Json json = {{"model", line.model}, {"sha256", sha256}};
  if (line.unit) json["unit"] = name_of(*line.unit);
  if (line.scale != 1.0) json["scale"] = line.scale;
  if (line.thickness) json["thickness"] = *line.thickness;
  if (!line.solid.empty()) json["solid"] = line.solid;
  if (line.tessellation.chord) json["chord"] = *line.tessellation.chord;
  if (line.tessellation.given()) json["angle"] = line.tessellation.angle;
  return json;
}

Json json_of(const Sensor& sensor) {
  Json json = {{"name", sensor.name},
               {"frame", graph_name(sensor.name) + "_optical_frame"},
               {"model", sensor.model},
               {"preset", sensor.preset},
               {"pose", json_of(sensor.pose.value_or(Pose()))},
               {"width", sensor.width},
               {"height", sensor.height},
               {"K", sensor.k},
               {"distortion", sensor.distortion},
               {"near", sensor.near},
               {"far", sensor.far},
               {"depth_scale", sensor.depth_scale},
               {"noise", sensor.noise}};
  if (!sensor.view_of.empty()) json["view_of"] = sensor.view_of;
  const SensorModel& model = sensor_model(sensor.model);
  if (model.projector) {
    const Projector& p = sensor.projector;
    json["projector"] = {{"pose", json_of(p.pose.value_or(Pose()))},
                         {"width", p.width},
                         {"height", p.height},
                         {"fov", p.fov},
                         {"distortion", p.distortion}};
  }
  if (model.laser) json["laser"] = {{"pose", json_of(sensor.laser.pose.value_or(Pose()))}};
  return json;
}

/// What the sensor's camera truly has of each part.
Json truth_of(const Scene& scene, const RangeImage& image, const std::vector<PartModelPtr>& models) {
  const std::vector<PixelBox> boxes = visible_boxes(image, image.visible.size());
  const Pose bin_in_camera = image.sensor.pose.value_or(Pose()).inverse();
  const Sensor& device = image.true_sensor();
  const Pose bin_in_device = device.pose.value_or(Pose()).inverse();
  std::vector<std::size_t> measured(image.visible.size(), 0);
  if (image.label.size() == image.seen_label().size())  // else profiles of a laser, which are no view
    for (std::size_t i = 0; i < image.label.size(); ++i)
      if (image.label[i] != 0 && image.label[i] == image.seen_label()[i]) ++measured.at(image.label[i] - 1u);
  Json truth = Json::array();
  for (const ScenePart& part : scene.parts) {
    if (!is_there(part.state) || !part.pose.finite()) continue;
    const auto id = static_cast<std::size_t>(part.id);
    const PixelBox whole = projected_box(models.at(part.line)->mesh(), bin_in_device * part.pose, device);
    const double all = static_cast<double>(image.total.at(id));
    truth.push_back({{"id", part.id},
                     {"pose_in_camera", json_of(bin_in_camera * part.pose)},
                     {"visible_fraction", all > 0.0 ? static_cast<double>(image.visible.at(id)) / all : 0.0},
                     {"bbox_visib", boxes.at(id).xywh()},
                     {"bbox_obj", whole.xywh()},
                     {"px_count_visib", image.visible.at(id)},
                     {"px_count_measured", measured.at(id)},
                     {"px_count_all", image.total.at(id)}});
  }
  return truth;
}

Json json_of(const ScenePart& part) {
  Json json = {{"id", part.id}, {"line", part.line}, {"model", part.model}};
  json["pose"] = part.pose.finite() ? json_of(part.pose) : Json();
  json["state"] = name_of(part.state);
  if (part.velocity.linear != Vec3::Zero() || part.velocity.angular != Vec3::Zero()) {
    json["velocity"] = {{"linear", json_of(part.velocity.linear)}, {"angular", json_of(part.velocity.angular)}};
  }
  json["visible_fraction"] = Json::object();
  for (const auto& [sensor, fraction] : part.visible_fraction) json["visible_fraction"][sensor] = fraction;
  return json;
}

Json json_of(const Quantiles& q) {
  return {{"median", q.median}, {"p95", q.p95}, {"max", q.max}};
}

Json json_of(const Report& report) {
  Json json = {
      {"at_rest", report.at_rest}, {"accepted", report.accepted},           {"reasons", report.reasons},
      {"solver", report.solver},   {"solver_reason", report.solver_reason}, {"device", report.device},
      {"finish", report.finish},   {"simulated_s", report.simulated_s},     {"wall_s", report.wall_s},
      {"steps", report.steps},     {"stages_ms", report.profile.stages_ms}, {"counters", report.profile.counters}};
  const PenetrationReport& p = report.penetration;
  Json& penetration = json["penetration"] = json_of(static_cast<const Quantiles&>(p));
  penetration["pair"] = p.pair;
  penetration["pairs"] = p.pairs;
  penetration["p95_relative"] = p.p95_relative;
  penetration["max_relative"] = p.max_relative;
  penetration["bin_median"] = p.bin_median;
  penetration["bin_p95"] = p.bin_p95;
  penetration["bin_max"] = p.bin_max;
  penetration["bin_part"] = p.bin_part;
  json["gap"] = json_of(report.gap);
  if (report.drift.measured) {
    json["drift"] = json_of(static_cast<const Quantiles&>(report.drift));
    json["drift"]["turn_p95"] = report.drift.turn_p95;
  }
  const auto& thrown = report.energy.thrown;
  json["energy"] = {{"gain", report.energy.gain}, {"time", report.energy.time}, {"part", report.energy.part}};
  json["energy"]["thrown"] = {
      {"ratio", thrown.ratio}, {"time", thrown.time}, {"part", thrown.part}, {"beside", thrown.beside}};
  json["jam"] = {{"ratio", report.jam.ratio}, {"part", report.jam.part}};
  json["escaped"] = report.escaped;
  json["not_poured"] = report.not_poured;
  char hash[17];  // as text: many readers of JSON keep only 53 bits of a number
  std::snprintf(hash, sizeof(hash), "%016llx", static_cast<unsigned long long>(report.state_hash));
  json["state_hash"] = hash;
  json["flags"] = Json::array();
  for (const Flag& flag : report.flags) {
    json["flags"].push_back({{"code", flag.code}, {"text", flag.text}, {"remedy", flag.remedy}});
  }
  return json;
}

// Reading. nlohmann's exceptions name the key and the type; read_scene_json adds the file and the place in it.

/// A whole number that its type can hold; the cast of another one may be anything.
template <class Whole>
Whole whole_of(const Json& json) {
  const bool fits = json.is_number_unsigned()
                        ? json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<Whole>::max())
                        : json.is_number_integer() && std::is_signed_v<Whole> &&
                              json.get<std::int64_t>() >= static_cast<std::int64_t>(std::numeric_limits<Whole>::min());
  if (!fits) throw std::runtime_error("holds " + json.dump().substr(0, 40) + " where a whole number is due");
  return json.get<Whole>();
}

std::vector<int> ids_of(const Json& json, const char* key) {
  std::vector<int> ids;
  if (json.contains(key))
    for (const Json& id : json.at(key)) ids.push_back(whole_of<int>(id));
  return ids;
}

Vec3 vec3_of(const Json& json) {
  Vec3 v;
  if (json.size() != 3) throw std::runtime_error("a position needs three numbers");
  for (int i = 0; i < 3; ++i) v[i] = json.at(i).is_null() ? std::nan("") : json.at(i).get<double>();
  return v;
}

Pose pose_of(const Json& json) {
  if (json.is_null()) return Pose::none();
  Pose pose;
  pose.position = vec3_of(json.at("position"));
  const Json& q = json.at("orientation_xyzw");
  if (q.size() != 4) throw std::runtime_error("orientation_xyzw needs four numbers");
  for (int i = 0; i < 4; ++i) pose.orientation.coeffs()[i] = q.at(i).is_null() ? std::nan("") : q.at(i).get<double>();
  return pose;
}

PartState state_of(const std::string& name) {
  for (const PartState state : {PartState::resting, PartState::moving, PartState::escaped, PartState::fixed,
                                PartState::not_poured, PartState::removed}) {
    if (name == name_of(state)) return state;
  }
  throw std::runtime_error("'" + name + "' is no state of a part");
}

/// Files of others may lack `line`: then a line is a model, in order of first appearance.
std::size_t line_of(const Json& json, const std::string& model, std::vector<std::string>& models) {
  if (json.contains("line")) return whole_of<std::size_t>(json.at("line"));
  const auto known = std::find(models.begin(), models.end(), model);
  if (known != models.end()) return static_cast<std::size_t>(known - models.begin());
  models.push_back(model);
  return models.size() - 1;
}

/// What nlohmann says of a value, without the name of its exception.
std::string plain(const std::string& what) {
  const std::size_t end = what.find("] ");
  return what.rfind("[json.", 0) == 0 && end != std::string::npos ? what.substr(end + 2) : what;
}

Report report_of(const Json& json) {
  Report report;
  report.at_rest = json.value("at_rest", false);
  report.accepted = json.value("accepted", false);
  report.reasons = json.value("reasons", std::vector<std::string>());
  report.solver = json.value("solver", "");
  report.solver_reason = json.value("solver_reason", "");
  report.device = json.value("device", "");
  report.finish = json.value("finish", "");
  report.simulated_s = json.value("simulated_s", 0.0);
  if (json.contains("wall_s") && !json.at("wall_s").is_null()) report.wall_s = json.at("wall_s").get<double>();
  if (json.contains("steps")) report.steps = whole_of<std::uint64_t>(json.at("steps"));
  report.escaped = ids_of(json, "escaped");
  report.not_poured = ids_of(json, "not_poured");
  report.state_hash = std::stoull(json.value("state_hash", "0"), nullptr, 16);
  return report;
}

}  // namespace

std::string scene_json(const Scene& scene, const LoadedRequest& loaded, const std::vector<RangeImage>& images) {
  const Request& request = loaded.request;
  Json json = {{"format", scene_format}, {"seed", scene.seed}, {"index", scene.index}, {"bin", json_of(request.bin)}};
  json["gravity"] = json_of(request.gravity);
  json["request_sha256"] = request.text_sha256;
  json["sensors"] = Json::array();
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    json["sensors"].push_back(json_of(scene.sensors[i]));
    if (i < images.size()) json["sensors"].back()["truth"] = truth_of(scene, images[i], loaded.parts);
  }
  for (std::size_t line = 0; line < scene.model_sha256.size() && line < request.parts.size(); ++line) {
    json["models"].push_back(model_of(request.parts[line], scene.model_sha256[line]));
  }
  json["parts"] = Json::array();
  for (const ScenePart& part : scene.parts) json["parts"].push_back(json_of(part));
  json["report"] = json_of(scene.report);
  return json.dump(1) + "\n";
}

Scene read_scene_json(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw input_error("cannot be read", path, "name a scene.json that is there");
  std::string where = "format";
  try {
    const Json json = Json::parse(file);
    if (json.at("format") != scene_format) throw std::runtime_error("is not " + std::string(scene_format));
    Scene scene;
    where = "seed and index";
    scene.seed = whole_of<std::uint64_t>(json.at("seed"));
    scene.index = whole_of<std::size_t>(json.at("index"));
    where = "models";
    if (json.contains("models")) {
      for (const Json& model : json.at("models")) {
        scene.model_sha256.push_back(model.at("sha256").get<std::string>());
      }
    }
    where = "parts";
    std::vector<std::string> models;
    for (const Json& item : json.at("parts")) {
      where = "parts[" + std::to_string(scene.parts.size()) + "]";
      ScenePart part;
      part.id = whole_of<int>(item.at("id"));
      part.model = item.at("model").get<std::string>();
      part.line = line_of(item, part.model, models);
      part.pose = pose_of(item.at("pose"));
      part.state = state_of(item.at("state").get<std::string>());
      if (item.contains("velocity")) {
        part.velocity.linear = vec3_of(item.at("velocity").at("linear"));
        part.velocity.angular = vec3_of(item.at("velocity").at("angular"));
      }
      if (item.contains("visible_fraction")) {
        for (const auto& [sensor, fraction] : item.at("visible_fraction").items()) {
          part.visible_fraction[sensor] = fraction.get<double>();
        }
      }
      scene.parts.push_back(part);
    }
    where = "report";
    if (json.contains("report")) scene.report = report_of(json.at("report"));
    return scene;
  } catch (const Json::parse_error& error) {
    throw input_error("is no JSON, or cut off: it cannot be read from byte " + std::to_string(error.byte) + " on", path,
                      "give a scene.json of format " + std::string(scene_format));
  } catch (const std::exception& error) {
    throw input_error("'" + where + "': " + plain(error.what()), path,
                      "give a scene.json of format " + std::string(scene_format));
  }
}

}  // namespace bin_scenes
