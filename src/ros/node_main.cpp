#include "bin_scenes/core/error.hpp"
#include "scene_server.hpp"

#include <ros/ros.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "bin_scenes");
  try {
    const bin_scenes::SceneServer server(ros::NodeHandle(), bin_scenes::read_settings(ros::NodeHandle("~")));
    ros::spin();
  } catch (const bin_scenes::Error& error) {
    ROS_FATAL("%s", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
