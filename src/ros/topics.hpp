/// The messages of one scene with the names of their topics. The node and the bag writer share them, so that a bag that
/// is made offline equals a recording of the node.
#pragma once

#include "image_messages.hpp"
#include "markers.hpp"
#include "scene_message.hpp"

namespace bin_scenes {

/// Topic names, relative to the node's namespace.
namespace topic {
constexpr char scene[] = "scene";
constexpr char markers[] = "markers";
constexpr char contacts[] = "contacts";  ///< markers of the contacts of a trace
constexpr char points[] = "points";
constexpr char depth[] = "depth/image_rect";
constexpr char camera_info[] = "depth/camera_info";
constexpr char labels[] = "labels/image_raw";
constexpr char validity[] = "validity/image_raw";
constexpr char gray[] = "gray/image_raw";
constexpr char picture[] = "image_raw";
constexpr char picture_info[] = "camera_info";
constexpr char acquisition_done[] = "acquisition_done";
constexpr char tf[] = "/tf";
constexpr char tf_static[] = "/tf_static";

/// Returns the topic of a sensor: the plain topic if it is the only sensor or is named "camera", otherwise the topic
/// below the name of the sensor as graph_name() spells it. `sensors` is the number of sensors.
std::string of_sensor(const char* name, const std::string& sensor, std::size_t sensors);
}  // namespace topic

/// The messages of a scene, all with one stamp, without images, which are made only if there are subscribers.
struct SceneMessages {
  bin_scenes_msgs::Scene scene;
  visualization_msgs::MarkerArray markers;
  tf2_msgs::TFMessage parts;    ///< transforms for /tf
  tf2_msgs::TFMessage statics;  ///< transforms for /tf_static
  std_msgs::Header done;        ///< message that signals the end of an acquisition: its stamp, and the bin frame
};
void set_stamp(SceneMessages& messages, const ros::Time& stamp);

SceneMessages scene_messages(const Scene& scene, const LoadedRequest& loaded, const Frames& frames,
                             const ros::Time& stamp);

}  // namespace bin_scenes
