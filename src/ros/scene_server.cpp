#include "scene_server.hpp"

#include "diagnostics.hpp"
#include "generate_action.hpp"
#include "live_config.hpp"
#include "publication.hpp"
#include "scene_jobs.hpp"
#include "scene_services.hpp"
#include "settings.hpp"
#include "thread_queue.hpp"

namespace bin_scenes {

namespace {

ros::NodeHandle served_by(ThreadQueue& thread, ros::NodeHandle node) {
  node.setCallbackQueue(thread.queue());
  return node;
}

}  // namespace

struct SceneServer::Parts {
  Parts(const ros::NodeHandle& node, const ros::NodeHandle& params, Host host, const std::string& frame_prefix)
      : settings(read_settings(params, frame_prefix)),
        node(served_by(control, node)),
        publication(this->node, settings, host == Host::nodelet),
        jobs(publication, settings),
        action(this->node, jobs, settings.preempt),
        services(this->node, jobs),
        params(served_by(control, params)),
        live(this->params, jobs, publication),
        diagnostics(this->node, this->params, jobs, publication, settings) {}

  const Settings settings;
  ThreadQueue control;
  ros::NodeHandle node;  ///< its callbacks run in `control`
  Publication publication;
  SceneJobs jobs;
  GenerateAction action;
  SceneServices services;
  ros::NodeHandle params;
  LiveConfig live;
  Diagnostics diagnostics;
};

SceneServer::SceneServer(const ros::NodeHandle& node, const ros::NodeHandle& params, Host host,
                         const std::string& frame_prefix)
    : parts_(std::make_unique<Parts>(node, params, host, frame_prefix)) {
  if (parts_->settings.request.empty()) return;
  bin_scenes_msgs::SceneRequest first;
  first.file = parts_->settings.request;
  parts_->jobs.generate(first, [](const Outcome&) {});  // the jobs have logged what there is to say
}

SceneServer::~SceneServer() {
  parts_->control.stop();  // no more goals, cancels and timers
  parts_->jobs.cancel_all("the node ends");
}

}  // namespace bin_scenes
