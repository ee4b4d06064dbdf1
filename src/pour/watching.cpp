/// Observation of a heap: who rests, who has left the bin, what energy was gained. Where the solver's states are in
/// memory, they are observed here; a device that simulates many worlds observes them itself (DeviceWatch), and its
/// states are read only where the heap changes.
#include "pour/heap_core.hpp"

#include "solver/step_limit.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

bool HeapCore::outside(const Vec3& center) const {
  switch (plan_->world.bin.kind) {
    case Bin::Kind::none:
      return false;
    case Bin::Kind::floor:
      return center.z() < 0.0;
    case Bin::Kind::box: {
      const Vec3 half = 0.5 * plan_->world.bin.inner_size;
      return std::abs(center.x()) > half.x() || std::abs(center.y()) > half.y() || center.z() < 0.0;
    }
    case Bin::Kind::mesh: {
      const Aabb& box = plan_->bin_bounds;
      return center.x() < box.lower.x() || center.x() > box.upper.x() || center.y() < box.lower.y() ||
             center.y() > box.upper.y() || center.z() < box.lower.z();
    }
  }
  return false;
}

WatchRules HeapCore::rules() const {
  constexpr double far = std::numeric_limits<double>::infinity();
  const Pour& pour = plan_->request.pour;
  WatchRules rules{Vec3::Constant(-far), Vec3::Constant(far), pour.rest_move, pour.rest_turn};
  const Bin::Kind kind = plan_->world.bin.kind;
  if (kind == Bin::Kind::floor || kind == Bin::Kind::box) rules.lower.z() = 0.0;
  if (kind == Bin::Kind::box)
    for (const int axis : {0, 1}) {
      rules.upper[axis] = 0.5 * plan_->world.bin.inner_size[axis];
      rules.lower[axis] = -rules.upper[axis];
    }
  if (kind == Bin::Kind::mesh) {
    rules.lower = plan_->bin_bounds.lower;
    rules.upper = plan_->bin_bounds.upper;
    rules.upper.z() = far;
  }
  return rules;
}

void HeapCore::begin_watch() {
  WorldWatch* const watch = solver_.watch();
  if (!watch) return;
  if (!device_) device_.emplace(*watch, rules(), plan_->request.pour.rest_window);
  device_->begin_world(id_);
}

void HeapCore::leave_world() {
  if (device_) {
    note_worst();
    device_->leave_world();
  }
  solver_.remove_world(id_);
}

void HeapCore::restart_rest() {
  if (device_) return device_->restart_rest();
  rest_ = RestWatch(states_.size());
}

void HeapCore::restart_watch() {
  restart_rest();
  if (device_) return device_->restart();
  audit_.emplace(plan_->world);
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in) audit_->enter(b, states_[b]);
}

bool HeapCore::resting(std::size_t body) const {
  return device_ ? device_->resting(body) : rest_.resting(body);
}
double HeapCore::still(std::size_t body) const {
  return device_ ? device_->still(body) : rest_.still(body, time_);
}
std::size_t HeapCore::unrested() const {
  if (device_ && device_->observed()) return device_->seen().unrested;
  return count_moving([&](std::size_t b) { return device_ || !rest_.resting(b); });
}

void HeapCore::ask(double seconds, bool slice_ends) {
  if (!device_) return;
  const Steps steps = steps_in(seconds, solver_.step_size());
  if (steps.count() == 0) return;
  const double time = time_ + static_cast<double>(steps.whole) * solver_.step_size() + steps.rest;
  const bool time_ends =
      plan_->request.seconds && steps_in(*plan_->request.seconds - time, solver_.step_size()).count() == 0;
  const bool keeps = std::find(kept_.begin(), kept_.end(), true) != kept_.end();  // until they wake: release_kept()
  const bool states = lifts_ || keeps || !waiting_.empty() || time_ends || time >= plan_->request.pour.limit;
  if (slice_ends || time_ends)
    device_->ask(time, settling_.ages(*this, time), follows() || lifts_, states);
  else
    device_->ask_nothing(states);
}

