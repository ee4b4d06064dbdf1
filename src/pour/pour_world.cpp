#include "pour/pour_world.hpp"
#include "solver/step_limit.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr int tries_per_part = 12;  ///< places tried for a part at each look; the lowest is taken
constexpr double calm_share = 0.4;  ///< of the rest window: parts still for so long are pressed, then probed
constexpr int most_questions = 12;  ///< a heap that still moves in the last one is left as it came to lie there
constexpr double may_move = 0.02;   ///< share of the parts that may move when asked of a heap that stands, less ...
constexpr double in_hand = 2.0;     ///< ... so many: one of 150. What moved has not been asked whether it stands now
constexpr double jolt = 0.02;       ///< s from the start of a question until its forces are found; parts budge then
constexpr double creep = 1.0;       ///< s of a probe after which it is not waited any longer that nothing creeps
constexpr double patience = 2.0;    ///< s of a question after which what still moves is settled: rigid contacts rock on
constexpr int misses_per_look = 4;  ///< parts without a place in a row after which a look gives up

}  // namespace

PourWorld::PourWorld(const PourPlan& plan, Solver& solver, std::size_t index)
    : plan_(plan),
      solver_(solver),
      index_(index),
      random_(plan.request.seed, index, Stream::pour),
      states_(plan.world.bodies.size()),
      place_(plan.world.bodies.size(), Place::waiting),
      rest_(plan.world.bodies.size()),
      audit_(plan.world) {
  for (BodyState& state : states_) state.pose = Pose::none();  // until a part is let in

  WorldDef def = plan.world;
  const bool entering = std::any_of(plan.request.parts.begin(), plan.request.parts.end(),
                                    [](const PartLine& line) { return line.poses.empty() && line.count > 0; });
  std::vector<Pose> grid;
  if (entering && def.bin.kind == Bin::Kind::box) {
    walls_cut_ = false;
    def.wall_height = plan.entry_height;
    if (plan.request.pour.pattern == Pour::Pattern::grid)  // one cell of a column each at worst
      def.wall_height += plan.request.pour.grid_spacing * 2.0 * plan.largest_part * def.bodies.size();
  }
  id_ = solver.add_world(def);
  solver_.set_phase(id_, Phase::pour);
  start_given();
  if (plan.request.pour.pattern == Pour::Pattern::grid || def.bin.kind == Bin::Kind::none)
    start_grid();
  else
    start_rain();
  goes_on_ = !entering && all_slow();
  stood_ = goes_on_;                  // what was at rest is not put to the test again
  if (goes_on_) enter(Phase::press);  // a heap that goes on from rest would sink on softer or coarser contacts
  fresh_ = true;
}

PourWorld::~PourWorld() {
  solver_.remove_world(id_);
}

void PourWorld::insert(std::size_t body, const BodyState& state) {
  solver_.insert(id_, body, state);
  audit_.enter(body, state);
  states_[body] = state;
  place_[body] = Place::in;
}

void PourWorld::start_given() {
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const PartLine& line = plan_.request.parts[plan_.line_of[b]];
    if (line.poses.empty()) {
      waiting_.push_back(b);
      continue;
    }
    BodyState state{line.poses[plan_.copy_of[b]], {}};
    if (!line.velocities.empty() && !line.fixed) state.velocity = line.velocities[plan_.copy_of[b]];
    if (!line.fixed && outside(state.pose * plan_.world.parts[plan_.line_of[b]]->mass().center)) {
      states_[b] = state;  // the walls would push it further out
      place_[b] = Place::escaped;
      continue;
    }
    insert(b, state);
  }
}

void PourWorld::start_grid() {
  std::vector<const PartModel*> models;
  for (const std::size_t b : waiting_) models.push_back(plan_.world.parts[plan_.line_of[b]].get());
  if (models.empty()) return;
  Opening opening = plan_.opening;
  if (plan_.world.bin.kind == Bin::Kind::floor) opening.upper.z() = opening.lower.z();
  if (plan_.world.bin.kind == Bin::Kind::none) opening.upper.z() = opening.lower.z();
  opening.upper.z() = std::max(opening.upper.z(), top());
  const std::vector<Pose> poses = grid_poses(models, opening, plan_.request.pour.grid_spacing, random_);
  for (std::size_t i = 0; i < poses.size(); ++i) insert(waiting_[i], {poses[i], {}});
  waiting_.clear();
}

void PourWorld::start_rain() {
  for (std::size_t i = waiting_.size(); i > 1; --i)  // Fisher-Yates: part lines come mixed
    std::swap(waiting_[i - 1], waiting_[random_.below(i)]);
  let_in();
}

const std::vector<BodyState>& PourWorld::states() {
  if (fresh_) return states_;
  const std::vector<BodyState> now = solver_.states(id_);
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in && now[b].pose.finite()) states_[b] = now[b];
  fresh_ = true;
  return states_;
}

double PourWorld::time_left() const {
  if (!plan_.request.seconds) return std::numeric_limits<double>::infinity();
  const double left = *plan_.request.seconds - time_;
  return steps_in(left, solver_.step_size()).count() > 0 ? left : 0.0;
}

