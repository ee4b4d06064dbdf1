#include "dataset/published.hpp"

#include "core/formatted.hpp"

#include <algorithm>
#include <numeric>

namespace bin_scenes {

namespace {

constexpr const char* xyz_ibd = "XYZ-IBD, validation images (arXiv 2506.00599)";
constexpr const char* grasp_clutter = "GraspClutter6D (arXiv 2504.06866)";

}  // namespace

void Seen::add(const nlohmann::json& summary) {
  const std::size_t parts = summary.at("parts");
  least_ = scenes_ == 0 ? parts : std::min(least_, parts);
  most_ = std::max(most_, parts);
  ++scenes_;
  const auto visible = summary.at("visible").get<std::vector<std::size_t>>();
  visible_.resize(visible.size());
  std::transform(visible.begin(), visible.end(), visible_.begin(), visible_.begin(), std::plus<>());
  if (!summary.contains("seen_by")) return;  // made by a version before 0.3
  for (const auto& [name, image] : summary.at("seen_by").items()) {
    BySensor& sensor = sensors_[name];
    const std::size_t seen = image.at("seen");
    ++sensor.images;
    if (seen == 0) continue;
    const auto depth = image.at("depth").get<std::array<double, 2>>();
    sensor.near = sensor.instances == 0 ? depth[0] : std::min(sensor.near, depth[0]);
    sensor.far = std::max(sensor.far, depth[1]);
    sensor.instances += seen;
    for (std::size_t i = 0; i < 3; ++i) sensor.holes[i] += image.at("holes").at(i).get<std::size_t>();
  }
}

nlohmann::json Seen::rows() const {
  nlohmann::json rows = nlohmann::json::array();
  if (scenes_ == 0) return rows;
  rows.push_back({"parts a bin", formatted("%zu to %zu", least_, most_), "10 to 59 copies of one part", xyz_ibd});
  const double all = static_cast<double>(std::accumulate(visible_.begin(), visible_.end(), std::size_t{0}));
  if (all > 0.0)
    rows.push_back({"instances visible by at most 95 %",
                    formatted("%.1f %%", 100.0 * (1.0 - static_cast<double>(visible_.back()) / all)), "62.6 %",
                    grasp_clutter});
  for (const auto& [name, sensor] : sensors_) {
    if (sensor.instances == 0) continue;
    const auto count = static_cast<double>(sensor.instances);
    rows.push_back({name + ": instances visible by 10 % and more, an image",
                    formatted("%.1f", count / static_cast<double>(sensor.images)), "26.6", xyz_ibd});
    rows.push_back({name + ": depth of these instances",
                    formatted("%.0f to %.0f mm", 1e3 * sensor.near, 1e3 * sensor.far), "604 to 828 mm", xyz_ibd});
    const auto share = [&](std::size_t i) { return 100.0 * static_cast<double>(sensor.holes[i]) / count; };
    rows.push_back({name + ": instances with depth in less than 0.90, up to 0.99, more of their visible pixels",
                    formatted("%.1f, %.1f, %.1f %%", share(0), share(1), share(2)), "2.7, 22.7, 74.7 % (RealSense)",
                    xyz_ibd});
  }
  return rows;
}

}  // namespace bin_scenes
