#include "dataset/record.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr std::size_t bins = 20;

void count(std::vector<int>& histogram, double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(bins);
  ++histogram[std::min(bins - 1, static_cast<std::size_t>(place))];
}

/// Angle between the model's z axis and the bin's, as a share of half a turn.
double tilt_of(const nlohmann::json& q) {
  const double x = q.at(0), y = q.at(1);
  return std::acos(std::clamp(1.0 - 2.0 * (x * x + y * y), -1.0, 1.0)) / M_PI;
}

}  // namespace

bool is_empty(const nlohmann::json& scene) {
  for (const auto& part : scene.value("parts", nlohmann::json::array()))
    if (part.value("pose", nlohmann::json()).is_object() && part.value("state", "") != "fixed") return false;
  return true;
}

nlohmann::json json_of(const HeapRecord& record) {
  nlohmann::json json = {{"heap", record.heap},
                         {"accepted", record.accepted},
                         {"wall_s", record.wall_s},
                         {"cpu_s", record.cpu_s},
                         {"memory_mb", record.memory_mb},
                         {"stages_ms", record.stages_ms},
                         {"scenes", nlohmann::json::array()},
                         {"rejected", nlohmann::json::array()}};
  for (const SceneRecord& scene : record.scenes)
    json["scenes"].push_back(
        {{"scene", scene.scene}, {"path", scene.path}, {"sha256", scene.sha256}, {"summary", scene.summary}});
  for (const RejectedRecord& rejected : record.rejected)
    json["rejected"].push_back({{"attempt", rejected.attempt}, {"path", rejected.path}, {"reasons", rejected.reasons}});
  return json;
}

HeapRecord record_of(const nlohmann::json& json) {
  HeapRecord record;
  record.heap = json.at("heap");
  record.accepted = json.at("accepted");
  record.wall_s = json.at("wall_s");
  record.cpu_s = json.at("cpu_s");
  record.memory_mb = json.at("memory_mb");
  record.stages_ms = json.at("stages_ms").get<std::map<std::string, double>>();
  for (const auto& scene : json.at("scenes"))
    record.scenes.push_back({scene.at("scene"), scene.at("path"), scene.at("sha256"), scene.at("summary")});
  for (const auto& rejected : json.at("rejected"))
    record.rejected.push_back({rejected.at("attempt"), rejected.at("path"), rejected.at("reasons")});
  return record;
}

namespace {

/// Of each sensor's image: instances that are visible by a tenth and more, between which depths they lie (m), and how
/// many of them have depth in less than 0.9, up to 0.99, and more of their visible pixels.
nlohmann::json seen_by(const nlohmann::json& scene) {
  nlohmann::json all = nlohmann::json::object();
  for (const auto& sensor : scene.value("sensors", nlohmann::json::array())) {
    if (!sensor.contains("truth")) continue;
    std::size_t seen = 0;
    double near = 0.0, far = 0.0;
    std::array<std::size_t, 3> holes{};
    for (const auto& part : sensor.at("truth")) {
      if (part.at("visible_fraction").get<double>() < 0.1) continue;
      const double depth = part.at("pose_in_camera").at("position").at(2);
      near = seen == 0 ? depth : std::min(near, depth);
      far = std::max(far, depth);
      ++seen;
      const double valid = part.at("px_count_measured").get<double>() / part.at("px_count_visib").get<double>();
      ++holes[valid < 0.9 ? 0 : valid <= 0.99 ? 1 : 2];
    }
    all[sensor.at("name").get<std::string>()] = {{"seen", seen}, {"depth", {near, far}}, {"holes", holes}};
  }
  return all;
}

}  // namespace

nlohmann::json summary_of(const nlohmann::json& scene) {
  std::vector<int> visible(bins, 0), tilt(bins, 0);
  std::vector<double> heights;
  std::size_t asked_for = 0;
  for (const auto& part : scene.at("parts")) {
    asked_for += part.at("state") != "fixed";
    if (!part.at("pose").is_object()) continue;
    count(tilt, tilt_of(part.at("pose").at("orientation_xyzw")));
    heights.push_back(part.at("pose").at("position").at(2).get<double>());
    for (const auto& [sensor, fraction] : part.at("visible_fraction").items()) count(visible, fraction);
  }
  double fill = 0.0;
  if (scene.at("bin").contains("inner_size") && !heights.empty()) {
    std::sort(heights.begin(), heights.end());
    const double height = scene.at("bin").at("inner_size").at(2);
    fill = heights[static_cast<std::size_t>(0.95 * static_cast<double>(heights.size() - 1))] / height;
  }
  const auto& report = scene.at("report");
  return {{"parts", heights.size()},
          {"not_poured", report.at("not_poured").size()},
          {"asked_for", asked_for},
          {"visible", visible},
          {"seen_by", seen_by(scene)},
          {"tilt", tilt},
          {"fill", fill},
          {"penetration", report.at("penetration").at("p95_relative")},
          {"rest_s", report.at("simulated_s")}};
}

}  // namespace bin_scenes