void HeapCore::advanced(double seconds) {
  time_ += seconds;
  fresh_ = false;
  if (device_) device_->take();
}

bool HeapCore::wants_states() {
  if (!device_ || device_->has_states()) return false;
  const bool changes =
      device_->is_current() && (device_->seen().outside > 0 || settling_.will_change(*this, time_) || over());
  const bool wants = changes || device_->lacks_states();
  if (wants) device_->note_states();
  return wants;
}

/// What has left the bin is taken out. Without states nothing is to be changed: wants_states().
void HeapCore::take_observation() {
  if (!device_->has_states()) return;
  states();
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (!moves(b) || !device_->is_outside(b)) continue;
    solver_.remove(id_, b);
    place_[b] = Place::escaped;
  }
  note_worst();
}

void HeapCore::update_rest(bool driven) {
  if (device_) return take_observation();
  const Pour& pour = plan_->request.pour;
  const std::vector<BodyState> now = solver_.states(id_);
  release_kept();
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (!moves(b)) continue;
    const PartModel& part = this->part(b);
    const bool finite = now[b].pose.finite();
    BIN_SCENES_ASSERT(!finite || is_unit(now[b].pose.orientation));
    if (finite && !is_kept(b)) states_[b] = now[b];
    if (!finite || outside(states_[b].pose * part.mass().center)) {
      solver_.remove(id_, b);
      place_[b] = Place::escaped;
      audit_->leave(b);
      continue;
    }
    rest_.observe(b, time_, states_[b].pose * part.mass().center, states_[b].pose.orientation,
                  {pour.rest_window, pour.rest_move * part.diagonal(), pour.rest_turn});
  }
  audit_->observe(time_, states_, driven);
  note_worst();
  fresh_ = true;
}

void HeapCore::note_worst() {
  const std::optional<WorstContact> worst = solver_.take_worst_contact(id_);
  if (!worst) return;
  deepest_.known = true;
  unresolved_impacts_ += worst->unresolved_impacts;
  if (worst->relative > deepest_.relative)
    deepest_ = {true, worst->depth, worst->relative, {worst->a, worst->b}, time_ - worst->ago};
}

bool HeapCore::slow(std::size_t body) const {
  const PartModel& part = this->part(body);
  const double size = part.diagonal(), limit = 0.25 * std::sqrt(plan_->world.gravity.norm() * size);
  const Twist& v = states_[body].velocity;
  return v.linear.norm() + 0.5 * size * v.angular.norm() <= limit;
}

template <class Test>
std::size_t HeapCore::count_moving(Test test) const {
  std::size_t count = 0;
  for (std::size_t b = 0; b < states_.size(); ++b) count += moves(b) && test(b);
  return count;
}

std::size_t HeapCore::count() const {
  return count_moving([](std::size_t) { return true; });
}
bool HeapCore::all_rest() const {
  return unrested() == 0;
}
bool HeapCore::all_slow() const {
  if (device_ && device_->observed()) return device_->seen().fast == 0;
  return count_moving([&](std::size_t b) { return !slow(b); }) == 0;
}
std::size_t HeapCore::still_for_less_than(double seconds) const {
  if (device_ && device_->observed()) return device_->moved(seconds);
  return count_moving([&](std::size_t b) { return still(b) < seconds; });
}
bool HeapCore::all_asleep() const {
  if (device_ && device_->observed()) return device_->seen().awake == 0;
  const std::vector<bool> asleep = solver_.asleep(id_);
  return count_moving([&](std::size_t b) { return !asleep[b]; }) == 0;
}

std::vector<bool> HeapCore::unverified() const {
  std::vector<bool> bodies(states_.size());
  for (std::size_t b = 0; b < states_.size(); ++b) bodies[b] = moves(b) && still(b) < settling_.checked_s();
  return bodies;
}

}  // namespace bin_scenes
