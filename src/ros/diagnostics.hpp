/// Fills the topic /diagnostics with the state of one bin: device, quality of the last scene, queue and cache. It only
/// reads the state; it starts no work.
#pragma once

#include "publication.hpp"
#include "scene_jobs.hpp"
#include "settings.hpp"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/wall_timer.h>

namespace bin_scenes {

class Diagnostics {
 public:
  /// Publishes the state once a second, in a callback of the queue of `node`.
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& params, const SceneJobs& jobs,
              const Publication& publication, const Settings& settings);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void device(Status& status) const;
  void scene(Status& status) const;
  void queue(Status& status) const;
  void cache(Status& status) const;
  void memory(Status& status) const;
  void sensors(Status& status) const;

  const SceneJobs& jobs_;
  const Publication& publication_;
  const int queue_size_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace bin_scenes