bool PourWorld::outside(const Vec3& center) const {
  switch (plan_.world.bin.kind) {
    case Bin::Kind::none:
      return false;
    case Bin::Kind::floor:
      return center.z() < 0.0;
    case Bin::Kind::box: {
      const Vec3 half = 0.5 * plan_.world.bin.inner_size;
      return std::abs(center.x()) > half.x() || std::abs(center.y()) > half.y() || center.z() < 0.0;
    }
    case Bin::Kind::mesh: {
      const Aabb box = transformed(plan_.world.bin_model->mesh(), plan_.world.bin.pose).bounds();
      return center.x() < box.lower.x() || center.x() > box.upper.x() || center.y() < box.lower.y() ||
             center.y() > box.upper.y() || center.z() < box.lower.z();
    }
  }
  return false;
}

void PourWorld::judge() {
  const Pour& pour = plan_.request.pour;
  const std::vector<BodyState> now = solver_.states(id_);
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (!moves(b)) continue;
    const PartModel& part = *plan_.world.parts[plan_.line_of[b]];
    const bool finite = now[b].pose.finite();
    if (finite) states_[b] = now[b];
    if (!finite || outside(states_[b].pose * part.mass().center)) {
      solver_.remove(id_, b);
      place_[b] = Place::escaped;
      continue;
    }
    rest_.look(b, time_, states_[b].pose * part.mass().center, states_[b].pose.orientation,
               {pour.rest_window, pour.rest_move * part.diagonal(), pour.rest_turn});
  }
  audit_.look(time_, states_);
  fresh_ = true;
}

bool PourWorld::slow(std::size_t body) const {
  const PartModel& part = *plan_.world.parts[plan_.line_of[body]];
  const double size = part.diagonal(), limit = 0.25 * std::sqrt(plan_.world.gravity.norm() * size);
  const Twist& v = states_[body].velocity;
  return v.linear.norm() + 0.5 * size * v.angular.norm() <= limit;
}

double PourWorld::top() const {
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < states_.size(); ++b) {
    if (place_[b] != Place::in) continue;
    for (const Cover::Ball& ball : plan_.covers[plan_.line_of[b]].balls)
      highest = std::max(highest, (states_[b].pose * ball.center).z() + ball.radius);
  }
  return highest;
}

bool PourWorld::moves(std::size_t body) const {
  return place_[body] == Place::in && !plan_.world.bodies[body].fixed;
}

bool PourWorld::all_rest() const {
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (moves(b) && !rest_.resting(b)) return false;
  return true;
}

bool PourWorld::all_slow() const {
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (moves(b) && !slow(b)) return false;
  return true;
}

std::size_t PourWorld::less_still_than(double seconds) const {
  std::size_t count = 0;
  for (std::size_t b = 0; b < states_.size(); ++b) count += moves(b) && rest_.still(b, time_) < seconds;
  return count;
}

bool PourWorld::too_many(std::size_t moved) const {
  std::size_t movable = 0;
  for (std::size_t b = 0; b < states_.size(); ++b) movable += moves(b);
  return moved > std::max(0.0, may_move * movable - in_hand);
}

bool PourWorld::all_asleep() const {
  const std::vector<bool> asleep = solver_.asleep(id_);
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (moves(b) && !asleep[b]) return false;
  return true;
}

void PourWorld::enter(Phase phase) {
  phase_ = phase;
  asked_ = false;
  heeds_phases_ = solver_.set_phase(id_, phase);
}

void PourWorld::let_in() {
  if (waiting_.empty()) return;
  std::vector<Rain::Obstacle> obstacles;
  if (plan_.world.bin_model) obstacles.push_back({&plan_.bin_cover, Pose(), true});
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in)
      obstacles.push_back({&plan_.covers[plan_.line_of[b]], states_[b].pose, time_ > 0.0 && slow(b)});
  const Rain rain(plan_.opening, plan_.request.pour.drop_height);
  int misses = 0;
  std::vector<std::size_t> still;
  for (const std::size_t b : waiting_) {
    stop_if_cancelled();
    std::optional<Pose> pose;
    const Cover& shape = plan_.covers[plan_.line_of[b]];
    if (misses < misses_per_look)
      pose = rain.place(*plan_.world.parts[plan_.line_of[b]], shape, obstacles, random_, tries_per_part);
    if (!pose) {
      ++misses;
      still.push_back(b);
      continue;
    }
    misses = 0;
    insert(b, {*pose, {}});
    obstacles.push_back({&shape, *pose, false});
  }
  // Nothing moves any more and still nobody finds a place: the bin is full.
  if (still.size() == waiting_.size() && all_rest()) {
    for (const std::size_t b : still) place_[b] = Place::no_room;
    still.clear();
  }
  waiting_ = std::move(still);
}

void PourWorld::cut_walls() {
  walls_cut_ = true;
  if (top() <= plan_.world.wall_height) return;  // nothing leans on what is taken away
  earlier_steps_ += solver_.steps(id_);
  solver_.remove_world(id_);  // first: both at once would hold twice the memory
  id_ = solver_.add_world(plan_.world);
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in) solver_.insert(id_, b, states_[b]);
  solver_.set_phase(id_, phase_);
}

