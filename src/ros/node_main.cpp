/// The node: one bin, or several with names of their own (~bins).
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/freed_memory.hpp"
#include "master_watch.hpp"
#include "scene_server.hpp"

#include <ros/init.h>
#include <ros/names.h>
#include <ros/ros.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace {

using bin_scenes::SceneServer;

std::vector<std::unique_ptr<SceneServer>> servers() {
  const ros::NodeHandle params("~");
  std::vector<std::string> bins;
  if (params.hasParam("bins") && !params.getParam("bins", bins)) {
    throw bin_scenes::input_error("is of another type", "parameter " + params.resolveName("bins"),
                                  "give a list of names: [left, right]");
  }
  std::vector<std::unique_ptr<SceneServer>> all;
  if (bins.empty()) all.push_back(std::make_unique<SceneServer>(ros::NodeHandle(), params));
  for (const std::string& bin : bins) {
    std::string reason;
    if (bin.empty() || bin[0] == '/' || !ros::names::validate(bin, reason)) {
      throw bin_scenes::input_error("holds '" + bin + "', which is no name of a namespace",
                                    "parameter " + params.resolveName("bins"), "use letters, digits and _");
    }
    all.push_back(std::make_unique<SceneServer>(ros::NodeHandle(bin), ros::NodeHandle(params, bin),
                                                SceneServer::Host::node, bin + "/"));
  }
  return all;
}

/// What does not stop by itself (a driver that compiles shaders) does not hold up the end of the node.
void end_within_half_a_second() {
  std::signal(SIGALRM, [](int) { _exit(0); });
  const itimerval once{{0, 0}, {0, 500'000}};
  setitimer(ITIMER_REAL, &once, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  bin_scenes::keep_freed_memory();
  ros::init(argc, argv, "bin_scenes");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });  // as roscpp does for SIGINT
  ros::NodeHandle node;                                       // the log topic works from here on
  try {
    const auto running = servers();
    const bin_scenes::MasterWatch watch;
    ros::spin();
    end_within_half_a_second();
  } catch (const bin_scenes::Error& error) {
    ROS_FATAL("%s", error.what());
    // Also where roslaunch sends logs to files only, and before rosconsole has found its output.
    std::cerr << "bin_scenes_node: " << error.what() << std::endl;
    return static_cast<int>(error.kind());
  }
  return 0;
}
