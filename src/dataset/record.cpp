#include "dataset/record.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr std::size_t bins = 20;

void count(std::vector<int>& histogram, double share) {
  BIN_SCENES_ASSERT(histogram.size() == bins);
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(bins);
  ++histogram[std::min(bins - 1, static_cast<std::size_t>(place))];
}

/// Angle between the model's z axis and the bin's, as a share of half a turn.
double tilt_of(const Quat& q) {
  return std::acos(std::clamp(1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()), -1.0, 1.0)) / M_PI;
}

}  // namespace

bool is_empty(const SceneFile& scene) {
  return std::none_of(scene.parts.begin(), scene.parts.end(),
                      [](const ScenePart& part) { return part.pose.finite() && part.state != PartState::fixed; });
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
nlohmann::json seen_by(const SceneFile& scene) {
  nlohmann::json all = nlohmann::json::object();
  for (const SceneSensor& sensor : scene.sensors) {
    if (!sensor.truth) continue;
    std::size_t seen = 0;
    double near = 0.0, far = 0.0;
    std::array<std::size_t, 3> holes{};
    for (const PartTruth& part : *sensor.truth) {
      if (part.visible_fraction < 0.1) continue;
      const double depth = part.pose_in_camera.position.z();
      near = seen == 0 ? depth : std::min(near, depth);
      far = std::max(far, depth);
      ++seen;
      const double valid = static_cast<double>(part.measured_pixels) / static_cast<double>(part.visible_pixels);
      ++holes[valid < 0.9 ? 0 : valid <= 0.99 ? 1 : 2];
    }
    all[sensor.name] = {{"seen", seen}, {"depth", {near, far}}, {"holes", holes}};
  }
  return all;
}

}  // namespace

nlohmann::json summary_of(const SceneFile& scene) {
  std::vector<int> visible(bins, 0), tilt(bins, 0);
  std::vector<double> heights;
  std::size_t asked_for = 0;
  for (const ScenePart& part : scene.parts) {
    asked_for += part.state != PartState::fixed;
    if (!part.pose.finite()) continue;
    count(tilt, tilt_of(part.pose.orientation));
    heights.push_back(part.pose.position.z());
    for (const auto& [sensor, fraction] : part.visible_fraction) count(visible, fraction);
  }
  double fill = 0.0;
  if (scene.bin.kind == Bin::Kind::box && !heights.empty()) {
    std::sort(heights.begin(), heights.end());
    fill = heights[static_cast<std::size_t>(0.95 * static_cast<double>(heights.size() - 1))] / scene.bin.inner_size.z();
  }
  BIN_SCENES_ASSERT(heights.size() <= scene.parts.size() &&
                    std::accumulate(tilt.begin(), tilt.end(), std::size_t{0}) == heights.size());
  const Report& report = scene.report;
  return {{"parts", heights.size()},
          {"not_poured", report.not_poured.size()},
          {"asked_for", asked_for},
          {"visible", visible},
          {"seen_by", seen_by(scene)},
          {"tilt", tilt},
          {"fill", fill},
          {"penetration", report.penetration.p95_relative},
          {"rest_s", report.simulated_s}};
}

}  // namespace bin_scenes
