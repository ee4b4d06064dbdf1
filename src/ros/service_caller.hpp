/// Determines whether the client that waits for the answer of a service call still exists, so that its job can be
/// cancelled otherwise. roscpp does not report this itself.
#pragma once

#include <ros/connection.h>
#include <ros/datatypes.h>

#include <string>

namespace bin_scenes {

class ServiceCaller {
 public:
  /// @param header  the object that ros::ServiceEvent::getConnectionHeader() of the call returned, not a copy of it
  ServiceCaller(const std::string& service, const ros::M_string& header);
  /// Returns whether the client has ended or has closed the connection; false if this cannot be determined.
  bool gone() const;

 private:
  ros::ConnectionPtr connection_;
};

}  // namespace bin_scenes
