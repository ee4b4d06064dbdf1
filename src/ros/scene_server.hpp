/// The node's work: makes scenes on request and says them on topics.
///
///     generate_scene, clear_scene,        work queue, one thread          publishers
///     new image subscribers          ───────────────────────────►  generate, render, convert ─► topics
///                                    (owns GL, generator, scene)                │
///     timer of the spinner  ◄───────── part transforms (mutex) ◄────────────────┘
///
/// All that touches a scene runs in the one thread that spins the work queue, so that nothing but the transforms, which
/// are sent again at a steady rate while a scene is being made, needs a lock. An action server or a nodelet comes
/// beside this class: the former calls make() from the same queue, the latter owns one as node_main does.
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "lazy_topic.hpp"
#include "settings.hpp"
#include "topics.hpp"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace bin_scenes {

class SceneServer {
 public:
  /// `node` resolves the names of topics and services. The timer that re-sends transforms runs in its callback queue,
  /// which the caller spins.
  SceneServer(const ros::NodeHandle& node, Settings settings);
  /// Cancels a scene that is being made.
  ~SceneServer();

 private:
  using GenerateScene = bin_scenes_msgs::GenerateScene;

  /// The scene that the topics show.
  struct Shown {
    Scene scene;
    Request request;
    std::vector<PartModelPtr> parts;
    PartModelPtr bin_model;
    ros::Time stamp;
    std::vector<RangeImage> images;  ///< empty until somebody looks
  };

  /// Topics of one sensor.
  struct SensorTopics {
    std::string name;
    LazyTopic<sensor_msgs::PointCloud2> points;
    LazyTopic<sensor_msgs::Image> depth;
    LazyTopic<sensor_msgs::CameraInfo> camera_info;
    LazyTopic<sensor_msgs::Image> labels, validity;

    SensorTopics(SceneServer& server, std::size_t index, const std::string& name);
    bool wanted() const {
      return points.wanted() || depth.wanted() || camera_info.wanted() || labels.wanted() || validity.wanted();
    }
    void renew();
  };

  void work();
  bool generate(GenerateScene::Request& request, GenerateScene::Response& response);
  bool clear(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);

  void make(const bin_scenes_msgs::SceneRequest& message, GenerateScene::Response& response);
  void show(Shown shown, bool render);
  /// False if there was nothing left to do.
  bool render();
  void publish_scene();
  void send_transforms();
  template <class Message, class Convert>
  std::function<std::optional<Message>()> from_image(std::size_t sensor, Convert convert);

  ros::NodeHandle node_;
  Settings settings_;
  ros::CallbackQueue queue_;
  std::atomic<bool> stop_{false};

  // Of the work thread alone.
  std::unique_ptr<Generator> generator_;
  SensorRig rig_;
  std::unique_ptr<Shown> shown_;
  std::vector<std::unique_ptr<SensorTopics>> sensors_;
  ros::Publisher scene_, markers_, tf_static_;
  ros::ServiceServer generate_service_, clear_service_;

  std::mutex transforms_mutex_;
  tf2_msgs::TFMessage transforms_;
  ros::Publisher tf_;
  ros::WallTimer tf_timer_;

  std::thread worker_;
};

}  // namespace bin_scenes