void PourWorld::look() {
  judge();
  let_in();
  if (phase_ == Phase::pour && waiting_.empty() && all_slow()) settle();
  const double calm = calm_share * plan_.request.pour.rest_window;
  if (asked_) {
    if (all_still(calm))  // what moved has come to lie
      judge_answer();
    else if (!all_slow() || (time_ - asked_since_ > patience && too_many(less_still_than(calm))))
      enter(Phase::settle);
  } else if (phase_ == Phase::press && !stood_ && all_still(calm)) {
    ask(Phase::probe);
  } else if (phase_ == Phase::settle && all_still(calm)) {
    enter(Phase::press);
  }
  // Stiff contacts take little out of rocking: not for what gets under way, nor for a start that was not at rest.
  const bool started_moving = goes_on_ && time_ >= calm && !all_still(0.5 * calm);
  if (phase_ == Phase::press && (!all_slow() || started_moving)) {
    stood_ = stood_ && !started_moving;
    enter(Phase::settle);
  }
  if (time_ >= calm) goes_on_ = false;
}

/// Whether the heap stands: first on rigid contacts and with friction to spare, then pressed as by whoever goes on from
/// its poses, both without remembered forces.
void PourWorld::ask(Phase phase) {
  enter(phase);
  asked_ = true;
  asked_since_ = time_;
  ++questions_;
}

/// What tips begins slowly: a heap has stood a probe only once it sleeps, or did not move for long.
void PourWorld::judge_answer() {
  const double asked = time_ - asked_since_;
  if (too_many(less_still_than(asked - jolt)) && questions_ < most_questions) {
    ask(phase_);
  } else if (all_rest() && phase_ == Phase::probe && heeds_phases_) {
    if (asked >= creep || all_asleep()) ask(Phase::press);
  } else if (all_rest()) {
    if (phase_ == Phase::probe) enter(Phase::press);
    asked_ = false;
    stood_ = true;
  }
}

void PourWorld::settle() {
  enter(Phase::settle);
  if (!walls_cut_) cut_walls();
  rest_ = RestWatch(states_.size());  // what rested on coarser shapes, or leant on a wall that is gone, may move again
}

bool PourWorld::over() const {
  if (plan_.request.seconds) return false;  // time_left() decides
  return (waiting_.empty() && phase_ == Phase::press && stood_ && all_rest()) || time_ >= plan_.request.pour.limit;
}

Progress PourWorld::progress() const {
  Progress progress;
  progress.phase = phase_ == Phase::pour ? "pour" : "settle";
  progress.scene = index_;
  progress.parts = states_.size();
  for (std::size_t b = 0; b < states_.size(); ++b)
    progress.resting += place_[b] == Place::in && (!moves(b) || rest_.resting(b));
  progress.simulated_s = time_;
  const double parts = std::max<double>(1.0, static_cast<double>(states_.size()));
  const double entered = 1.0 - waiting_.size() / parts, still = progress.resting / parts;
  progress.fraction =
      plan_.request.seconds ? std::min(1.0, time_ / std::max(1e-9, *plan_.request.seconds)) : 0.5 * (entered + still);
  return progress;
}

Scene PourWorld::scene() {
  states();
  Scene scene;
  scene.seed = plan_.request.seed;
  scene.index = index_;
  scene.sensors = plan_.request.sensors;
  Report& report = scene.report;
  report.at_rest = true;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    ScenePart part;
    part.id = static_cast<int>(b);
    part.line = plan_.line_of[b];
    part.model = plan_.request.parts[part.line].model;
    part.pose = states_[b].pose;
    part.velocity = states_[b].velocity;
    const bool fixed = plan_.world.bodies[b].fixed;
    switch (place_[b]) {
      case Place::in:
        part.state = fixed ? PartState::fixed : rest_.resting(b) ? PartState::resting : PartState::moving;
        break;
      case Place::escaped:
        part.state = PartState::escaped;
        break;
      case Place::waiting:
      case Place::no_room:
        part.state = PartState::not_poured;
        break;
    }
    if (part.state == PartState::moving) report.at_rest = false;
    if (part.state == PartState::escaped) report.escaped.push_back(part.id);
    if (part.state == PartState::not_poured) report.not_poured.push_back(part.id);
    scene.parts.push_back(std::move(part));
  }
  report.solver = solver_.name();
  report.device = solver_.device();
  report.simulated_s = time_;
  report.steps = earlier_steps_ + solver_.steps(id_);
  report.flags = solver_.flags(id_);
  report.energy = audit_.worst();
  for (Flag& flag : audit_.flags()) report.flags.push_back(std::move(flag));
  if (!report.not_poured.empty())
    report.flags.push_back({"not_poured",
                            std::to_string(report.not_poured.size()) + " of " + std::to_string(states_.size()) +
                                " parts found no room below the rim or no time to enter",
                            "ask for fewer parts, a larger bin, or more simulated time"});
  report.state_hash = state_hash(scene.parts);
  return scene;
}

}  // namespace bin_scenes
