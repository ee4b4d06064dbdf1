#include "config/plan_misfit.hpp"

namespace bin_scenes::config {

std::optional<Error> misfit(const Plan& plan, const Request& request) {
  const bool bop = plan.wants("bop") || plan.wants("shards");
  if ((bop || plan.wants("png") || plan.wants("pcd") || plan.wants("ply")) && request.sensors.empty())
    return input_error("the outputs show what a sensor sees, but the request has no sensors", "outputs",
                       "add `sensors: [{name: camera}]`, or leave such outputs out");
  if ((plan.wants("grasps") || plan.depletion.by_grasp) && request.grippers.empty())
    return input_error("grasps are asked for, but the request has no grippers", "outputs",
                       "add for instance `grippers: [robotiq_2f_85]`");
  if (!bop) return std::nullopt;
  if (request.sensors.size() != plan.reference.sensors.size())
    return input_error("BOP has the same number of images in each scene, one a sensor", "outputs",
                       "draw no number of sensors, or leave bop and shards out");
  for (const Sensor& sensor : request.sensors)
    if (const std::string why = bop_misfit(sensor); !why.empty()) return input_error(why, "outputs", bop_misfit_remedy);
  return std::nullopt;
}

}  // namespace bin_scenes::config
