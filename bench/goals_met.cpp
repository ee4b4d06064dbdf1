#include "goals_met.hpp"

#include "runs.hpp"

#include <algorithm>

namespace bin_scenes::bench {

namespace {

struct Goal {
  const char* column;
  double limit;
};
constexpr Goal own[] = {
    {"penetration_p95_rel", 0.003}, {"penetration_max_rel", 0.01}, {"bin_penetration_max_rel", 0.003}};
constexpr Goal referees[] = {
    {"drift_median_rel", 0.001}, {"drift_p95_rel", 0.01}, {"turn_p95_deg", 0.5}, {"report_to_referee_rel", 0.0005}};

template <class Goals>
bool within(const Row& scene, const Goals& goals) {
  return std::all_of(std::begin(goals), std::end(goals),
                     [&](const Goal& goal) { return scene.number(goal.column) <= goal.limit; });  // false for NaN
}

/// The largest value of a column over the scenes that have it.
void add_worst(Row& out, const std::vector<Row>& scenes, const std::string& column) {
  std::vector<double> values;
  for (const Row& scene : scenes)
    if (!scene.at(column).empty()) values.push_back(scene.number(column));
  if (!values.empty()) out.measure("worst_" + column, *std::max_element(values.begin(), values.end()));
}

}  // namespace

Row over_all(std::vector<Row> scenes) {
  if (scenes.back().at("scenes").empty()) return scenes.back();
  for (Row& scene : scenes) {
    const bool whole = scene.at("at_rest") == "1" && scene.at("escaped") == "0" && within(scene, own);
    const bool judged = !scene.at("report_to_referee_rel").empty();
    scene.exact("meets_own", static_cast<int>(whole))
        .exact("judged", static_cast<int>(judged))
        .exact("meets_all", static_cast<int>(whole && judged && within(scene, referees)));
  }
  Row out = joined(scenes);
  for (const Goal& goal : own) add_worst(out, scenes, goal.column);
  for (const Goal& goal : referees) add_worst(out, scenes, goal.column);
  return out;
}

}  // namespace bin_scenes::bench
