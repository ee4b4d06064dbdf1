/// Holds body by body who waits, is in, rests, has escaped or is gone, and informs the solver of each change. Stages
/// and their ends are decided in settling.cpp.
#include "pour/heap_core.hpp"

#include "pour/jam.hpp"
#include "solver/step_limit.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

HeapCore::HeapCore(std::shared_ptr<const PourPlan> plan, Solver& solver, std::size_t index)
    : plan_(std::move(plan)),
      solver_(solver),
      index_(index),
      random_(plan_->request.seed, index, Stream::pour),
      settling_(plan_->request.pour.finish),
      rest_(0) {
  const auto& lines = plan_->request.parts;
  const bool entering =
      std::any_of(lines.begin(), lines.end(), [](const PartLine& l) { return l.poses.empty() && l.count > 0; });
  make_world(entering);
  const bool enters = enter(0);
  begin(!enters && all_slow() ? Stage::hold : Stage::pour);
  if (plan_->request.pour.pattern == Pour::Pattern::given) begin_motion();
}

HeapCore::~HeapCore() {
  solver_.remove_world(id_);
}

namespace {
constexpr double hand_masses =
    1000.0;  ///< of a lifted part, in masses of the heaviest: so that what lies on it makes no difference
}

/// Makes a world with the bodies that are in the bin. While parts enter, the walls of a box are raised to hold them.
void HeapCore::make_world(bool raised_walls, const std::vector<std::size_t>& lifted) {
  WorldDef def = plan_->world;
  def.scene = static_cast<std::int64_t>(index_);
  lifts_ = !lifted.empty();
  kept_.clear();
  kept_forces_.clear();
  double heaviest = 0.0;
  for (const BodyDef& body : def.bodies)
    if (!body.fixed) heaviest = std::max(heaviest, body.mass);
  for (const std::size_t b : lifted) def.bodies[b].mass = hand_masses * heaviest;
  walls_raised_ = raised_walls && def.bin.kind == Bin::Kind::box;
  if (walls_raised_) {
    def.wall_height = plan_->entry_height;
    if (plan_->request.pour.pattern == Pour::Pattern::grid)  // one cell of a column each at worst
      def.wall_height += plan_->request.pour.grid_spacing * 2.0 * plan_->largest_part * def.bodies.size();
  }
  id_ = solver_.add_world(def);
  begin_watch();
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in) solver_.insert(id_, b, states_[b]);
  // A solver that moves nothing says so now, and not when all has been poured.
  if (motion_seconds() > 0.0) solver_.set_frame(id_, Frame{def.gravity, Vec3::Zero(), Vec3::Zero()});
}

void HeapCore::begin(Stage stage) {
  settling_.start(stage);
  set_solver_phase();
  start_clock();
}

void HeapCore::set_solver_phase() {
  if (!solver_.set_phase(id_, settling_.phase())) settling_.ignore_stages();
}

void HeapCore::start_clock() {
  let_go();
  course_begun_ -= time_;
  time_ = 0.0;
  settling_.start_clock();
  solver_.take_worst_contact(id_);
  deepest_ = {};
  unresolved_impacts_ = 0;
  restart_watch();
  earlier_steps_ = std::uint64_t{0} - solver_.steps(id_);
  fresh_ = true;
}

void HeapCore::extend(std::shared_ptr<const PourPlan> plan) {
  solver_.check(plan->world);
  states();
  const std::size_t first = states_.size();
  if (course_ == Course::over) {
    moving_from_ = plan_->request.parts.size();
    course_ = Course::ahead;
  }
  audit_.reset();  // it refers to the old plan
  plan_ = std::move(plan);
  solver_.remove_world(id_);
  make_world(true);
  enter(first);
  begin(Stage::pour);
}

void HeapCore::remove(std::size_t body) {
  let_go();
  if (settling_.done()) {
    states();
    begin(Stage::repair);
  }
  if (place_[body] == Place::in) {
    solver_.remove(id_, body);
    wake_kept_beside(body);
    if (audit_) audit_->leave(body);  // a device sees that it has left
  }
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), body), waiting_.end());
  place_[body] = Place::removed;
  states_[body] = {Pose::none(), {}};
}

void HeapCore::recover() {
  solver_.remove_world(id_);
  make_world(walls_raised_);
  begin(waiting_.empty() ? Stage::settle : Stage::pour);
}

void HeapCore::insert(std::size_t body, const BodyState& state) {
  BIN_SCENES_ASSERT(body < states_.size() && is_rigid(state.pose));
  BIN_SCENES_ASSERT(place_[body] != Place::in);
  solver_.insert(id_, body, state);
  if (audit_) audit_->enter(body, state);
  if (device_) device_->enter(body);
  states_[body] = state;
  place_[body] = Place::in;
}

const std::vector<BodyState>& HeapCore::states() {
  if (fresh_) return states_;
  const std::vector<BodyState> now = solver_.states(id_);
  BIN_SCENES_ASSERT(now.size() >= states_.size());
  release_kept();
  for (std::size_t b = 0; b < states_.size(); ++b)
    if (place_[b] == Place::in && !is_kept(b) && now[b].pose.finite()) states_[b] = now[b];
  fresh_ = true;
  return states_;
}

