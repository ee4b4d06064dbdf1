/// Messages of the scene that is shown, made once, and images when they are asked for. All members belong to the thread
/// of the queue.
#include "publication.hpp"

#include <ros/console.h>

#include <algorithm>
#include <list>

namespace bin_scenes {

namespace {

template <class Message>
void publish_to(const ros::Publisher& publisher, const Message& message) {
  publish_latched(publisher, boost::make_shared<Message>(message));
}

}  // namespace

/// Topics of one sensor.
struct Publication::SensorTopics {
  std::string space;      ///< in front of the names of its topics
  std::size_t index = 0;  ///< of the sensor in the scene shown
  LazyTopic<sensor_msgs::PointCloud2> points;
  LazyTopic<sensor_msgs::Image> depth;
  LazyTopic<sensor_msgs::CameraInfo> camera_info, picture_info;
  LazyTopic<sensor_msgs::Image> labels, validity, gray, picture;
  std::list<LazyTopic<sensor_msgs::Image>> channels;  ///< those of the table that have a topic

  SensorTopics(Publication& p, const std::string& name_space)
      : space(name_space),
        points(options(p, topic::points), p.from_image<sensor_msgs::PointCloud2>(*this, clouds(p.rgb_))),
        depth(options(p, topic::depth), p.from_image<sensor_msgs::Image>(*this, depth_message)),
        camera_info(options(p, topic::camera_info), p.from_image<sensor_msgs::CameraInfo>(*this, model)),
        picture_info(options(p, topic::picture_info), p.from_image<sensor_msgs::CameraInfo>(*this, model_of_picture)),
        labels(options(p, topic::labels), p.from_image<sensor_msgs::Image>(*this, label_message)),
        validity(options(p, topic::validity), p.from_image<sensor_msgs::Image>(*this, validity_message)),
        gray(options(p, topic::gray), p.from_image<sensor_msgs::Image>(*this, gray_message)),
        picture(options(p, topic::picture), p.from_image<sensor_msgs::Image>(*this, picture_message)) {
    for (const ImageChannel& channel : image_channels())
      if (!channel.topic.empty())
        channels.emplace_back(
            options(p, channel.topic.c_str()),
            p.from_image<sensor_msgs::Image>(*this, [channel](const RangeImage& image, const std_msgs::Header& header) {
              return channel_message(channel, image, header);
            }));
  }

  LazyTopicOptions options(Publication& p, const char* name) const {
    return {p.node_, space + name, [&p] { p.show_images(); }, p.in_process_};
  }
  static std::optional<sensor_msgs::CameraInfo> model(const RangeImage& image, const std_msgs::Header& header) {
    auto message = camera_info_message(image, header);
    if (!message)
      ROS_WARN_ONCE(
          "no camera_info of sensor %s: the rows of a laser_line's image are profiles, which no camera model "
          "describes; take its cloud",
          image.sensor.name.c_str());
    return message;
  }
  static std::optional<sensor_msgs::CameraInfo> model_of_picture(const RangeImage& image,
                                                                 const std_msgs::Header& header) {
    return image.picture.channels > 0 ? camera_info_message(image, header) : std::nullopt;
  }
  static std::function<sensor_msgs::PointCloud2(const RangeImage&, const std_msgs::Header&)> clouds(bool rgb) {
    return [rgb](const RangeImage& image, const std_msgs::Header& header) {
      return rgb ? colored_cloud_message(image, header) : cloud_message(image, header);
    };
  }

