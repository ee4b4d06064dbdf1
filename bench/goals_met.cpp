#include "goals_met.hpp"

#include "runs.hpp"

#include <algorithm>
#include <string>

namespace bin_scenes::bench {

namespace {

struct Goal {
  const char* column;
  double limit;
};
constexpr Goal goals[] = {
    {"penetration_p95_rel", 0.003}, {"penetration_max_rel", 0.01}, {"bin_penetration_max_rel", 0.003},
    {"drift_median_rel", 0.001},    {"drift_p95_rel", 0.01},       {"turn_p95_deg", 0.5}};

/// 1 if a scene is at rest, whole, and within every goal that was measured; a referee that failed has not agreed.
int meets(const Row& scene) {
  if (!scene.at("status").empty()) return 0;
  if (scene.at("at_rest") != "1" || scene.at("escaped") != "0") return 0;
  return std::none_of(std::begin(goals), std::end(goals),
                      [&](const Goal& goal) { return scene.number(goal.column) > goal.limit; });
}

}  // namespace

Row over_all(std::vector<Row> scenes) {
  if (scenes.back().at("scenes").empty()) return scenes.back();
  for (Row& scene : scenes) scene.exact("meets_goals", meets(scene));
  Row out = joined(scenes);
  for (const Goal& goal : goals) {
    std::vector<double> values;
    for (const Row& scene : scenes)
      if (!scene.at(goal.column).empty()) values.push_back(scene.number(goal.column));
    if (!values.empty())
      out.measure(std::string("worst_") + goal.column, *std::max_element(values.begin(), values.end()));
  }
  return out;
}

}  // namespace bin_scenes::bench
