#include "live_config.hpp"

namespace bin_scenes {

LiveConfig::LiveConfig(const ros::NodeHandle& params, SceneJobs& jobs, Publication& publication)
    : server_(mutex_, params) {
  server_.setCallback([&jobs, &publication](BinScenesConfig& config, std::uint32_t) {
    const auto chosen = [](const std::string& value) { return value == "request" ? std::string() : value; };
    jobs.set({chosen(config.finish), chosen(config.solver), config.noise});
    publication.set_tf(config.tf_rate, config.tf_span);
    publication.set_publish_rate(config.publish_rate);
  });
}

}  // namespace bin_scenes
