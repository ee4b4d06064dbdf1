#include "scene_services.hpp"

#include "service_caller.hpp"

#include <ros/advertise_service_options.h>

#include <chrono>
#include <future>

namespace bin_scenes {

namespace {

constexpr std::chrono::milliseconds look_for_caller{50};

template <class Service>
using Event = ros::ServiceEvent<typename Service::Request, typename Service::Response>;

template <class Response>
void answer(const Outcome& outcome, Response& response) {
  response.success = outcome.success;
  response.error_code.value = outcome.error_code;
  response.message = outcome.message;
  response.scene = outcome.scene;
}

void answer(const Outcome& outcome, std_srvs::Trigger::Response& response) {
  response.success = outcome.success;
  response.message = outcome.success ? std::to_string(outcome.scene.parts.size()) + " parts" : outcome.message;
}

/// A service whose callback learns who calls.
template <class Service>
ros::ServiceServer advertise(ros::NodeHandle& node, const std::string& name,
                             const boost::function<bool(Event<Service>&)>& callback) {
  ros::AdvertiseServiceOptions options;
  options.initBySpecType<Event<Service>>(name, callback);
  return node.advertiseService(options);
}

}  // namespace

SceneServices::SceneServices(const ros::NodeHandle& node, SceneJobs& jobs) : jobs_(jobs) {
  ros::NodeHandle blocking = node;
  blocking.setCallbackQueue(calls_.queue());
  offer<bin_scenes_msgs::GenerateScene>(blocking, "generate_scene", [this](const auto& request, const auto& answer) {
    return jobs_.generate(request.request, answer);
  });
  offer<bin_scenes_msgs::PickPart>(
      blocking, "pick_part", [this](const auto& request, const auto& answer) { return jobs_.pick(request, answer); });
  offer<bin_scenes_msgs::AddParts>(
      blocking, "add_parts", [this](const auto& request, const auto& answer) { return jobs_.add(request, answer); });
  offer_grasps(blocking);
  offer_trigger(blocking, "next_scene", &SceneJobs::next);
  offer_trigger(blocking, "clear_scene", &SceneJobs::clear);

  ros::NodeHandle quick = node;
  services_.push_back(advertise<std_srvs::Trigger>(quick, "cancel", [this](Event<std_srvs::Trigger>& event) {
    event.getResponse().message =
        std::to_string(jobs_.cancel_all("cancelled by the service cancel")) + " jobs cancelled";
    event.getResponse().success = true;
    return true;
  }));
}

SceneServices::~SceneServices() {
  jobs_.cancel_all("the node ends");  // a call that waits for its job returns
  calls_.stop();
}

template <class Service, class Ask>
void SceneServices::offer(ros::NodeHandle& node, const std::string& name, Ask ask) {
  const std::string service = node.resolveName(name);
  services_.push_back(advertise<Service>(node, name, [this, service, ask](Event<Service>& event) {
    const auto submit = [&](SceneJobs::Answer give) { return ask(event.getRequest(), give); };
    answer(wait_for(service, event.getConnectionHeader(), submit), event.getResponse());
    return true;  // false would replace our text by a generic one
  }));
}

void SceneServices::offer_grasps(ros::NodeHandle& node) {
  grasps_ = node.advertise<visualization_msgs::MarkerArray>("grasps", 1, true);
  using Service = bin_scenes_msgs::GetGrasps;
  const std::string service = node.resolveName("get_grasps");
  services_.push_back(advertise<Service>(node, "get_grasps", [this, service](Event<Service>& event) {
    const auto answered = std::make_shared<SceneJobs::GraspAnswer>();
    const auto submit = [&](SceneJobs::Answer give) { return jobs_.grasps(event.getRequest(), answered, give); };
    const Outcome outcome = wait_for(service, event.getConnectionHeader(), submit);
    Service::Response& response = event.getResponse();
    if (outcome.success) {
      response = answered->response;
      grasps_.publish(answered->markers);
    }
    response.success = outcome.success;
    response.error_code.value = outcome.error_code;
    response.message = outcome.message;
    return true;
  }));
}

void SceneServices::offer_trigger(ros::NodeHandle& node, const std::string& name,
                                  std::shared_ptr<Job> (SceneJobs::*ask)(SceneJobs::Answer)) {
  offer<std_srvs::Trigger>(node, name, [this, ask](const auto&, const auto& answer) { return (jobs_.*ask)(answer); });
}

Outcome SceneServices::wait_for(const std::string& service, const ros::M_string& header, const Submit& submit) {
  const ServiceCaller caller(service, header);
  const auto ended = std::make_shared<std::promise<Outcome>>();
  auto outcome = ended->get_future();
  try {
    const auto job = submit([ended](const Outcome& outcome) { ended->set_value(outcome); });
    while (outcome.wait_for(look_for_caller) != std::future_status::ready) {
      if (caller.gone()) job->cancel("the client of the call has gone");
    }
    return outcome.get();
  } catch (...) {
    return outcome_of_exception();
  }
}

}  // namespace bin_scenes
