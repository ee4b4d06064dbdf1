/// Trials of grasps. Those of a scene are stepped together, each in a world of its own with all parts asleep but the
/// one that is gripped.
#include "bin_scenes/pour/prover.hpp"

#include "pour/gripper_bodies.hpp"
#include "pour/settling.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/pour/pour.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

namespace bin_scenes {

namespace {

constexpr double lift_height = 0.1;         ///< m
constexpr double hand_speed = 0.25;         ///< m/s
constexpr double least_acceleration = 0.1;  ///< m/s2: of grippers that ask for less, so that the lift ends
constexpr double closing_speed = 0.04;      ///< m/s of each finger; slower than what bounces
constexpr double closing_rest = 0.002;      ///< m/s: fingers that are slower have closed
constexpr double closing_patience = 0.1;    ///< s longer than they need for their opening
constexpr double vacuum_rise = 0.05;        ///< s
constexpr double holding = 0.05;            ///< s between gripping and lifting
constexpr double jaw_masses = 4.0;          ///< of each jaw, in masses of the part: Jaws::mass
constexpr double moved_distance = 0.05;     ///< of a part's diagonal: others that moved farther are reported
constexpr double moved_turn = 0.1;          ///< rad: likewise
constexpr int steps_per_touch = 4;          ///< between two readings of the forces
constexpr int touches_without_hold = 3;     ///< after which the part is lost
constexpr std::size_t trials_at_once = 32;  ///< worlds in memory

/// Height of the hand above its start, t seconds after the lift began: speed rises and falls evenly.
double height_at(double t, double acceleration) {
  acceleration = std::max(acceleration, least_acceleration);
  const double speed = std::min(hand_speed, std::sqrt(acceleration * lift_height));
  const double ramp = speed / acceleration, end = lift_height / speed + ramp;
  if (t <= 0.0) return 0.0;
  if (t >= end) return lift_height;
  if (t > end - ramp) return lift_height - 0.5 * acceleration * (end - t) * (end - t);
  if (t > ramp) return speed * (t - 0.5 * ramp);
  return 0.5 * acceleration * t * t;
}

double turn_between(const Pose& a, const Pose& b) {
  return a.orientation.angularDistance(b.orientation);
}

/// What all trials of a scene share.
struct Ground {
  const Scene& scene;
  const LoadedRequest& loaded;
  WorldDef world;
  Vec3 up = Vec3::UnitZ();

  Ground(const Scene& of, const LoadedRequest& with) : scene(of), loaded(with), world(world_of(with)) {
    if (world.gravity.norm() > 0.0) up = -world.gravity.normalized();
  }
  const PartModel& model(std::size_t body) const { return *world.parts[world.bodies[body].part]; }
  static bool in(const ScenePart& part) {
    return is_there(part.state) && part.state != PartState::escaped && part.pose.finite();
  }
};

class Attempt {
 public:
  Attempt(Solver& solver, const Ground& ground, const Trial& trial, const std::vector<GripperBody>& bodies)
      : solver_(solver),
        ground_(ground),
        trial_(trial),
        gripper_(ground.loaded.request.grippers.at(trial.gripper)),
        part_(static_cast<std::size_t>(trial.part)),
        first_(ground.world.bodies.size()),
        bodies_(bodies) {
    WorldDef def = ground.world;
    for (const GripperBody& body : bodies) {
      BodyDef fixed;
      fixed.part = def.parts.size();
      fixed.fixed = true;
      fixed.friction = gripper_.friction;
      def.parts.push_back(body.model);
      def.bodies.push_back(fixed);
    }
    id_ = solver_.add_world(def);
    for (const ScenePart& part : ground.scene.parts)
      if (Ground::in(part)) solver_.insert(id_, static_cast<std::size_t>(part.id), {part.pose, Twist()});
    solver_.set_phase(id_, phases::repair);
    before_ = solver_.states(id_);
    solver_.insert(id_, part_, {before_[part_].pose, Twist()});
    const Aperture at{trial_.width, trial_.inner};
    const double opening = gripper_.opened(at);
    const double open = 0.5 * gripper_.between_fingers(at) + (trial_.inner ? -opening : opening);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      Pose pose = bodies_[k].pose;
      if (parallel() && k < 2) pose.position.x() += k == 0 ? -open : open;
      starts_.push_back(trial_.pose * pose);
      solver_.insert(id_, first_ + k, {starts_.back(), Twist()});
    }
    contact_ = before_[part_].pose.inverse() * trial_.pose.position;
    patience_ = closing_patience + (opening + gripper_.pad_give) / closing_speed;
  }
  ~Attempt() { solver_.remove_world(id_); }
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;

  WorldId id() const { return id_; }
  bool over() const { return stage_ == Stage::over; }
  const LiftProof& proof() const { return proof_; }

