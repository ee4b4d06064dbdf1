/// Determines whether the client that waits for the answer of a service call still exists, so that its job can be
/// cancelled otherwise. roscpp does not report this itself.
#pragma once

#include <ros/connection.h>
#include <ros/datatypes.h>

#include <string>

namespace bin_scenes {

class ServiceCaller {
 public:
  /// `header`: ros::ServiceEvent::getConnectionHeader() of the call, the very object; `service`: its resolved name.
  ServiceCaller(const std::string& service, const ros::M_string& header);
  /// Its process has ended, or it has closed the connection. False where this cannot be determined.
  bool gone() const;

 private:
  ros::ConnectionPtr connection_;
};

}  // namespace bin_scenes
