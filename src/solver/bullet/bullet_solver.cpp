#include "bin_scenes/solver/bullet_solver.hpp"

#include "world.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/step_limit.hpp"

#include <cmath>
#include <map>

namespace bin_scenes {

namespace {

void check_settings(const BulletSettings& s) {
  const auto require = [](bool fine, const char* key, const char* remedy) {
    if (!fine) throw input_error("setting out of range", std::string("solver.bullet.") + key, remedy);
  };
  require(std::isfinite(s.time_step) && s.time_step > 0.0 && s.time_step <= 0.1, "time_step", "0 < time_step <= 0.1 s");
  require(s.iterations >= 1 && s.iterations <= 100000, "iterations", "1 to 100000");
  require(s.margin >= 0.0 && s.margin <= 0.1, "margin", "0 to 0.1 of the part's diagonal");
  require(s.hull_error > 0.0 && s.hull_error < 1.0, "hull_error", "above 0, below 1");
  require(s.hull_volume_error > 0.0 && s.hull_volume_error <= 10.0, "hull_volume_error", "above 0, at most 10");
  require(s.max_hulls >= 1, "max_hulls", "at least 1");
}

class BulletSolver : public Solver {
 public:
  explicit BulletSolver(const BulletSettings& settings) : settings_(settings) { check_settings(settings); }

  WorldId add_world(const WorldDef& def) override {
    StageTimer timer(profile_, "bullet_add_world");
    const auto shapes = [this](const PartModelPtr& part, double scale) { return shape(part, scale); };
    worlds_.emplace(next_, std::make_unique<bullet::World>(def, settings_, shapes));
    return next_++;
  }

  void remove_world(WorldId world) override { worlds_.erase(world); }

  void set_frame(WorldId world, const Frame& frame) override { at(world).set_frame(frame); }
  void insert(WorldId world, std::size_t body, const BodyState& state) override { at(world).insert(body, state); }
  void remove(WorldId world, std::size_t body) override { at(world).remove(body); }
  /// The same shapes and contacts serve all phases; only who sleeps is a matter.
  bool set_phase(WorldId world, const Phase& phase) override {
    at(world).begin(phase);
    return false;
  }

  double advance(const std::vector<WorldId>& worlds, double seconds) override {
    StageTimer timer(profile_, "bullet_step");
    const Steps steps = steps_in(seconds, settings_.time_step);
    for (const WorldId id : worlds) {
      bullet::World& world = at(id);
      const bullet::World::Counters before = world.counters();
      world.advance(steps);
      const bullet::World::Counters& after = world.counters();
      profile_.count("steps", after.steps - before.steps);
      profile_.count("body_steps_in_free_fall", after.free_falls - before.free_falls);
      profile_.count("body_steps_asleep", after.asleep - before.asleep);
      profile_.count("pairs", after.pairs - before.pairs);
      profile_.count("contacts", after.contacts - before.contacts);
    }
    return static_cast<double>(steps.whole) * settings_.time_step + steps.rest;
  }

  std::vector<BodyState> states(WorldId world) const override { return at(world).states(); }
  std::vector<bool> asleep(WorldId world) const override { return at(world).asleep(); }
  std::vector<ContactForce> contact_forces(WorldId world) const override { return at(world).contact_forces(); }
  std::optional<WorstContact> take_worst_contact(WorldId world) override { return at(world).take_worst_contact(); }
  double step_size() const override { return settings_.time_step; }
  std::uint64_t steps(WorldId world) const override { return at(world).counters().steps; }
  const Profile& profile() const override { return profile_; }
  std::vector<Flag> flags(WorldId world) const override { return at(world).flags(); }
  std::string name() const override { return "bullet"; }
  std::string device() const override { return "cpu"; }

 private:
  bullet::World& at(WorldId world) const { return *worlds_.at(world); }

  bullet::PartShapePtr shape(const PartModelPtr& part, double scale) {
    auto& known = shapes_[{part, scale}];
    if (!known) {
      known = std::make_shared<const bullet::PartShape>(bullet::part_shape(*part, settings_, scale));
      profile_.count("bullet_shapes");
    }
    return known;
  }

  BulletSettings settings_;
  std::map<WorldId, std::unique_ptr<bullet::World>> worlds_;
  std::map<std::pair<PartModelPtr, double>, bullet::PartShapePtr> shapes_;  ///< keeps the models alive; look-up only
  WorldId next_ = 0;
  Profile profile_;
};

}  // namespace

std::unique_ptr<Solver> make_bullet_solver(const BulletSettings& settings) {
  return std::make_unique<BulletSolver>(settings);
}

}  // namespace bin_scenes
