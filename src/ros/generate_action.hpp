/// The action `generate`: it turns goals into jobs of the queue, and progress into feedback. The queue (scene_jobs.hpp)
/// does the work in a thread of its own.
#pragma once

#include "scene_jobs.hpp"

#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

class GenerateAction {
 public:
  /// All callbacks run in the queue of `node`, which nothing else may block: that is what makes a cancel quick.
  /// `preempt`: a new goal cancels the earlier ones instead of waiting for them.
  GenerateAction(const ros::NodeHandle& node, SceneJobs& jobs, bool preempt);

 private:
  using Server = actionlib::ActionServer<bin_scenes_msgs::GenerateSceneAction>;
  using Goal = Server::GoalHandle;
  struct Open {
    Goal goal;
    std::shared_ptr<Job> job;
  };

  void begin(Goal goal);
  void cancel(const Goal& goal);
  void send_feedback();
  /// Goals that have not ended.
  std::vector<Open> open();

  SceneJobs& jobs_;
  const bool preempt_;
  std::vector<Open> open_;  ///< of the queue's thread, like all else here
  Server server_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
