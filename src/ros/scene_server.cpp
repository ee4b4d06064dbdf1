#include "scene_server.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "latched.hpp"
#include "request_message.hpp"

#include <malloc.h>
#include <ros/console.h>

#include <new>

namespace bin_scenes {

namespace {

using Code = bin_scenes_msgs::ErrorCode;

std::int32_t code_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::input:
      return Code::INPUT;
    case ErrorKind::environment:
      return Code::ENVIRONMENT;
    case ErrorKind::cancelled:
      return Code::CANCELLED;
  }
  return Code::INTERNAL;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

/// Seen pixels of a part / pixels it would have alone, for parts that the sensor's view holds at all.
void set_visible_fractions(Scene& scene, const RangeImage& image) {
  for (ScenePart& part : scene.parts) {
    const std::size_t id = static_cast<std::size_t>(part.id);
    if (id >= image.total.size()) continue;
    part.visible_fraction[image.sensor.name] = image.total[id] ? double(image.visible[id]) / image.total[id] : 0.0;
  }
}

}  // namespace

template <class Message, class Convert>
std::function<std::optional<Message>()> SceneServer::from_image(std::size_t sensor, Convert convert) {
  return [this, sensor, convert]() -> std::optional<Message> {
    if (!shown_ || sensor >= shown_->scene.sensors.size()) return std::nullopt;
    try {
      if (render()) publish_scene();  // the latched one does not know yet how much of each part is seen
      const RangeImage& image = shown_->images.at(sensor);
      std_msgs::Header header;
      header.stamp = shown_->stamp;
      header.frame_id = sensor_frame(image.sensor.name);
      return convert(image, header);
    } catch (const std::exception& error) {
      ROS_ERROR("no image: %s", error.what());
      return std::nullopt;
    }
  };
}

SceneServer::SensorTopics::SensorTopics(SceneServer& server, std::size_t index, const std::string& sensor)
    : name(sensor),
      points(server.node_, topic::of_sensor(topic::points, index, sensor), &server.queue_,
             server.from_image<sensor_msgs::PointCloud2>(index, cloud_message)),
      depth(server.node_, topic::of_sensor(topic::depth, index, sensor), &server.queue_,
            server.from_image<sensor_msgs::Image>(index, depth_message)),
      camera_info(server.node_, topic::of_sensor(topic::camera_info, index, sensor), &server.queue_,
                  server.from_image<sensor_msgs::CameraInfo>(
                      index, [](const RangeImage& image,
                                const std_msgs::Header& header) { return camera_info_message(image.sensor, header); })),
      labels(server.node_, topic::of_sensor(topic::labels, index, sensor), &server.queue_,
             server.from_image<sensor_msgs::Image>(index, label_message)) {}

void SceneServer::SensorTopics::renew() {
  points.renew();
  depth.renew();
  camera_info.renew();
  labels.renew();
}

SceneServer::SceneServer(const ros::NodeHandle& node, Settings settings) : node_(node), settings_(std::move(settings)) {
  scene_ = node_.advertise<bin_scenes_msgs::Scene>(topic::scene, 1, true);
  markers_ = node_.advertise<visualization_msgs::MarkerArray>(topic::markers, 1, true);
  tf_ = node_.advertise<tf2_msgs::TFMessage>(topic::tf, 100);
  tf_static_ = node_.advertise<tf2_msgs::TFMessage>(topic::tf_static, 1, true);
  sensors_.push_back(std::make_unique<SensorTopics>(*this, 0, "camera"));

  ros::NodeHandle work = node_;
  work.setCallbackQueue(&queue_);
  generate_service_ = work.advertiseService("generate_scene", &SceneServer::generate, this);
  clear_service_ = work.advertiseService("clear_scene", &SceneServer::clear, this);

  // Wall time, so that frames are there even if the simulated clock stands still.
  tf_timer_ = node_.createWallTimer(ros::WallDuration(1.0 / settings_.tf_rate),
                                    [this](const ros::WallTimerEvent&) { send_transforms(); });
  worker_ = std::thread(&SceneServer::work, this);
}

SceneServer::~SceneServer() {
  stop_ = true;
  worker_.join();
  tf_timer_.stop();
}

void SceneServer::work() {
  if (!settings_.request.empty()) {
    bin_scenes_msgs::SceneRequest first;
    first.file = settings_.request;
    GenerateScene::Response ignored;  // make() has logged what there is to say
    make(first, ignored);
  }
  while (!stop_) queue_.callAvailable(ros::WallDuration(0.1));
  queue_.disable();
  // What owns GL objects dies in the thread that made them.
  sensors_.clear();
  camera_.reset();
  generator_.reset();
}

bool SceneServer::generate(GenerateScene::Request& request, GenerateScene::Response& response) {
  make(request.request, response);
  return true;  // false would replace our text by a generic one
}

