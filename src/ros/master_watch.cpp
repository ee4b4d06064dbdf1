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

#include <string>
#include <vector>

namespace bin_scenes {

namespace {

using XmlRpc::XmlRpcValue;
using Services = std::list<ros::ServicePublicationPtr>;

// roscpp has no list of its services, and keeps to itself how it learns of publishers. An explicit instantiation may
// name private members ([temp.spec.general]); its friends then reach them.
using Update = bool (ros::TopicManager::*)(const std::string&, const std::vector<std::string>&);
Services& services_of(ros::ServiceManager& manager);
boost::mutex& services_mutex_of(ros::ServiceManager& manager);
void update_publishers(ros::TopicManager& manager, const std::string& topic, const std::vector<std::string>& uris);

template <Services ros::ServiceManager::*services, boost::mutex ros::ServiceManager::*mutex, Update update>
struct Unlocked {
  friend Services& services_of(ros::ServiceManager& manager) { return manager.*services; }
  friend boost::mutex& services_mutex_of(ros::ServiceManager& manager) { return manager.*mutex; }
  friend void update_publishers(ros::TopicManager& manager, const std::string& topic,
                                const std::vector<std::string>& uris) {
    (manager.*update)(topic, uris);
  }
};
template struct Unlocked<&ros::ServiceManager::service_publications_, &ros::ServiceManager::service_publications_mutex_,
                         &ros::TopicManager::pubUpdate>;

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

void register_everything() {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  ros::TopicManager& topics = *ros::TopicManager::instance();
  std::vector<std::string> names;
  topics.getAdvertisedTopics(names);
  for (const std::string& name : names)
    if (const auto publication = topics.lookupPublication(name))
      ask("registerPublisher", {name, publication->getDataType(), uri});

  topics.getSubscribedTopics(names);
  for (const std::string& name : names) {
    Answer answer = ask("registerSubscriber", {name, "*", uri});
    if (!answer.accepted) continue;
    std::vector<std::string> publishers;
    for (int i = 0; i < answer.value.size(); ++i) publishers.push_back(answer.value[i]);
    update_publishers(topics, name, publishers);
  }

  ros::ServiceManager& services = *ros::ServiceManager::instance();
  const std::string address =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  names.clear();
  {
    const boost::mutex::scoped_lock lock(services_mutex_of(services));
    for (const ros::ServicePublicationPtr& service : services_of(services)) names.push_back(service->getName());
  }
  for (const std::string& name : names) ask("registerService", {name, address, uri});
}

void look() {
  if (!ros::ok() || !ask("lookupNode", {ros::this_node::getName()}).refused) return;
  ROS_WARN("the master does not know this node any more, as after a restart: registering everything anew");
  register_everything();
}

}  // namespace

MasterWatch::MasterWatch() {
  ros::NodeHandle node;
  node.setCallbackQueue(thread_.queue());
  timer_ = node.createWallTimer(ros::WallDuration(1.0), [](const ros::WallTimerEvent&) { look(); });
}

MasterWatch::~MasterWatch() {
  timer_.stop();
  thread_.stop();
}

}  // namespace bin_scenes
