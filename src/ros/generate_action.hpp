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
  /// @param node  its queue runs all callbacks; nothing else may block this queue, so that a goal is cancelled quickly
  /// @param preempt  whether a new goal cancels earlier ones instead of waiting for them
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
  /// Returns the goals that have not ended.
  std::vector<Open> open();

  SceneJobs& jobs_;
  const bool preempt_;
  std::vector<Open> open_;  ///< goals that may still run; used only in the thread of the queue
  Server server_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
