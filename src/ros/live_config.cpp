#include "live_config.hpp"

#include <ros/console.h>

#include <algorithm>
#include <string>
#include <vector>

namespace bin_scenes {

namespace {

void keep_known(const char* name, const std::vector<std::string>& known, std::string& value,
                const std::string& before) {
  if (std::find(known.begin(), known.end(), value) != known.end()) return;
  std::string names;
  for (const std::string& one : known) names += (names.empty() ? "" : ", ") + one;
  ROS_ERROR("%s '%s' is unknown and refused, '%s' stays: give %s", name, value.c_str(), before.c_str(), names.c_str());
  value = before;
}

}  // namespace

LiveConfig::LiveConfig(const ros::NodeHandle& params, SceneJobs& jobs, Publication& publication)
    : server_(mutex_, params) {
  server_.setCallback([&jobs, &publication, before = BinScenesConfig::__getDefault__()](BinScenesConfig& config,
                                                                                        std::uint32_t) mutable {
    // dynamic_reconfigure takes any text for a choice: later jobs would fail over it.
    keep_known("finish", live_finishes(), config.finish, before.finish);
    keep_known("solver", live_solvers(), config.solver, before.solver);
    before = config;
    const auto chosen = [](const std::string& value) { return value == "request" ? std::string() : value; };
    jobs.set({chosen(config.finish), chosen(config.solver), config.noise});
    publication.set_tf(config.tf_rate, config.tf_span);
    publication.set_publish_rate(config.publish_rate);
  });
}

}  // namespace bin_scenes
