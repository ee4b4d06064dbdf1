#include "config/plan_misfit.hpp"

#include <algorithm>

namespace bin_scenes::config {

std::optional<Error> misfit(const Plan& plan, const Request& request) {
  const bool bop = plan.wants("bop") || plan.wants("shards");
  const bool needs_sensors = std::any_of(plan.formats.begin(), plan.formats.end(), [](const std::string& name) {
    const SceneFormat* format = find_scene_format(name);
    return format && format->needs == SceneFormat::Needs::sensors;
  });
  if ((bop || needs_sensors) && request.sensors.empty())
    return input_error("the outputs show what a sensor sees, but the request has no sensors", "outputs",
                       "add `sensors: [{name: camera}]`, or leave such outputs out");
  if ((plan.wants("grasps") || plan.depletion.by_grasp) && request.grippers.empty())
    return input_error("grasps are requested, but the request has no grippers", "outputs",
                       "add for instance `grippers: [robotiq_2f_85]`");
  if (!bop) return std::nullopt;
  if (request.sensors.size() != plan.reference.sensors.size())
    return input_error("BOP has the same number of images in each scene, one a sensor", "outputs",
                       "draw no number of sensors, or leave bop and shards out");
  for (const Sensor& sensor : request.sensors)
    if (const std::string why = bop_misfit(sensor); !why.empty()) return input_error(why, "outputs", bop_misfit_remedy);
  return std::nullopt;
}

void note_losses(Plan& plan, const std::optional<Distribution>& parts) {
  if (const std::string loss = bop_loss(plan.reference.sensors); !loss.empty()) plan.notes.push_back(loss);
  if (plan.most_targets > 0) return;
  std::size_t most = 0;
  if (!parts)
    for (const PartLine& line : plan.reference.parts) most += line.count;
  else if (parts->kind == Distribution::Kind::constant)
    most = static_cast<std::size_t>(parts->a);
  else
    for (const std::string& end : parts->ends(YAML::Node()))
      most = std::max(most, static_cast<std::size_t>(std::stod(end)));
  if (most <= bop_most_estimates) return;
  const std::string kept = std::to_string(bop_most_estimates);
  plan.notes.push_back("a heap may have " + std::to_string(most) + " parts, and bop_toolkit keeps " + kept +
                       " estimates an image: bop: {most_targets: " + kept +
                       "} leaves images with more visible parts out of the targets");
}

}  // namespace bin_scenes::config