double HeapCore::time_left() const {
  if (!plan_->request.seconds) return std::numeric_limits<double>::infinity();
  const double left = *plan_->request.seconds - time_;
  return steps_in(left, solver_.step_size()).count() > 0 ? left : 0.0;
}

bool HeapCore::moves(std::size_t body) const {
  return place_[body] == Place::in && !plan_->world.bodies[body].fixed;
}

void HeapCore::advance() {
  update_rest(follows());
  insert_waiting();
  if (follows() && !end_motion()) return;
  const Stage before = settling_.stage();
  if (!settling_.advance(*this, time_) || settling_.done()) return;
  set_solver_phase();
  if (settling_.stage() == Stage::recheck) wake(unverified());
  poured_ = before == Stage::pour;
}

void HeapCore::change_world() {
  if (!poured_) return;
  poured_ = false;
  if (walls_raised_) cut_walls();
  restart_rest();  // parts that rested on coarse samples or leant on a cut wall may move again
  begin_motion();
}

bool HeapCore::over() const {
  if (plan_->request.seconds) return false;  // time_left() decides
  return settling_.done() || time_ >= plan_->request.pour.limit;
}

Progress HeapCore::progress() const {
  Progress progress;
  progress.phase = settling_.stage() == Stage::pour ? "pour" : "settle";
  progress.scene = index_;
  progress.parts = states_.size();
  progress.resting = static_cast<std::size_t>(std::count(place_.begin(), place_.end(), Place::in)) - unrested();
  progress.simulated_s = time_;
  const double parts = std::max<double>(1.0, static_cast<double>(states_.size()));
  const double entered = 1.0 - waiting_.size() / parts, still = progress.resting / parts;
  progress.fraction =
      plan_->request.seconds ? std::min(1.0, time_ / std::max(1e-9, *plan_->request.seconds)) : 0.5 * (entered + still);
  return progress;
}

PartState HeapCore::state_of(std::size_t body) const {
  switch (place_[body]) {
    case Place::in:
      if (plan_->world.bodies[body].fixed) return PartState::fixed;
      return resting(body) ? PartState::resting : PartState::moving;
    case Place::escaped:
      return PartState::escaped;
    case Place::removed:
      return PartState::removed;
    case Place::waiting:
    case Place::no_room:
      break;
  }
  return PartState::not_poured;
}

bool HeapCore::has(int id) const {
  return id >= 0 && static_cast<std::size_t>(id) < place_.size() && is_there(state_of(static_cast<std::size_t>(id)));
}

Scene HeapCore::scene() {
  states();
  Scene scene;
  scene.seed = plan_->request.seed;
  scene.index = index_;
  scene.sensors = plan_->request.sensors;
  Report& report = scene.report;
  report.at_rest = true;
  const std::vector<bool> unstable = settling_.gave_up() ? unverified() : std::vector<bool>(states_.size(), false);
  for (std::size_t b = 0; b < states_.size(); ++b) {
    ScenePart part;
    part.id = static_cast<int>(b);
    part.line = plan_->line_of[b];
    part.model = plan_->request.parts[part.line].model;
    part.distractor = plan_->request.parts[part.line].distractor;
    part.pose = states_[b].pose;
    part.velocity = states_[b].velocity;
    part.state = state_of(b);
    if (part.state == PartState::moving) report.at_rest = false;
    if (unstable[b]) report.unstable.push_back(part.id);
    if (part.state == PartState::escaped) report.escaped.push_back(part.id);
    if (part.state == PartState::not_poured) report.not_poured.push_back(part.id);
    scene.parts.push_back(std::move(part));
  }
  report.solver = solver_.name();
  report.device = solver_.device();
  report.finish = plan_->request.seconds ? "none" : settling_.finish();
  report.simulated_s = time_;
  report.steps = earlier_steps_ + solver_.steps(id_);
  report.flags = solver_.flags(id_);
  if (device_) note_worst();
  report.energy = device_ ? device_->energy() : audit_->worst();
  report.worst = {deepest_, device_ ? device_->energy_of_all() : audit_->worst_of_world(), unresolved_impacts_};
  if (!deepest_.known && time_ > 0.0)
    report.flags.push_back({"depths_unknown", "this solver does not report how deep contacts were during the run",
                            "use sphere without preset thesis, or bullet, where that matters"});
  for (Flag& flag : flags_of(report.energy)) report.flags.push_back(std::move(flag));
  const std::vector<ContactForce> forces = this->forces();
  for (const ContactForce& f : forces) scene.contacts.push_back({f.a, f.b, f.point, f.normal, f.force});
  report.jam = worst_jam(plan_->world, states_, forces);
  for (Flag& flag : flags_of(report.jam)) report.flags.push_back(std::move(flag));
  if (!report.not_poured.empty())
    report.flags.push_back({"not_poured",
                            std::to_string(report.not_poured.size()) + " of " + std::to_string(states_.size()) +
                                " parts found no room below the rim or no time to enter",
                            "ask for fewer parts, a larger bin, or more simulated time"});
  BIN_SCENES_ASSERT(std::is_sorted(report.escaped.begin(), report.escaped.end()));
  report.state_hash = state_hash(scene.parts);
  return scene;
}

}  // namespace bin_scenes