  /// Sets the gripper's velocities for the next `seconds`.
  void go(double seconds) {
    const double next = stage_ == Stage::lift ? height_at(time_ + seconds, gripper_.acceleration) : height_;
    const Vec3 velocity = (next - height_) / seconds * trial_.lift;
    if (parallel()) {
      Jaws jaws;
      jaws.first = first_;
      jaws.second = first_ + 1;
      jaws.axis = (trial_.inner ? -1.0 : 1.0) * axis();
      jaws.force = trial_.force;
      jaws.speed = closing_speed;
      jaws.mass = jaw_masses * ground_.world.bodies[part_].mass;
      jaws.velocity = velocity;
      solver_.set_jaws(id_, jaws);
    } else {
      solver_.set_force(id_, part_, -vacuum() * (trial_.pose.orientation * Vec3::UnitZ()), mouth());
    }
    for (std::size_t k = parallel() ? 2 : 0; stage_ == Stage::lift && k < bodies_.size(); ++k) {
      Pose pose = starts_[k];
      pose.position += height_ * trial_.lift;
      solver_.insert(id_, first_ + k, {pose, {velocity, Vec3::Zero()}});
    }
    height_ = next;
    time_ += seconds;
  }

  /// Decides by the states after a step whether the stage is over.
  void observe() {
    states_ = solver_.states(id_);
    if (stage_ == Stage::grasp)
      observe_closing();
    else if (stage_ == Stage::hold && time_ >= holding)
      begin(Stage::lift);
    else if (stage_ == Stage::lift)
      observe_lift();
  }

 private:
  enum class Stage { grasp, hold, lift, over };

  bool parallel() const { return gripper_.type == Gripper::Type::parallel; }
  Vec3 axis() const { return trial_.pose.orientation * Vec3::UnitX(); }
  Vec3 mouth() const { return trial_.pose.position + height_ * trial_.lift; }
  double vacuum() const { return trial_.force * (stage_ == Stage::grasp ? std::min(1.0, time_ / vacuum_rise) : 1.0); }
  Vec3 center(const BodyState& state) const { return state.pose * ground_.model(part_).mass().center; }

  void begin(Stage stage) {
    stage_ = stage;
    time_ = 0.0;
    steps_ = 0;
    if (stage == Stage::lift) held_ = states_[part_];
  }

  void observe_closing() {
    if (!parallel()) {
      if (time_ >= vacuum_rise) begin(Stage::hold);
      return;
    }
    const BodyState &a = states_[first_], &b = states_[first_ + 1];
    const double closing = 0.5 * (a.velocity.linear - b.velocity.linear).dot(axis());
    const bool late = time_ > patience_;
    if (at_end(a, b) || (late && !holds_part()))
      end(LiftProof::Outcome::missed);
    else if (late || (std::abs(closing) < closing_rest && holds_part()))
      begin(Stage::hold);
  }

  /// Whether the fingers have met each other, or have come to the end of their stroke.
  bool at_end(const BodyState& a, const BodyState& b) const {
    const auto face = [&](std::size_t k) { return (starts_[k].position - trial_.pose.position).dot(axis()); };
    const double moved = (b.pose.position - a.pose.position).dot(axis()) - (face(1) - face(0));
    const Aperture at{trial_.width, trial_.inner};
    const double opening = 2.0 * gripper_.opened(at), between = gripper_.between_fingers(at);
    return trial_.inner ? between - opening + moved >= gripper_.travel() : between + opening + moved <= 0.0;
  }

  /// Whether the gripper has the part, and what others pull it back with.
  struct Touch {
    bool gripper = false;
    double back = 0.0;  ///< N
  };
  Touch touch() const {
    std::set<std::size_t> pressing;
    Vec3 others = Vec3::Zero();
    for (const ContactForce& f : solver_.contact_forces(id_)) {
      const bool is_a = f.a == trial_.part;
      if (!is_a && f.b != trial_.part) continue;
      const int other = is_a ? f.b : f.a;
      if (other >= static_cast<int>(first_))
        pressing.insert(static_cast<std::size_t>(other));
      else
        others += is_a ? Vec3(-f.force) : f.force;
    }
    const std::size_t needed = parallel() ? 2 : 0;
    bool all = true;
    for (std::size_t k = 0; k < needed; ++k) all = all && pressing.count(first_ + k);
    return {all, std::max(0.0, -others.dot(trial_.lift))};
  }
  bool holds_part() const { return touch().gripper; }

  /// How far the vacuum's seat has gone from the cup.
  bool sealed() const {
    const Vec3 away = trial_.pose.orientation.conjugate() * (states_[part_].pose * contact_ - mouth());
    return away.z() < gripper_.lip && away.head<2>().norm() < 0.5 * gripper_.radius;
  }

  void observe_lift() {
    if (!parallel() && !sealed()) return end_lost();
    if (++steps_ % steps_per_touch == 0) {
      const Touch now = touch();
      back_ = std::max(back_, now.back);
      without_ = now.gripper ? 0 : without_ + 1;
      if (without_ >= touches_without_hold) return end_lost();
    }
    if (height_ < lift_height) return;
    const bool came = (center(states_[part_]) - center(before_[part_])).dot(trial_.lift) >= 0.5 * lift_height;
    if (!came || without_ > 0) return end_lost();
    note_others();
    end(proof_.dragged.empty() ? LiftProof::Outcome::lifted : LiftProof::Outcome::dragged);
  }