  bool wanted() const {
    return points.wanted() || depth.wanted() || camera_info.wanted() || labels.wanted() || validity.wanted() ||
           gray.wanted() || picture.wanted() || picture_info.wanted() ||
           std::any_of(channels.begin(), channels.end(), [](const auto& topic) { return topic.wanted(); });
  }
  void renew() {
    points.renew();
    depth.renew();
    camera_info.renew();
    labels.renew();
    validity.renew();
    gray.renew();
    picture.renew();
    picture_info.renew();
    for (auto& topic : channels) topic.renew();
  }
  void show() {
    points.show();
    depth.show();
    camera_info.show();
    labels.show();
    validity.show();
    gray.show();
    picture.show();
    picture_info.show();
    for (auto& topic : channels) topic.show();
  }
};

template <class Message, class Convert>
std::function<std::optional<Message>()> Publication::from_image(const SensorTopics& topics, Convert convert) {
  return [this, &topics, convert]() -> std::optional<Message> {
    if (!shown_ || topics.index >= shown_->made.images.size()) return std::nullopt;
    const RangeImage& image = shown_->made.images[topics.index];
    if (image.depth.empty()) return std::nullopt;
    std_msgs::Header header;
    header.stamp = shown_->stamp;
    header.frame_id = sensor_frame(image.sensor.name, place_.prefix);
    return convert(image, header);
  };
}

Publication::Publication(const ros::NodeHandle& node, const Settings& settings, bool in_process)
    : node_(node),
      place_(settings.frames),
      rgb_(settings.rgb),
      in_process_(in_process),
      frames_(node, place_.prefix + "removed_parts", settings.tf_rate, settings.tf_span,
              [this] { thread_.post([this] { publish_again(); }); }) {
  node_.setCallbackQueue(thread_.queue());
  scene_ = node_.advertise<bin_scenes_msgs::Scene>(topic::scene, 1, true);
  markers_ = node_.advertise<visualization_msgs::MarkerArray>(topic::markers, 1, true);
  // Bins of one process share this topic and its queue, which takes the last message of each for whoever comes late.
  tf_static_ = node_.advertise<tf2_msgs::TFMessage>(topic::tf_static, 100, true);
  done_ = node_.advertise<std_msgs::Header>(topic::acquisition_done, 10);
  set_topics({Sensor()});
  set_publish_rate(settings.publish_rate);
}

Publication::~Publication() {
  thread_.stop();
  again_.stop();
}

void Publication::set_publish_rate(double rate) {
  thread_.post([this, rate] {  // where the timer is served: it may be at work
    again_.stop();
    if (!(rate > 0.0)) return;
    const auto tick = [this](const ros::WallTimerEvent&) { publish_again(); };
    again_ = node_.createWallTimer(ros::WallDuration(1.0 / rate), tick);
  });
}

/// Which of the sensors somebody listens to. Those whose topics have yet to be made have no listeners.
Publication::Wanted Publication::wanted(const std::vector<Sensor>& sensors) const {
  Wanted wanted{std::vector<bool>(sensors.size(), false), std::vector<bool>(sensors.size(), false)};
  for (std::size_t s = 0; s < sensors.size(); ++s) {
    const std::string space = topic::of_sensor("", sensors[s].name, sensors.size());
    for (const auto& topics : sensors_) {
      if (topics->space != space) continue;
      wanted.images[s] = topics->wanted();
      wanted.gray[s] = topics->gray.wanted();
    }
  }
  return wanted;
}

/// Makes the images that are wanted and not there. One that was made without its grey image is made again with it.
/// Returns how many were made.
std::size_t Publication::take_images(MadeScene& made, const Wanted& wanted) {
  made.with_gray.resize(made.images.size(), false);
  std::vector<bool> missing = wanted.images;
  bool gray = false;
  for (std::size_t s = 0; s < missing.size(); ++s) {
    const bool lacks_gray = wanted.gray[s] && !made.with_gray[s];
    missing[s] = missing[s] && (made.images[s].depth.empty() || lacks_gray);
    gray = gray || (missing[s] && lacks_gray);
    if (missing[s]) made.images[s] = RangeImage();
  }
  const auto count = static_cast<std::size_t>(std::count(missing.begin(), missing.end(), true));
  if (count == 0) return 0;
  const StageTimer timer(made.scene.report.profile, "render");
  rig_.render(made.scene, made.loaded, missing, made.images, gray);
  for (std::size_t s = 0; s < missing.size(); ++s)
    if (missing[s]) made.with_gray[s] = gray;
  return count;
}

void Publication::render(MadeScene& made, bool all, const RunHooks& hooks) {
  const std::vector<Sensor>& sensors = made.scene.sensors;
  Wanted these = thread_.call([&] { return wanted(sensors); });
  if (all) these.images.assign(sensors.size(), true);
  if (std::none_of(these.images.begin(), these.images.end(), [](bool wanted) { return wanted; })) return;
  if (hooks.progress) {
    Progress progress;
    progress.phase = "render";
    progress.parts = made.scene.parts.size();
    hooks.progress(progress);
  }
  take_images(made, these);
}

Publication::Counts Publication::counts() const {
  return {scenes_, renderings_, render_failures_, shown_sensors_};
}

bin_scenes_msgs::Scene Publication::show(MadeScene made) {
  return thread_.call([&] {
    // What may fail comes first: the scene before is there until this one is whole.
    Shown next{std::move(made), {}, {}};
    make_images(next);  // for those who came since render()
    next.messages = scene_messages(next.made.scene, next.made.loaded, place_, {});
    shown_ = std::move(next);
    set_topics(shown_->made.scene.sensors);
    shown_sensors_ = shown_->made.scene.sensors.size();
    render_failures_ = 0;
    ++scenes_;
    publish(*shown_);
    return shown_->messages.scene;
  });
}

ros::Time Publication::stamp() {
  return thread_.call([this] { return shown_ ? shown_->stamp : ros::Time(); });
}

void Publication::publish(Shown& shown) {
  // First of all, because whoever gets a cloud looks up the parts at its stamp.
  shown.stamp = frames_.show(shown.messages.parts);
  set_stamp(shown.messages, shown.stamp);
  publish_to(tf_static_, shown.messages.statics);
  publish_to(scene_, shown.messages.scene);
  publish_to(markers_, shown.messages.markers);
  for (const auto& topics : sensors_) topics->renew();
  show_images();
  done_.publish(shown.messages.done);
}

void Publication::publish_again() {
  if (shown_) publish(*shown_);
}

void Publication::show_images() {
  if (!shown_) return;
  try {
    if (make_images(*shown_)) {  // the scene that is out does not know yet how much of each part is seen
      shown_->messages.scene = scene_message(shown_->made.scene, shown_->made.loaded.request, place_, shown_->stamp);
      publish_to(scene_, shown_->messages.scene);
    }
    for (const auto& topics : sensors_) topics->show();
  } catch (const std::exception& error) {
    // Once a scene: publish_rate would repeat it for ever.
    if (render_failures_++ == 0) ROS_ERROR("no image: %s", error.what());
  }
}

/// Those that are wanted and not there yet; returns whether there were any.
bool Publication::make_images(Shown& shown) {
  const std::size_t count = take_images(shown.made, wanted(shown.made.scene.sensors));
  renderings_ += count;
  return count > 0;
}

/// Topics that stay keep their subscribers; those that no sensor has any more go. Without sensors the plain ones stay.
void Publication::set_topics(const std::vector<Sensor>& sensors) {
  std::vector<std::unique_ptr<SensorTopics>> next;
  const auto take = [&](const std::string& space, std::size_t index) {
    const auto known = std::find_if(sensors_.begin(), sensors_.end(),
                                    [&](const auto& topics) { return topics && topics->space == space; });
    next.push_back(known != sensors_.end() ? std::move(*known) : std::make_unique<SensorTopics>(*this, space));
    next.back()->index = index;
  };
  for (std::size_t i = 0; i < sensors.size(); ++i) take(topic::of_sensor("", sensors[i].name, sensors.size()), i);
  if (sensors.empty()) take("", 0);
  sensors_ = std::move(next);
}

}  // namespace bin_scenes
