/// Parameters that may be changed while the node runs, by dynamic_reconfigure (cfg/BinScenes.cfg lists them). A change
/// is passed on to the jobs and to the publication; other parameters are read once at the start (settings.hpp).
#pragma once

#include "publication.hpp"
#include "scene_jobs.hpp"

#include <bin_scenes/BinScenesConfig.h>
#include <dynamic_reconfigure/server.h>

namespace bin_scenes {

class LiveConfig {
 public:
  /// The callbacks of the server run in the queue of `params`.
  LiveConfig(const ros::NodeHandle& params, SceneJobs& jobs, Publication& publication);

 private:
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<BinScenesConfig> server_;
};

}  // namespace bin_scenes