  void end_lost() {
    note_others();
    const double weight = ground_.world.bodies[part_].mass * ground_.world.gravity.norm();
    end(back_ > weight ? LiftProof::Outcome::jammed : LiftProof::Outcome::slipped);
  }

  void end(LiftProof::Outcome outcome) {
    proof_.outcome = outcome;
    if (stage_ == Stage::lift) {
      const Vec3 hand = height_ * trial_.lift;
      proof_.slip = (center(states_[part_]) - hand - center(held_)).norm();
      proof_.turn = turn_between(states_[part_].pose, held_.pose);
    }
    stage_ = Stage::over;
  }

  void note_others() {
    for (const ScenePart& part : ground_.scene.parts) {
      const auto body = static_cast<std::size_t>(part.id);
      if (body == part_ || !Ground::in(part)) continue;
      const PartModel& model = ground_.model(body);
      const Vec3 displacement = states_[body].pose * model.mass().center - before_[body].pose * model.mass().center;
      if (displacement.dot(ground_.up) > 0.5 * lift_height)
        proof_.dragged.push_back(part.id);
      else if (displacement.norm() > moved_distance * model.diagonal() ||
               turn_between(states_[body].pose, before_[body].pose) > moved_turn)
        proof_.moved.push_back(part.id);
    }
  }

  Solver& solver_;
  const Ground& ground_;
  const Trial& trial_;
  const Gripper& gripper_;
  const std::size_t part_, first_;  ///< bodies: the part, the first of the gripper
  const std::vector<GripperBody>& bodies_;
  WorldId id_ = 0;
  std::vector<BodyState> before_, states_;
  BodyState held_;
  std::vector<Pose> starts_;  ///< of the gripper's bodies
  Vec3 contact_;              ///< centre of the ring, in the part's frame
  double patience_ = 0.0;     ///< s
  Stage stage_ = Stage::grasp;
  double time_ = 0.0;    ///< s of the stage
  double height_ = 0.0;  ///< m, of the hand above its start
  int steps_ = 0, without_ = 0;
  double back_ = 0.0;  ///< N, most so far
  LiftProof proof_;
};

}  // namespace

struct Prover::State {
  std::mutex mutex;
  std::unique_ptr<Solver> solver;
  std::map<std::size_t, std::vector<GripperBody>> bodies;  ///< by gripper

  explicit State(const LoadedRequest& loaded) {
    Request request = loaded.request;
    request.solver.type = SolverType::sphere;
    request.memory_budget *= 0.5;  // the heap's solver has fields of its own
    request.solver.sphere.device = SphereSettings::Device::cpu;
    if (request.solver.preset == SolverSettings::Preset::thesis)
      request.solver.preset = SolverSettings::Preset::standard;
    std::string reason;
    solver = make_solver({request, loaded.parts}, reason);
  }

  const std::vector<GripperBody>& bodies_of(std::size_t gripper, const Request& request) {
    auto& known = bodies[gripper];
    if (known.empty()) known = bin_scenes::bodies_of(request.grippers.at(gripper));
    return known;
  }

  void prove(const Ground& ground, const Trial* begin, const Trial* end, std::vector<LiftProof>& proofs) {
    std::vector<std::unique_ptr<Attempt>> attempts;
    for (const Trial* trial = begin; trial != end; ++trial)
      attempts.push_back(
          std::make_unique<Attempt>(*solver, ground, *trial, bodies_of(trial->gripper, ground.loaded.request)));
    const double step = solver->step_size();
    std::vector<WorldId> ids;
    do {
      stop_if_cancelled();
      ids.clear();
      for (const auto& attempt : attempts) {
        if (attempt->over()) continue;
        attempt->go(step);
        ids.push_back(attempt->id());
      }
      solver->advance(ids, step);
      for (const auto& attempt : attempts)
        if (!attempt->over()) attempt->observe();
    } while (!ids.empty());
    for (const auto& attempt : attempts) proofs.push_back(attempt->proof());
  }
};

Prover::Prover(const LoadedRequest& loaded) : state_(std::make_unique<State>(loaded)) {}
Prover::~Prover() = default;

std::vector<LiftProof> Prover::prove(const Scene& scene, const LoadedRequest& loaded,
                                     const std::vector<Trial>& trials) {
  std::vector<LiftProof> proofs;
  // Isolated: while it waits, this thread must not begin another scene's proofs, which wait for this lock.
  tbb::this_task_arena::isolate([&] {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    const Ground ground(scene, loaded);
    for (std::size_t i = 0; i < trials.size(); i += trials_at_once)
      state_->prove(ground, trials.data() + i, trials.data() + std::min(trials.size(), i + trials_at_once), proofs);
  });
  return proofs;
}

}  // namespace bin_scenes
