/// Publishes the last scene: its message, its images if there are subscribers, and its frames. All of this happens in a
/// separate thread, so that subscribers are served and the scene is published repeatedly while the next one is made.
#pragma once

#include "lazy_topic.hpp"
#include "part_frames.hpp"
#include "scene_maker.hpp"
#include "settings.hpp"
#include "thread_queue.hpp"
#include "topics.hpp"

#include "bin_scenes/sensor/sensor_rig.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

namespace bin_scenes {

class Publication {
 public:
  /// `node` resolves the names of topics; its queue runs the timer of the frames. `in_process`: subscribers in this
  /// process get images without a copy (LazyTopic).
  Publication(const ros::NodeHandle& node, const Settings& settings, bool in_process);
  ~Publication();

  /// Makes the images of a new scene that have subscribers, or all of them; in the calling thread.
  void render(MadeScene& made, bool all, const RunHooks& hooks);
  /// Publishes a scene under a new stamp, and returns its message. If it throws, the earlier scene remains published.
  bin_scenes_msgs::Scene show(MadeScene made);
  /// Returns the stamp of the published scene, which changes when it is published again; zero: there is no scene.
  ros::Time stamp();
  void set_tf(double rate, double span) { frames_.set(rate, span); }
  void set_publish_rate(double rate);

  struct Counts {
    std::size_t scenes = 0;           ///< number of published scenes since the start
    std::size_t renderings = 0;       ///< number of images made for scenes that were published already
    std::size_t render_failures = 0;  ///< number of images of the present scene that could not be made
    std::size_t sensors = 0;          ///< number of sensors of the present scene
  };
  Counts counts() const;

 private:
  struct Shown {
    MadeScene made;
    SceneMessages messages;
    ros::Time stamp;
  };
  struct SensorTopics;

  void publish(Shown& shown);
  void publish_again();
  void show_images();
  bool make_images(Shown& shown);
  /// By sensor: whether one of its topics has subscribers, and whether its topic of the grey image has.
  struct Wanted {
    std::vector<bool> images, gray;
  };
  Wanted wanted(const std::vector<Sensor>& sensors) const;
  std::size_t take_images(MadeScene& made, const Wanted& wanted);
  void set_topics(const std::vector<Sensor>& sensors);
  template <class Message, class Convert>
  std::function<std::optional<Message>()> from_image(const SensorTopics& topics, Convert convert);

  ThreadQueue thread_;
  ros::NodeHandle node_;  ///< its callbacks run in `thread_`
  const Frames place_;
  const bool rgb_, in_process_;
  PartFrames frames_;
  SensorRig rig_;
  std::optional<Shown> shown_;
  std::vector<std::unique_ptr<SensorTopics>> sensors_;
  ros::Publisher scene_, markers_, tf_static_, done_;
  ros::WallTimer again_;
  std::atomic<std::size_t> scenes_{0}, renderings_{0}, render_failures_{0}, shown_sensors_{0};
};

}  // namespace bin_scenes
