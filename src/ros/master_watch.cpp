#include "master_watch.hpp"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/service_publication.h>
#include <ros/this_node.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpc.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

namespace {

using XmlRpc::XmlRpcValue;

/// A call of the master's interface: what it returns, and whether it refused.
struct Answer {
  bool accepted = false, refused = false;
  XmlRpcValue value;
};

Answer ask(const char* method, const std::vector<std::string>& arguments) {
  XmlRpcValue request, response;
  request[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i) request[static_cast<int>(i) + 1] = arguments[i];
  Answer answer;
  answer.accepted = ros::master::execute(method, request, response, answer.value, false);
  answer.refused = !answer.accepted && response.valid();  // and not out of reach
  return answer;
}

/// Informs this process who publishes a topic, as a master does: by the interface that each node has for masters.
void notify_publishers(const std::string& topic, const XmlRpcValue& uris) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(ros::XMLRPCManager::instance()->getServerURI(), host, port)) return;
  XmlRpcValue request, response;
  request[0] = "/master";
  request[1] = topic;
  request[2] = uris;
  XmlRpc::XmlRpcClient(host.c_str(), static_cast<int>(port), "/").execute("publisherUpdate", request, response);
}

/// Of the services that the master knows, those of this process; roscpp has no list of them.
std::vector<std::string> services_here() {
  std::vector<std::string> names;
  Answer state = ask("getSystemState", {});
  if (!state.accepted) return names;
  XmlRpcValue& services = state.value[2];
  for (int i = 0; i < services.size(); ++i) {
    const std::string name = services[i][0];
    if (ros::ServiceManager::instance()->lookupServicePublication(name)) names.push_back(name);
  }
  return names;
}

void register_everything(const std::vector<std::string>& services) {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  ros::TopicManager& topics = *ros::TopicManager::instance();
  std::vector<std::string> names;
  topics.getAdvertisedTopics(names);
  for (const std::string& name : names)
    if (const auto publication = topics.lookupPublication(name))
      ask("registerPublisher", {name, publication->getDataType(), uri});

  topics.getSubscribedTopics(names);
  for (const std::string& name : names)
    if (Answer answer = ask("registerSubscriber", {name, "*", uri}); answer.accepted)
      notify_publishers(name, answer.value);

  const std::string address =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  for (const std::string& name : services)
    if (ros::ServiceManager::instance()->lookupServicePublication(name)) ask("registerService", {name, address, uri});
}

}  // namespace

MasterWatch::MasterWatch() {
  ros::NodeHandle node;
  node.setCallbackQueue(thread_.queue());
  timer_ = node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { ask_master(); });
}

MasterWatch::~MasterWatch() {
  timer_.stop();
  thread_.stop();
}

void MasterWatch::ask_master() {
  if (!ros::ok()) return;
  const Answer known = ask("lookupNode", {ros::this_node::getName()});
  if (known.refused) {
    ROS_WARN("the master does not know this node any more, as after a restart: registering everything anew");
    register_everything(services_);
  } else if (known.accepted && asked_++ % 10 == 0) {  // the answer is long where there are many nodes
    if (std::vector<std::string> services = services_here(); !services.empty()) services_ = std::move(services);
  }
}

}  // namespace bin_scenes
