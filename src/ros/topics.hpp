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

/// Topic of one of `sensors` sensors: below its name, as graph_name() spells it. The only sensor, and that which is
/// named "camera", have the plain topics. The order of sensors makes no difference.
std::string of_sensor(const char* name, const std::string& sensor, std::size_t sensors);
}  // namespace topic

/// A scene as messages, all of one stamp; images are apart because they are made only if somebody looks.
struct SceneMessages {
  bin_scenes_msgs::Scene scene;
  visualization_msgs::MarkerArray markers;
  tf2_msgs::TFMessage parts;    ///< for /tf
  tf2_msgs::TFMessage statics;  ///< for /tf_static
  std_msgs::Header done;        ///< the event that ends an acquisition: stamp, and frame of the bin
};
void set_stamp(SceneMessages& messages, const ros::Time& stamp);

SceneMessages scene_messages(const Scene& scene, const LoadedRequest& loaded, const Frames& frames,
                             const ros::Time& stamp);

}  // namespace bin_scenes
