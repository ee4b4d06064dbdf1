#include "scene_server.hpp"

namespace bin_scenes {

namespace {

ros::NodeHandle served_by(ThreadQueue& thread, ros::NodeHandle node) {
  node.setCallbackQueue(thread.queue());
  return node;
}

}  // namespace

SceneServer::SceneServer(const ros::NodeHandle& node, const ros::NodeHandle& params, Host host,
                         const std::string& frame_prefix)
    : settings_(read_settings(params, frame_prefix)),
      node_(served_by(control_, node)),
      publication_(node_, settings_, host == Host::nodelet),
      jobs_(publication_, settings_),
      action_(node_, jobs_, settings_.preempt),
      services_(node_, jobs_),
      params_(served_by(control_, params)),
      live_(params_, jobs_, publication_),
      diagnostics_(node_, params_, jobs_, publication_, settings_) {
  if (settings_.request.empty()) return;
  bin_scenes_msgs::SceneRequest first;
  first.file = settings_.request;
  jobs_.generate(first, [](const Outcome&) {});  // the jobs have logged what there is to say
}

SceneServer::~SceneServer() {
  control_.stop();  // no more goals, cancels and timers
  jobs_.cancel_all("the node ends");
}

}  // namespace bin_scenes
