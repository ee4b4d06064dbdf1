/// The ROS services. Each service starts a job and blocks until the job has ended.
#pragma once

#include "scene_jobs.hpp"
#include "thread_queue.hpp"

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes {

class SceneServices {
 public:
  /// The service `cancel` runs in the queue of `node`. All other services run one call at a time in a separate thread,
  /// so that service calls occupy at most one place in the queue of jobs, however many clients there are.
  SceneServices(const ros::NodeHandle& node, SceneJobs& jobs);
  ~SceneServices();

 private:
  using Submit = std::function<std::shared_ptr<Job>(SceneJobs::Answer)>;

  template <class Service, class Ask>
  void offer(ros::NodeHandle& node, const std::string& name, Ask ask);
  void offer_grasps(ros::NodeHandle& node);
  void offer_trigger(ros::NodeHandle& node, const std::string& name,
                     std::shared_ptr<Job> (SceneJobs::*ask)(SceneJobs::Answer));
  Outcome wait_for(const std::string& service, const ros::M_string& caller, const Submit& submit);

  SceneJobs& jobs_;
  ThreadQueue calls_;
  ros::Publisher grasps_;  ///< markers of the grasps that get_grasps returned last
  std::vector<ros::ServiceServer> services_;
};

}  // namespace bin_scenes
