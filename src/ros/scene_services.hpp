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
  /// `cancel` is served in the queue of `node`, everything else one call at a time in a thread of its own: calls take
  /// one place in the queue of jobs, between the goals, however many clients call.
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
  ros::Publisher grasps_;  ///< markers of what get_grasps returned last
  std::vector<ros::ServiceServer> services_;
};

}  // namespace bin_scenes
