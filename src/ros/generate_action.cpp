#include "generate_action.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>

namespace bin_scenes {

namespace {

using Code = bin_scenes_msgs::ErrorCode;

constexpr double feedback_rate = 10.0;   ///< Hz
constexpr double least_fraction = 0.02;  ///< of the work, before the rest of it is estimated

bin_scenes_msgs::GenerateSceneResult result_of(const Outcome& outcome) {
  bin_scenes_msgs::GenerateSceneResult result;
  result.success = outcome.success;
  result.error_code.value = outcome.error_code;
  result.message = outcome.message;
  result.scene = outcome.scene;
  return result;
}

bin_scenes_msgs::GenerateSceneFeedback feedback_of(const Job::State& state) {
  bin_scenes_msgs::GenerateSceneFeedback feedback;
  feedback.phase = state.progress.phase;
  feedback.fraction = state.progress.fraction;
  feedback.simulated_s = state.progress.simulated_s;
  feedback.resting = static_cast<std::int32_t>(state.progress.resting);
  feedback.parts = static_cast<std::int32_t>(state.progress.parts);
  const double done = state.progress.fraction;
  feedback.remaining_s = done < least_fraction ? -1.0 : state.running_s * (1.0 - done) / done;
  return feedback;
}

}  // namespace

GenerateAction::GenerateAction(const ros::NodeHandle& node, SceneJobs& jobs, bool preempt)
    : jobs_(jobs),
      preempt_(preempt),
      server_(
          node, "generate", [this](Goal goal) { begin(goal); }, [this](Goal goal) { cancel(goal); }, false) {
  server_.start();
  const auto tick = [this](const ros::WallTimerEvent&) { send_feedback(); };
  timer_ = node.createWallTimer(ros::WallDuration(1.0 / feedback_rate), tick);
}

std::vector<GenerateAction::Open> GenerateAction::open() {
  const auto ended = [](const Open& open) { return open.job->ended(); };
  open_.erase(std::remove_if(open_.begin(), open_.end(), ended), open_.end());
  return open_;
}

void GenerateAction::begin(Goal goal) {
  if (preempt_)
    for (const Open& earlier : open()) earlier.job->cancel("preempted by a newer goal");
  // At once, also if it has to wait: a cancelled goal that was never accepted would end as recalled, not preempted.
  goal.setAccepted();
  const auto answer = [goal](const Outcome& outcome) {
    Goal ended = goal;
    const auto result = result_of(outcome);
    if (outcome.success) {
      ended.setSucceeded(result);
    } else if (outcome.error_code == Code::CANCELLED) {
      ended.setCanceled(result, result.message);
    } else {
      ended.setAborted(result, result.message);
    }
  };
  try {
    const auto job = jobs_.generate(goal.getGoal()->request, answer);
    open_.push_back({goal, job});
  } catch (...) {
    answer(outcome_of_exception());
  }
}

void GenerateAction::cancel(const Goal& goal) {
  for (const Open& open : open())
    if (open.goal == goal) open.job->cancel("cancelled by the client");
}

void GenerateAction::send_feedback() {
  for (Open& open : open()) open.goal.publishFeedback(feedback_of(open.job->state()));
}

}  // namespace bin_scenes
