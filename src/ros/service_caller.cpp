#include "service_caller.hpp"

#include <ros/service_client_link.h>
#include <ros/service_manager.h>
#include <ros/service_publication.h>

#include <vector>

namespace bin_scenes {

namespace {

using Links = std::vector<ros::ServiceClientLinkPtr>;

// roscpp keeps the connections of a service to itself, and a callback gets no more of them than the header. An explicit
// instantiation may name private members ([temp.spec.general]); its friends then reach them.
Links& links_of(ros::ServicePublication& service);
boost::mutex& mutex_of(ros::ServicePublication& service);

template <Links ros::ServicePublication::*links, boost::mutex ros::ServicePublication::*mutex>
struct Opened {
  friend Links& links_of(ros::ServicePublication& service) { return service.*links; }
  friend boost::mutex& mutex_of(ros::ServicePublication& service) { return service.*mutex; }
};
template struct Opened<&ros::ServicePublication::client_links_, &ros::ServicePublication::client_links_mutex_>;

}  // namespace

ServiceCaller::ServiceCaller(const std::string& service, const ros::M_string& header) {
  const ros::ServicePublicationPtr publication = ros::ServiceManager::instance()->lookupServicePublication(service);
  if (!publication) return;
  const boost::mutex::scoped_lock lock(mutex_of(*publication));
  for (const ros::ServiceClientLinkPtr& link : links_of(*publication)) {
    if (link->getConnection()->getHeader().getValues().get() == &header) connection_ = link->getConnection();
  }
}

bool ServiceCaller::gone() const {
  return connection_ && connection_->isDropped();
}

}  // namespace bin_scenes
