/// The operations that clients can request for one bin, as jobs of its queue. Action and services call these functions
/// and contain no logic of their own.
#pragma once

#include "ahead.hpp"
#include "job_queue.hpp"
#include "publication.hpp"
#include "scene_maker.hpp"
#include "settings.hpp"

#include <visualization_msgs/MarkerArray.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace bin_scenes {

/// Settings that can be changed while the node runs (dynamic_reconfigure), in addition to the rates. An empty text
/// leaves the value of the request unchanged.
struct LiveSettings {
  std::string finish;  ///< replaces pour.finish
  std::string solver;  ///< replaces solver.type
  bool noise = true;   ///< false: no random effects in images of sensors
};
/// Return the possible values of `finish` and `solver`. The first one, "request", keeps the value of the request.
const std::vector<std::string>& live_finishes();
const std::vector<std::string>& live_solvers();

class SceneJobs {
 public:
  SceneJobs(Publication& publication, const Settings& settings);
  /// Cancels all jobs.
  ~SceneJobs();

  // Each function adds a job to the queue and returns it. `answer` is called once, when the job ends; an error of the
  // request becomes the outcome of the job. They throw an environment Error if the queue is full.
  using Answer = Job::Answer;
  std::shared_ptr<Job> generate(const bin_scenes_msgs::SceneRequest& request, Answer answer);
  std::shared_ptr<Job> pick(const bin_scenes_msgs::PickPart::Request& request, Answer answer);
  std::shared_ptr<Job> add(const bin_scenes_msgs::AddParts::Request& request, Answer answer);
  /// Result of grasps(), which does not change the scene. It is complete before `answer` is called with a success.
  struct GraspAnswer {
    bin_scenes_msgs::GetGrasps::Response response;
    visualization_msgs::MarkerArray markers;
  };
  std::shared_ptr<Job> grasps(const bin_scenes_msgs::GetGrasps::Request& request, std::shared_ptr<GraspAnswer> answered,
                              Answer answer);
  std::shared_ptr<Job> next(Answer answer);
  std::shared_ptr<Job> clear(Answer answer);

  std::size_t cancel_all(const std::string& reason) { return queue_.cancel_all(reason); }
  void set(const LiveSettings& live);

  /// The state of the jobs, for the topic /diagnostics.
  struct Status {
    std::size_t jobs = 0;                                            ///< number of jobs that wait or run
    std::string running;                                             ///< name of the running job; empty: none
    double running_s = 0.0;                                          ///< time since it began (s)
    std::size_t made = 0, failed = 0, cancelled = 0, set_apart = 0;  ///< number of jobs by outcome, since the start
    std::size_t set_apart_in_a_row = 0;   ///< number of scenes that were set apart since the last accepted one
    std::size_t ahead = 0;                ///< number of finished scenes for next_scene
    std::string device, solver, verdict;  ///< of the last scene: device, solver, and whether it was accepted
    bool accepted = true;
  };
  Status status() const;

 private:
  using Make = std::function<MadeScene(const RunHooks&)>;

  std::shared_ptr<Job> submit(const std::string& name, Make make, Answer answer, bool render = false);
  Outcome run(Job& job, const Make& make, bool render);
  Outcome show(MadeScene made);
  Request request_of(const bin_scenes_msgs::SceneRequest& message) const;
  Lift lift_by_grasp(const bin_scenes_msgs::PickPart::Request& request, const RunHooks& hooks) const;
  void note(const std::string& name, const Outcome& outcome);

  Publication& publication_;
  const Settings settings_;
  mutable std::mutex mutex_;  ///< protects live_ and status_
  LiveSettings live_;
  Status status_;
  std::unique_ptr<SceneMaker> maker_;  ///< only the thread of the jobs uses it
  std::unique_ptr<Ahead> ahead_;
  JobQueue queue_;  ///< must be the last member, because its thread uses the others
};

}  // namespace bin_scenes
