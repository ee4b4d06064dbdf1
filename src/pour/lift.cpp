/// Parts that a gripper takes out, dragging others along.
#include "pour/heap_core.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace bin_scenes {

namespace {

constexpr double lift_speed = 0.1;  ///< m/s

}  // namespace

/// All that touch the lifted bodies, what those press along the direction, and what that presses in turn: between two
/// that sleep, a body that is woken could not move, and the lifted one would go through it.
std::vector<bool> HeapCore::dragged_by(const std::vector<std::size_t>& lifted, const Vec3& direction) const {
  std::vector<std::pair<std::size_t, std::size_t>> presses;  // who, and on whom
  for (const ContactForce& f : forces()) {
    if (f.b < 0) continue;
    const auto a = static_cast<std::size_t>(f.a), b = static_cast<std::size_t>(f.b);
    presses.push_back(f.force.dot(direction) > 0.0 ? std::pair(a, b) : std::pair(b, a));
  }
  BIN_SCENES_ASSERT(
      each_is(presses, [this](const auto& p) { return p.first < states_.size() && p.second < states_.size(); }));
  std::vector<bool> dragged(states_.size(), false);
  for (const std::size_t body : lifted) dragged[body] = true;
  const std::vector<bool> is_lifted = dragged;
  for (bool more = true; more;) {
    more = false;
    for (const auto& [from, to] : presses)
      if (dragged[from] && !dragged[to]) more = dragged[to] = true;
  }
  for (const auto& [from, to] : presses)
    if (is_lifted[to]) dragged[from] = true;
  return dragged;
}

void HeapCore::wake(const std::vector<bool>& bodies) {
  const std::vector<bool> asleep = solver_.asleep(id_);
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (bodies[b] && asleep[b] && moves(b)) solver_.insert(id_, b, states_[b]);
}

/// What sleeps goes on sleeping, but for those to be woken.
void HeapCore::remake_world(const std::vector<std::size_t>& lifted, const std::vector<bool>& woken) {
  std::vector<bool> awake = solver_.asleep(id_), kept(states_.size());
  awake.flip();
  for (std::size_t b = 0; b < states_.size(); ++b) {
    awake[b] = awake[b] || woken[b];
    kept[b] = place_[b] == Place::in && !(moves(b) ? awake[b] : follows());
  }
  const std::vector<ContactForce> pressed = forces();
  earlier_steps_ += solver_.steps(id_);
  leave_world();  // first: both at once would hold twice the memory
  make_world(walls_raised_, lifted);
  set_solver_phase();
  wake(awake);
  kept_ = kept;
  std::copy_if(pressed.begin(), pressed.end(), std::back_inserter(kept_forces_),
               [this](const ContactForce& f) { return is_kept(f); });
}

void HeapCore::release_kept() {
  if (kept_.empty()) return;
  const std::vector<bool> asleep = solver_.asleep(id_);
  for (std::size_t b = 0; b < kept_.size(); ++b) kept_[b] = kept_[b] && (asleep[b] || !moves(b));
}

bool HeapCore::is_kept(const ContactForce& f) const {
  return is_kept(static_cast<std::size_t>(f.a)) && (f.b < 0 || is_kept(static_cast<std::size_t>(f.b)));
}

std::vector<ContactForce> HeapCore::forces() const {
  std::vector<ContactForce> all = solver_.contact_forces(id_);
  std::copy_if(kept_forces_.begin(), kept_forces_.end(), std::back_inserter(all),
               [this](const ContactForce& f) { return is_kept(f); });
  return all;
}

void HeapCore::wake_kept_beside(std::size_t body) {
  if (!is_kept(body)) return;
  std::vector<bool> beside(states_.size(), false);
  for (const ContactForce& f : kept_forces_) {
    if (f.b < 0 || !is_kept(f)) continue;
    const auto a = static_cast<std::size_t>(f.a), b = static_cast<std::size_t>(f.b);
    if (a == body) beside[b] = true;
    if (b == body) beside[a] = true;
  }
  wake(beside);
  kept_[body] = false;
}

void HeapCore::let_go() {
  if (!lifts_) return;
  states();
  remake_world({}, std::vector<bool>(states_.size(), false));
}

void HeapCore::lift(const std::vector<std::size_t>& bodies, const Vec3& direction, double distance,
                    const RunHooks& hooks) {
  BIN_SCENES_ASSERT(is_unit(direction) && distance >= 0.0);
  BIN_SCENES_ASSERT(each_is(bodies, [this](std::size_t b) { return b < states_.size() && moves(b); }));
  states();
  if (settling_.done()) begin(Stage::repair);
  start_clock();
  std::vector<Pose> poses;
  for (const std::size_t b : bodies) poses.push_back(states_[b].pose);
  const double slice = solver_.step_size();
  // Gravity changes the velocity within the step; its mean is that of the lift.
  const BodyState moved{Pose(), {lift_speed * direction - 0.5 * slice * plan_->world.gravity, Vec3::Zero()}};
  const int pieces = static_cast<int>(std::ceil(distance / (lift_speed * slice)));
  if (pieces > 0) remake_world(bodies, dragged_by(bodies, direction));
  for (int piece = 1; piece <= pieces; ++piece) {
    stop_if_cancelled();
    // Put on its path again in every step, so that it carries parts instead of falling with them.
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (place_[bodies[i]] != Place::in) continue;  // it lay outside of the bin
      BodyState state = moved;
      state.pose = poses[i];
      state.pose.position += direction * (distance * (piece - 1) / pieces);
      solver_.insert(id_, bodies[i], state);
    }
    ask(slice, true);
    advanced(solver_.advance({id_}, slice));
    update_rest(true);
    wake(dragged_by(bodies, direction));
    if (hooks.progress) {
      Progress now = progress();
      now.phase = "lift";
      now.fraction = 0.0;
      hooks.progress(now);
    }
  }
}

}  // namespace bin_scenes