void SceneServer::make(const bin_scenes_msgs::SceneRequest& message, GenerateScene::Response& response) {
  response.success = false;
  const CancelScope scope(&stop_);
  try {
    Request request = request_from(message, settings_.paths);
    const std::size_t asked = request.scenes;
    request.scenes = 1;
    if (!generator_) generator_ = std::make_unique<Generator>();
    Generator::Options options;
    options.render = false;  // decided in show(), by who listens when the scene is there
    options.hooks.cancel = &stop_;
    options.hooks.progress = [](const Progress& p) {
      ROS_INFO_THROTTLE(2.0, "%s: %zu of %zu parts at rest after %.2f s", p.phase.c_str(), p.resting, p.parts,
                        p.simulated_s);
    };
    generator_->generate(request, options, [&](Generator::Result&& result) {
      Shown shown;
      shown.scene = std::move(result.scene);
      shown.request = request;
      shown.parts = generator_->parts();
      shown.bin_model = generator_->bin_model();
      if (asked > 1) {
        shown.scene.report.flags.push_back(
            {"one_scene_a_call", "the request asks for " + std::to_string(asked) + " scenes; this is the first of them",
             "call again with another index, or use the command line for data sets"});
      }
      show(std::move(shown), message.render);
    });
    const Report& report = shown_->scene.report;
    response.scene = scene_message(shown_->scene, shown_->request, settings_.frames, shown_->stamp);
    response.success = report.accepted;
    response.error_code.value = report.accepted ? Code::NONE : Code::SET_APART;
    response.message = report.accepted ? "" : "the scene was made, but not accepted: " + joined(report.reasons);
  } catch (const Error& error) {
    response.error_code.value = code_of(error.kind());
    response.message = error.what();
  } catch (const std::bad_alloc&) {
    response.error_code.value = Code::ENVIRONMENT;
    response.message = "out of memory (ask for fewer parts or pixels)";
  } catch (const std::exception& error) {
    response.error_code.value = Code::INTERNAL;
    response.message = std::string("a defect of bin_scenes: ") + error.what();
  }
  if (response.success) {
    const Report& report = shown_->scene.report;
    ROS_INFO("scene %zu of seed %lu: %zu parts after %.2f s simulated in %.2f s, by %s on %s", shown_->scene.index,
             shown_->scene.seed, shown_->scene.parts.size(), report.simulated_s, report.wall_s, report.solver.c_str(),
             report.device.c_str());
  } else {
    ROS_ERROR("%s", response.message.c_str());
    malloc_trim(0);  // what a large request took goes back: the next one may come in days
  }
}

bool SceneServer::clear(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = true;
  if (!shown_) {
    response.message = "there was no scene";
    return true;
  }
  // An empty bin is a scene like any other: what listens sees the bin without parts.
  Shown empty;
  empty.scene.seed = shown_->scene.seed;
  empty.scene.index = shown_->scene.index;
  empty.scene.sensors = shown_->scene.sensors;
  empty.scene.report.at_rest = empty.scene.report.accepted = true;
  empty.request = shown_->request;
  empty.request.parts.clear();
  empty.bin_model = shown_->bin_model;
  response.message = std::to_string(shown_->scene.parts.size()) + " parts removed";
  show(std::move(empty), false);
  return true;
}

void SceneServer::show(Shown shown, bool render_anyway) {
  {
    // From here on no frame of the older scene is sent with a stamp later than the new one's.
    const std::lock_guard<std::mutex> lock(transforms_mutex_);
    transforms_.transforms.clear();
    shown.stamp = ros::Time::now();
  }
  shown_ = std::make_unique<Shown>(std::move(shown));
  const std::vector<Sensor>& sensors = shown_->scene.sensors;
  for (std::size_t i = 1; i < std::max(sensors.size(), sensors_.size()); ++i) {
    if (i < sensors_.size() && (i >= sensors.size() || sensors_[i]->name != sensors[i].name)) sensors_[i].reset();
    if (i >= sensors.size()) continue;
    if (i >= sensors_.size()) sensors_.emplace_back();
    if (!sensors_[i]) sensors_[i] = std::make_unique<SensorTopics>(*this, i, sensors[i].name);
  }
  sensors_.resize(std::max<std::size_t>(sensors.size(), 1));

  // Images first, where they are wanted, because the scene tells how much of each part they show.
  bool wanted = render_anyway;
  for (const auto& topics : sensors_) wanted = wanted || topics->wanted();
  if (wanted) render();

  const SceneMessages messages =
      scene_messages(shown_->scene, shown_->request, shown_->parts, shown_->bin_model, settings_.frames, shown_->stamp);
  publish_latched(tf_static_, messages.statics);
  {
    const std::lock_guard<std::mutex> lock(transforms_mutex_);
    transforms_ = messages.parts;
    tf_.publish(transforms_);
  }
  publish_latched(scene_, messages.scene);
  publish_latched(markers_, messages.markers);
  for (const auto& topics : sensors_) topics->renew();
}

bool SceneServer::render() {
  if (!shown_->images.empty() || shown_->scene.sensors.empty()) return false;
  if (!camera_) camera_ = std::make_unique<RangeCamera>();
  Profile& profile = shown_->scene.report.profile;
  const StageTimer timer(profile, "render");
  shown_->images = camera_->render(shown_->scene, shown_->request, shown_->parts, shown_->bin_model);
  profile.count("rendered_images", shown_->images.size());
  for (const RangeImage& image : shown_->images) set_visible_fractions(shown_->scene, image);
  ROS_INFO("rendered %zu images", shown_->images.size());
  return true;
}

void SceneServer::publish_scene() {
  publish_latched(scene_, scene_message(shown_->scene, shown_->request, settings_.frames, shown_->stamp));
}

void SceneServer::send_transforms() {
  const std::lock_guard<std::mutex> lock(transforms_mutex_);
  if (transforms_.transforms.empty()) return;
  const ros::Time now = ros::Time::now();
  // tf2 warns of a repeated stamp, which a clock that stands still would give.
  if (now <= transforms_.transforms.front().header.stamp) return;
  for (auto& transform : transforms_.transforms) transform.header.stamp = now;
  tf_.publish(transforms_);
}

}  // namespace bin_scenes
