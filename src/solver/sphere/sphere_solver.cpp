/// Steps worlds by the passes of solver/sphere/passes, with shorter steps where something is fast or small. GPU form:
/// src/solver/sphere_gl/gl_sphere_solver.cpp.
#include "solver/sphere/sphere_solver.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/shapes/shape_cache.hpp"
#include "solver/step_limit.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

using namespace sphere;

/// A world with the shapes it points into and the frame of its poses.
struct Slot {
  World world;
  bool used = false;
  std::size_t bodies = 0;  ///< of the caller; a mesh bin adds one more behind them
};

#include "shared/sphere/cut.h"

int cuts_of_rolling(const World& world) {
  if (!world.cuts_rolling()) return 1;  // also where parts were added since: World::rolling is old then
  const float sub_step = world.whole_step / static_cast<float>(world.settings.sub_steps);
  return static_cast<int>(
      std::ceil(std::clamp(world.rolling * sub_step / world.settings.roll, 1.0f, world.settings.roll_cuts)));
}

/// Returns into how many equal steps the next one is divided, for parts that are fast or roll.
int cuts_now(const World& world) {
  if (!world.settings.cut_steps) return 1;
  float distance = 0.0f, turn = 0.0f;
  for (const Body& b : world.bodies) {
    if (!b.moves()) continue;
    distance = std::max(distance, (b.v.norm() + b.w.norm() * world.shapes[b.shape]->radius) * world.whole_step);
    turn = std::max(turn, b.w.norm() * world.whole_step);
  }
  return std::max(static_cast<int>(cuts_of(distance, turn, world.thinnest)), cuts_of_rolling(world));
}

void step_in_cuts(World& world) {
  const int cuts = cuts_now(world);
  BIN_SCENES_ASSERT(cuts >= 1);
  world.settings.time_step = world.whole_step / static_cast<float>(cuts);
  for (int k = 0; k < cuts; ++k) step(world);
}

/// @param time_step  s: the setting, which small parts need to be cut
void advance_world(World& world, const Steps& steps, double time_step) {
  BIN_SCENES_ASSERT(world.cuts >= 1 && steps.rest >= 0.0 && steps.rest <= time_step);
  const auto cuts = static_cast<std::uint64_t>(world.cuts);
  for (std::uint64_t k = 0; k < steps.whole * cuts; ++k) step_in_cuts(world);
  if (steps.rest == 0.0) return;
  const float whole_step = world.whole_step;
  world.whole_step *= static_cast<float>(steps.rest / time_step);
  for (std::uint64_t k = 0; k < cuts; ++k) step_in_cuts(world);
  world.whole_step = whole_step;
}

class SphereSolver final : public Solver {
 public:
  SphereSolver(const SphereSettings& settings, const Variant& variant)
      : settings_(settings), base_(variant.settings), shapes_(settings, variant.change) {}

  WorldId add_world(const WorldDef& def) override {
    WorldId id = 0;
    while (id < slots_.size() && slots_[id]->used) ++id;
    if (id == slots_.size()) slots_.push_back(std::make_unique<Slot>());
    Slot& slot = *slots_[id];
    slot = Slot{};
    slot.used = true;
    slot.bodies = def.bodies.size();
    slot.world = make_world(
        def, settings_, [this](const PartModelPtr& part) -> const Shape& { return shapes_.of(part, profile_); }, base_);
    return id;
  }

  void remove_world(WorldId id) override {
    Slot& slot = slot_of(id);
    collect(slot.world);
    slot = Slot{};
  }

  void set_frame(WorldId id, const Frame& frame) override {
    World& world = slot_of(id).world;
    world.frame = frame;
    world.gravity = frame.gravity.cast<float>();
    for (Body& b : world.bodies) wake(b);
  }

  void set_jaws(WorldId id, const Jaws& jaws) override { sphere::set_jaws(slot_of(id).world, jaws); }
  void set_force(WorldId id, std::size_t body, const Vec3& force, const Vec3& point) override {
    sphere::set_force(slot_of(id).world, body, force, point);
  }
  void insert(WorldId id, std::size_t body, const BodyState& state) override { place(slot_of(id).world, body, state); }

