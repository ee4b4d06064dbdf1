/// Each door of the node as a job: what it makes, how it is shown, and what is answered. Parameters that may change
/// while the node runs go through here too.
#include "scene_jobs.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "grasp_message.hpp"
#include "request_message.hpp"

#include <malloc.h>
#include <ros/console.h>

#include <utility>

namespace bin_scenes {

namespace {

using Code = bin_scenes_msgs::ErrorCode;

Lift lift_of(const bin_scenes_msgs::PickPart::Request& request) {
  const auto& p = request.grasp.position;
  const auto& q = request.grasp.orientation;
  for (const double number : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) {
    if (number != 0.0)
      throw input_error("there is a grasp, but no gripper", "pick_part",
                        "name the gripper that get_grasps returns with the grasp, or leave the grasp out");
  }
  Lift lift;
  const auto& d = request.lift_direction;
  if (d.x != 0.0 || d.y != 0.0 || d.z != 0.0) lift.direction = Vec3(d.x, d.y, d.z);
  lift.distance = request.lift_distance;
  return lift;
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

}  // namespace

const std::vector<std::string>& live_finishes() {
  using Finish = Pour::Finish;
  static const std::vector<std::string> all = {"request", name_of(Finish::settled), name_of(Finish::pressed),
                                               name_of(Finish::probed)};
  return all;
}

const std::vector<std::string>& live_solvers() {
  static const std::vector<std::string> all = {"request", name_of(SolverType::automatic), name_of(SolverType::sphere),
                                               name_of(SolverType::bullet)};
  return all;
}

SceneJobs::SceneJobs(Publication& publication, const Settings& settings)
    : publication_(publication),
      settings_(settings),
      maker_(std::make_unique<SceneMaker>()),
      ahead_(settings.scenes_ahead > 0 ? std::make_unique<Ahead>(settings.scenes_ahead, publication) : nullptr),
      queue_(static_cast<std::size_t>(settings.queue_size), [this] { maker_.reset(); }) {}

SceneJobs::~SceneJobs() = default;

std::shared_ptr<Job> SceneJobs::generate(const bin_scenes_msgs::SceneRequest& message, Answer answer) {
  const auto make = [this, message](const RunHooks& hooks) {
    Request request = request_of(message);
    const std::size_t asked = std::exchange(request.scenes, 1);
    MadeScene made = maker_->pour(request, hooks);
    if (asked > 1) {
      made.scene.report.flags.push_back(
          {"one_scene_a_call", "the request asks for " + std::to_string(asked) + " scenes; this is the first of them",
           "call again with another index, or use the command line for data sets"});
    }
    return made;
  };
  return submit("generate", make, std::move(answer), message.render);
}

std::shared_ptr<Job> SceneJobs::pick(const bin_scenes_msgs::PickPart::Request& request, Answer answer) {
  const auto make = [this, request](const RunHooks& hooks) {
    const std::vector<int> ids(request.ids.begin(), request.ids.end());
    const Lift lift = request.gripper.empty() ? lift_of(request) : lift_by_grasp(request, hooks);
    return ids.empty() ? maker_->settle(hooks) : maker_->pick(ids, lift, hooks);
  };
  return submit("pick_part", make, std::move(answer));
}

/// That of a grasp, if it is one of the part and free.
Lift SceneJobs::lift_by_grasp(const bin_scenes_msgs::PickPart::Request& request, const RunHooks& hooks) const {
  const MadeScene made = maker_->heap_as_it_lies("pick_part");
  const PartPick pick = picked_by(maker_->grasps(made, {}, hooks), made.loaded.request, request);
  return {pick.lift, request.lift_distance != 0.0 ? request.lift_distance : pick.lift.norm()};
}

std::shared_ptr<Job> SceneJobs::add(const bin_scenes_msgs::AddParts::Request& request, Answer answer) {
  const auto make = [this, request](const RunHooks& hooks) {
    return maker_->add(part_lines_from(request.parts, settings_.paths), hooks);
  };
  return submit("add_parts", make, std::move(answer));
}

std::shared_ptr<Job> SceneJobs::grasps(const bin_scenes_msgs::GetGrasps::Request& request,
                                       std::shared_ptr<GraspAnswer> answered, Answer answer) {
  const auto work = [this, request, answered](Job& job) {
    MadeScene made = maker_->heap_as_it_lies("get_grasps");
    if (request.render) publication_.render(made, true, job.hooks());
    SceneGrasps grasps = maker_->grasps(made, request.render ? made.images : std::vector<RangeImage>(), job.hooks());
    grasps.grasps = chosen_grasps(grasps, request);
    if (request.prove > 0)
      maker_->prove(grasps, made, static_cast<std::size_t>(request.prove), request.all, job.hooks());
    job.commit();
    const ros::Time stamp = publication_.stamp();  // of now: it changes with publish_rate and the clock
    fill(answered->response, grasps.grasps, grasps, made.loaded.request, settings_.frames, stamp);
    for (const Gripper& gripper : made.loaded.request.grippers)
      answered->response.gripper_descriptions.push_back(gripper_text(gripper));
    if (request.render) fill_shares(answered->response, grasps.grasps, made.scene.sensors);
    answered->markers = grasp_markers(grasps.grasps, made.loaded.request, settings_.frames, stamp);
    Outcome outcome;
    outcome.success = true;
    return outcome;
  };
  const auto job = std::make_shared<Job>("get_grasps", work, std::move(answer));
  queue_.add(job);
  return job;
}

std::shared_ptr<Job> SceneJobs::next(Answer answer) {
  const auto make = [this](const RunHooks& hooks) -> MadeScene {
    if (!maker_->has_scene()) {
      throw input_error("there is no scene, so that nobody knows what comes next", "next_scene",
                        "make one first: generate, generate_scene, ~request");
    }
    if (ahead_) return ahead_->take(hooks);
    Request request = maker_->asked();
    ++request.first;
    return maker_->pour(request, hooks);
  };
  return submit("next_scene", make, std::move(answer));
}

std::shared_ptr<Job> SceneJobs::clear(Answer answer) {
  const auto make = [this](const RunHooks&) {
    if (!maker_->has_scene()) throw input_error("there was no scene", "clear_scene", "nothing is left to do");
    return maker_->emptied();
  };
  return submit("clear_scene", make, std::move(answer));
}

void SceneJobs::set(const LiveSettings& live) {
  const std::lock_guard<std::mutex> lock(mutex_);
  live_ = live;
}

SceneJobs::Status SceneJobs::status() const {
  Status status;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status = status_;
  }
  status.jobs = queue_.size();
  if (const auto job = queue_.running()) {
    status.running = job->name();
    status.running_s = job->state().running_s;
  }
  if (ahead_) status.ahead = ahead_->ready();
  return status;
}

std::shared_ptr<Job> SceneJobs::submit(const std::string& name, Make make, Answer answer, bool render) {
  const auto work = [this, make = std::move(make), render](Job& job) { return run(job, make, render); };
  const auto noted = [this, name, answer = std::move(answer)](const Outcome& outcome) {
    note(name, outcome);
    answer(outcome);
  };
  const auto job = std::make_shared<Job>(name, work, noted);
  queue_.add(job);
  return job;
}

Outcome SceneJobs::run(Job& job, const Make& make, bool render) {
  try {
    MadeScene made = make(job.hooks());
    publication_.render(made, render, job.hooks());
    job.commit();
    return show(std::move(made));
  } catch (...) {
    malloc_trim(0);  // what a large request took goes back: the next one may come in days
    throw;
  }
}

Outcome SceneJobs::show(MadeScene made) {
  MadeScene kept;  // what the maker has to know, while the topics take the rest
  kept.heap = made.heap;
  kept.loaded = {made.loaded.request, {}, made.loaded.bin_model};
  kept.asked = made.asked;
  kept.scene.seed = made.scene.seed;
  kept.scene.index = made.scene.index;
  kept.scene.sensors = made.scene.sensors;
  const Report report = made.scene.report;
  const std::size_t parts = made.scene.parts.size();
  made.heap.reset();

  Outcome outcome;
  outcome.scene = publication_.show(std::move(made));
  maker_->keep(kept);
  if (ahead_) ahead_->follow(kept.asked, kept.scene.index);
  outcome.success = report.accepted;
  if (!report.accepted) {
    outcome.error_code = Code::SET_APART;
    outcome.message = "the scene was made, but not accepted: " + joined(report.reasons);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!report.solver.empty()) {
    status_.device = report.device;
    status_.solver = report.solver;
    ROS_INFO("scene %zu of seed %lu: %zu parts after %.2f s simulated in %.2f s, by %s on %s", kept.scene.index,
             kept.scene.seed, parts, report.simulated_s, report.wall_s, report.solver.c_str(), report.device.c_str());
  }
  return outcome;
}

void SceneJobs::note(const std::string& name, const Outcome& outcome) {
  const bool apart = outcome.error_code == Code::SET_APART, cancelled = outcome.error_code == Code::CANCELLED;
  if (cancelled) ROS_INFO("%s: %s", name.c_str(), outcome.message.c_str());
  if (!cancelled && !outcome.success) ROS_ERROR("%s: %s", name.c_str(), outcome.message.c_str());
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!outcome.success && !apart) {
    ++(cancelled ? status_.cancelled : status_.failed);
    return;
  }
  ++(apart ? status_.set_apart : status_.made);
  status_.accepted = outcome.success;
  status_.verdict = outcome.success ? "accepted" : outcome.message;
  status_.set_apart_in_a_row = apart ? status_.set_apart_in_a_row + 1 : 0;
}

Request SceneJobs::request_of(const bin_scenes_msgs::SceneRequest& message) const {
  LiveSettings live;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    live = live_;
  }
  bin_scenes_msgs::SceneRequest full = message;
  // Before the caller's own entries, which override them.
  std::vector<std::string> set;
  if (!live.finish.empty()) set.push_back("pour.finish=" + live.finish);
  if (!live.solver.empty() && message.solver.empty()) set.push_back("solver.type=" + live.solver);
  full.set.insert(full.set.begin(), set.begin(), set.end());
  Request request = request_from(full, settings_.paths);
  if (!live.noise) {
    for (Sensor& sensor : request.sensors) sensor.noise = false;
    request.text_sha256 = request_hash(request);
  }
  return request;
}

}  // namespace bin_scenes
