/// Bins that turn, and bins and fixed parts that follow a given motion while the heap is simulated.
#include "pour/heap_core.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

/// Turn from one orientation to another (rad, in the axes in which both are given).
Vec3 turn_between(const Quat& from, const Quat& to) {
  const Eigen::AngleAxisd turn((to * from.conjugate()).normalized());  // by half a turn at most
  return turn.angle() * turn.axis();
}

/// Of the frame's origin, and its spin, in the axes that the bin had at the beginning.
Twist velocity_at(const Motion& motion, double t) {
  constexpr double moment = 1e-5;  ///< s; a difference of poses over it errs by rounding alone
  const Pose before = motion.at(t - moment), after = motion.at(t + moment);
  return {(after.position - before.position) / (2.0 * moment),
          turn_between(before.orientation, after.orientation) / (2.0 * moment)};
}

/// What a bin's motion is to those in it over the step of `dt` seconds from t on: changes are those of the whole step,
/// so that the steps add up to the path; the rest is as in its centre.
Frame frame_at(const Motion& motion, const Vec3& gravity, double t, double dt) {
  BIN_SCENES_ASSERT(dt > 0.0);
  const Twist begin = velocity_at(motion, t), end = velocity_at(motion, t + dt);
  const Quat into_bin = motion.at(t + 0.5 * dt).orientation.conjugate();
  Frame frame;
  frame.gravity = into_bin * Vec3(gravity - (end.linear - begin.linear) / dt);
  frame.spin = into_bin * velocity_at(motion, t + 0.5 * dt).angular;
  frame.spin_rate = into_bin * Vec3((end.angular - begin.angular) / dt);
  return frame;
}

/// Where a part that began at `start` is at t, and how fast its centre of mass and it turn until t + dt.
BodyState state_at(const Motion& motion, const Pose& start, const Vec3& center, double t, double dt) {
  const auto pose_at = [&](double time) {
    const Pose displacement = motion.at(time);
    return Pose{start.position + displacement.position, (displacement.orientation * start.orientation).normalized()};
  };
  const Pose now = pose_at(t), after = pose_at(t + dt);
  BIN_SCENES_ASSERT(dt > 0.0 && is_rigid(now) && is_rigid(after));
  BodyState state;
  state.pose = now;
  state.velocity.linear = (after * center - now * center) / dt;
  state.velocity.angular = turn_between(now.orientation, after.orientation) / dt;
  if (t < motion.seconds) state.velocity.linear += motion.belt;
  return state;
}

}  // namespace

void HeapCore::set_gravity(const Vec3& gravity) {
  states();
  auto plan = std::make_shared<PourPlan>(*plan_);
  plan->request.gravity = plan->world.gravity = gravity;
  audit_.reset();
  plan_ = std::move(plan);
  solver_.remove_world(id_);
  make_world(!waiting_.empty());
  begin(waiting_.empty() ? Stage::hold : Stage::pour);
}

double HeapCore::motion_seconds() const {
  const Request& request = plan_->request;
  double seconds = moving_from_ == 0 ? request.bin.motion.duration() : 0.0;
  for (std::size_t l = moving_from_; l < request.parts.size(); ++l)
    seconds = std::max(seconds, request.parts[l].motion.duration());
  return seconds;
}

void HeapCore::put_on_path(double t, double dt, bool ends) {
  const Request& request = plan_->request;
  const Motion of_bin = moving_from_ == 0 ? request.bin.motion : Motion();
  solver_.set_frame(id_, frame_at(of_bin, plan_->world.gravity, t, dt));
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const PartLine& line = request.parts[plan_->line_of[b]];
    if (!line.motion.any() || plan_->line_of[b] < moving_from_ || place_[b] != Place::in) continue;
    states_[b] = state_at(line.motion, line.poses[plan_->copy_of[b]], part(b).mass().center, t, dt);
    if (ends) states_[b].velocity = {};
    solver_.insert(id_, b, states_[b]);
  }
}

void HeapCore::begin_motion() {
  if (course_ != Course::ahead) return;
  BIN_SCENES_ASSERT(motion_seconds() >= 0.0);
  course_ = motion_seconds() > 0.0 ? Course::moving : Course::over;
  course_begun_ = time_;
}

void HeapCore::follow(double seconds) {
  put_on_path(time_ - course_begun_, seconds, false);
}

bool HeapCore::end_motion() {
  if (time_ - course_begun_ < motion_seconds()) return false;
  course_ = Course::over;
  put_on_path(motion_seconds() + solver_.step_size(), solver_.step_size(), true);
  settling_.start(Stage::settle);
  set_solver_phase();
  restart_rest();
  return true;
}

}  // namespace bin_scenes