  void remove(WorldId id, std::size_t body) override {
    World& w = slot_of(id).world;
    BIN_SCENES_ASSERT(body < w.bodies.size());
    for (const std::uint32_t other : touched_by(w, static_cast<std::uint32_t>(body))) wake(w.bodies[other]);
    w.bodies[body].present = false;
  }

  bool set_phase(WorldId id, const Phase& phase) override {
    sphere::set_phase(slot_of(id).world, phase);
    return true;
  }

  double advance(const std::vector<WorldId>& worlds, double seconds) override {
    const Steps steps = steps_in(seconds, settings_.time_step);
    // Worlds share nothing, so that threads cannot change a result.
    tbb::parallel_for(std::size_t{0}, worlds.size(), [&, flag = cancel_flag()](std::size_t i) {
      const CancelScope scope(flag);
      advance_world(slot_of(worlds[i]).world, steps, settings_.time_step);
    });
    return static_cast<double>(steps.whole) * settings_.time_step + steps.rest;
  }

  std::vector<BodyState> states(WorldId id) const override {
    const Slot& slot = slot_of(id);
    std::vector<BodyState> out(slot.bodies);
    for (std::size_t i = 0; i < slot.bodies; ++i) out[i] = state_of(slot.world, i);
    return out;
  }

  std::vector<bool> asleep(WorldId id) const override {
    const Slot& slot = slot_of(id);
    std::vector<bool> out(slot.bodies);
    for (std::size_t i = 0; i < slot.bodies; ++i) out[i] = slot.world.bodies[i].asleep;
    return out;
  }

  std::vector<ContactForce> contact_forces(WorldId id) const override {
    return forces_of(slot_of(id).world, slot_of(id).bodies);
  }

  std::optional<WorstContact> take_worst_contact(WorldId id) override {
    return sphere::take_worst_contact(slot_of(id).world, slot_of(id).bodies);
  }

  std::size_t worlds_at_once() const override { return tbb::this_task_arena::max_concurrency(); }
  double step_size() const override { return settings_.time_step; }
  std::uint64_t steps(WorldId id) const override { return slot_of(id).world.counters.steps; }
  std::vector<Flag> flags(WorldId id) const override { return flags_of(slot_of(id).world); }
  std::string name() const override { return "sphere"; }
  std::string device() const override { return "cpu"; }

  const Profile& profile() const override {
    shown_ = profile_;
    for (const auto& slot : slots_)
      if (slot->used) add(shown_, slot->world);
    return shown_;
  }

 private:
  Slot& slot_of(WorldId id) const {
    BIN_SCENES_ASSERT(id < slots_.size() && slots_[id]->used);
    return *slots_[id];
  }
  /// Stages are of all worlds: on several threads they add up to more than the time that passed.
  static void add(Profile& p, const World& world) {
    const Spent& s = world.spent;
    p.add("find_pairs", s.find_pairs);
    p.add("find_contacts", s.find_contacts);
    p.add("color_manifolds", s.color_manifolds);
    p.add("solve", s.solve);
    p.add("update_sleep", s.update_sleep);
    Counters::each([&](const char* name, std::uint64_t Counters::*member) { p.count(name, world.counters.*member); });
  }
  void collect(const World& world) { add(profile_, world); }

  SphereSettings settings_;
  Settings base_;
  ShapeCache shapes_;
  std::vector<std::unique_ptr<Slot>> slots_;
  Profile profile_;
  mutable Profile shown_;
};

}  // namespace

std::unique_ptr<Solver> make_sphere_solver(const SphereSettings& settings) {
  return make_sphere_solver(settings, {});
}

std::unique_ptr<Solver> make_sphere_solver(const SphereSettings& settings, const sphere::Variant& variant) {
  if (!(settings.time_step > 0))
    throw input_error("time_step must be above 0", "solver.sphere.time_step", "0.0025 is a good start");
  return std::make_unique<SphereSolver>(settings, variant);
}

}  // namespace bin_scenes
