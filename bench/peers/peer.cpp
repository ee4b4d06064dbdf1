#include "peers/peer.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace bin_scenes::bench {

namespace {

class PeerSolver final : public Solver {
 public:
  explicit PeerSolver(const PeerSettings& settings) : settings_(settings) {}

  WorldId add_world(const WorldDef& def) override {
    Slot& slot = slots_[next_];
    slot.def = def;
    slot.in.assign(def.bodies.size(), false);
    slot.last.resize(def.bodies.size());
    for (BodyState& state : slot.last) state.pose.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (settings_.engine == "bullet_stock") slot.world = make_bullet_world(slot.def, settings_);
#ifdef BIN_SCENES_BENCH_ODE
    if (settings_.engine == "ode") slot.world = make_ode_world(slot.def, settings_);
#endif
#ifdef BIN_SCENES_BENCH_DART
    if (settings_.engine == "dart") slot.world = make_dart_world(slot.def, settings_);
#endif
    return next_++;
  }
  void remove_world(WorldId world) override {
    slots_.erase(world);
  }
  void insert(WorldId world, std::size_t body, const BodyState& state) override {
    Slot& slot = slots_.at(world);
    slot.world->insert(body, state);
    slot.in[body] = true;
  }
  void remove(WorldId world, std::size_t body) override {
    Slot& slot = slots_.at(world);
    slot.last[body] = slot.world->state(body);
    slot.world->remove(body);
    slot.in[body] = false;
  }
  bool set_phase(WorldId, const Phase&) override {
    return false;
  }
  double advance(const std::vector<WorldId>& worlds, double seconds) override {
    StageTimer timer(profile_, "step");
    const Steps steps = steps_in(seconds, settings_.time_step);
    for (const WorldId id : worlds) {
      Slot& slot = slots_.at(id);
      const auto step = [&](double length) {
        slot.world->step(length);
        slot.time += length;
        ++slot.steps;
        if (settings_.watch) settings_.watch(slot.time, rest_of(slot));
      };
      for (std::uint64_t k = 0; k < steps.whole; ++k) step(settings_.time_step);
      if (steps.rest > 0.0) step(steps.rest);
    }
    return static_cast<double>(steps.whole) * settings_.time_step + steps.rest;
  }
  std::vector<BodyState> states(WorldId world) const override {
    const Slot& slot = slots_.at(world);
    std::vector<BodyState> out = slot.last;
    for (std::size_t b = 0; b < out.size(); ++b)
      if (slot.in[b]) out[b] = slot.world->state(b);
    return out;
  }
  std::vector<bool> asleep(WorldId world) const override {
    return std::vector<bool>(slots_.at(world).in.size(), false);
  }
  double step_size() const override {
    return settings_.time_step;
  }
  std::uint64_t steps(WorldId world) const override {
    return slots_.at(world).steps;
  }
  const Profile& profile() const override {
    return profile_;
  }
  std::vector<Flag> flags(WorldId) const override {
    return {};
  }
  std::string name() const override {
    return settings_.engine;
  }
  std::string device() const override {
    return "cpu";
  }

 private:
  struct Slot;
  static PeerRest rest_of(const Slot& slot) {
    PeerRest least = PeerRest::asleep;
    for (std::size_t b = 0; b < slot.in.size() && least != PeerRest::moves; ++b)
      least = slot.in[b] ? std::min(least, slot.world->rest(b)) : PeerRest::moves;
    return least;
  }
  struct Slot {
    WorldDef def;
    std::unique_ptr<PeerWorld> world;
    std::vector<bool> in;
    std::vector<BodyState> last;
    std::uint64_t steps = 0;
    double time = 0.0;  ///< s
  };
  PeerSettings settings_;
  std::map<WorldId, Slot> slots_;
  WorldId next_ = 0;
  Profile profile_;
};

}  // namespace

std::vector<std::string> peers_built() {
  return {
      "bullet_stock",
#ifdef BIN_SCENES_BENCH_ODE
      "ode",
#endif
#ifdef BIN_SCENES_BENCH_DART
      "dart",
#endif
  };
}

std::unique_ptr<Solver> make_peer(const PeerSettings& settings) {
  const std::vector<std::string> built = peers_built();
  if (std::find(built.begin(), built.end(), settings.engine) == built.end())
    throw input_error("not built", settings.engine, "install lib" + settings.engine + "-dev and configure again");
  return std::make_unique<PeerSolver>(settings);
}

bool is_box(const std::vector<Vec3>& piece, Aabb& box) {
  box = Aabb();
  for (const Vec3& v : piece) box.extend(v);
  const double tolerance = 1e-6 * box.diagonal();
  return piece.size() == 8 && std::all_of(piece.begin(), piece.end(), [&](const Vec3& v) {
           for (int k = 0; k < 3; ++k)
             if (std::min(v[k] - box.lower[k], box.upper[k] - v[k]) > tolerance) return false;
           return true;
         });
}

PeerScale::PeerScale(const WorldDef& def)
    : length(1.0 / def.parts[def.bodies.front().part]->diagonal()), mass(1.0 / def.bodies.front().mass) {}

}  // namespace bin_scenes::bench
