/// Keeps the host's copy of each world, sends what changed, and observes results when the device is done. CPU form:
/// src/solver/sphere/sphere_solver.cpp.
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/shapes/shape_cache.hpp"
#include "solver/sphere_gl/capacity.hpp"
#include "solver/sphere_gl/resident.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace bin_scenes {

namespace {

using namespace sphere_gl;

constexpr int most_unread = 64;  ///< stretches of steps: then counters are taken before they overflow

class GlSphereSolver final : public Solver, private WorldWatch {
 public:
  GlSphereSolver(std::shared_ptr<gl::Device> device, const SphereSettings& settings, const Capacity& capacity)
      : device_(std::move(device)),
        settings_(settings),
        software_(is_software(capacity, *device_)),
        at_once_(
            sphere_gl::worlds_at_once(capacity, static_cast<std::size_t>(device_->limits().storage_bytes), software_)),
        most_bodies_(most_bodies(capacity, *device_)),
        shapes_(settings),
        batch_(capacity) {}
  ~GlSphereSolver() override { device_->try_make_current(); }

  void check(const WorldDef& def) const override {
    check_bodies(def.bodies.size() + (def.bin.kind == Bin::Kind::mesh ? 1 : 0), most_bodies_, *device_);
  }

  WorldId add_world(const WorldDef& def) override {
    check(def);
    device_->make_current();
    const gl::TrafficCount count(profile_);
    Resident r;
    r.bodies = def.bodies.size();
    r.world = sphere::make_world(def, settings_, [this](const PartModelPtr& part) -> const sphere::Shape& {
      return shapes_.of(part, profile_);
    });
    if (software_) r.world.settings.most_impact_sweeps = r.world.settings.sharing_sweeps;  // it ends longer loops
    r.slot = batch_.add(r.world, r.progress);
    r.marks.resize(r.world.bodies.size());
    r.watched_bodies.resize(r.bodies);
    set_phase_of(r);
    worlds_.emplace(next_, std::move(r));
    return next_++;
  }

  void remove_world(WorldId id) override {
    const auto has_it = [id](const Flight& f) { return std::find(f.ids.begin(), f.ids.end(), id) != f.ids.end(); };
    flights_.erase(std::remove_if(flights_.begin(), flights_.end(), has_it), flights_.end());
    batch_.remove(world(id).slot);
    worlds_.erase(id);
  }

  void insert(WorldId id, std::size_t body, const BodyState& state) override {
    Resident& r = world(id);
    sphere::place(r.world, body, state);
    r.changed.insert(body);
  }

  void remove(WorldId id, std::size_t body) override {
    Resident& r = known(id);
    for (const std::uint32_t other : touched(r.world, body)) wake(r, other);
    wake(r, static_cast<std::uint32_t>(body));
    r.world.bodies[body].present = false;
    r.changed.insert(body);
  }

  bool set_phase(WorldId id, const Phase& phase) override {
    Resident& r = known(id);
    const bool fine = r.world.fine;
    if (!sphere::take_phase(r.world, phase)) return true;
    if (r.world.fine != fine || phase.forgets) r.progress.refresh = 1;  // as set_phase() in make_world.cpp
    set_phase_of(r);
    for (std::size_t i = 0; i < r.world.bodies.size(); ++i) {
      if (phase.begins_asleep)
        sphere::put_to_sleep(r.world.settings, r.world.bodies[i]);
      else
        sphere::wake(r.world.bodies[i]);
      if (r.world.bodies[i].present) r.changed.insert(i);
    }
    return true;
  }

  double advance(const std::vector<WorldId>& ids, double seconds) override {
    const double simulated = begin(ids, seconds);
    finish(ids);
    return simulated;
  }

  double begin(const std::vector<WorldId>& ids, double seconds) override {
    device_->make_current();
    const gl::TrafficCount count(profile_);
    const Steps steps = steps_in(seconds, settings_.time_step);
    if (steps.count() == 0) return 0.0;
    Flight flight;
    flight.ids = ids;
    flight.back = spare_back();
    const auto rest = static_cast<float>(steps.rest / settings_.time_step);
    if (steps.whole > 0) {
      flight.rest = rest;
      start(flight, steps.whole, 1.0f, rest == 0.0f);
    } else {
      start(flight, 1, rest, true);
    }
    flights_.push_back(std::move(flight));
    return static_cast<double>(steps.whole) * settings_.time_step + steps.rest;
  }

  void finish(const std::vector<WorldId>& ids) override {
    device_->make_current();
    const gl::TrafficCount count(profile_);
    Flight flight = take_flight(ids);
    if (flight.ids.empty()) return;
    go_on(flight);
    if (flight.rest > 0.0f) {
      start(flight, 1, std::exchange(flight.rest, 0.0f), true);
      go_on(flight);
    }
    end(flight);
  }

  void begin_some(const std::vector<WorldId>& ids, double seconds) override {
    device_->make_current();
    const gl::TrafficCount count(profile_);
    const Steps steps = steps_in(seconds, settings_.time_step);
    BIN_SCENES_ASSERT(steps.whole > 0 && steps.rest == 0.0);
    Flight flight;
    flight.ids = ids;
    flight.back = spare_back();
    flight.most = 0;
    for (const WorldId id : ids)
      flight.most = std::max(flight.most, steps.whole * static_cast<std::uint64_t>(world(id).world.cuts));
    start(flight, steps.whole, 1.0f, true);
    flights_.push_back(std::move(flight));
  }

  void finish_some(const std::vector<WorldId>& ids) override {
    device_->make_current();
    const gl::TrafficCount count(profile_);
    Flight flight = take_flight(ids);
    observe(flight);
    end(flight);
  }

  bool under_way(WorldId id) const override { return world(id).left > 0; }

  bool works_aside() const override { return true; }

  std::vector<BodyState> states(WorldId id) const override {
    const Resident& r = known(id);
    std::vector<BodyState> out;
    for (std::size_t i = 0; i < r.bodies; ++i) out.push_back(sphere::state_of(r.world, i));
    return out;
  }

  std::vector<bool> asleep(WorldId id) const override {
    const Resident& r = known(id);
    std::vector<bool> out(r.bodies);
    for (std::size_t i = 0; i < r.bodies; ++i) out[i] = r.world.bodies[i].asleep;
    return out;
  }

  std::vector<ContactForce> contact_forces(WorldId id) const override {
    const Resident& r = known(id);
    device_->make_current();
    sphere::World now = r.world;
    batch_.download(r.slot, now);
    return sphere::forces_of(now, r.bodies);
  }

  std::optional<WorstContact> take_worst_contact(WorldId id) override {
    Resident& r = known(id);
    const gpu::SphereWorst worst = std::exchange(r.worst, {});
    r.worst_taken = r.worst_taken || worst.relative > 0 || worst.unresolved > 0;
    if (worst.relative <= 0) return WorstContact{-1, -1, 0, 0, 0, worst.unresolved};
    const auto named = [&](gpu::uint body) { return body < r.bodies ? static_cast<int>(body) : -1; };
    return WorstContact{named(worst.a), named(worst.b), worst.depth, worst.relative, worst.ago, worst.unresolved};
  }

  WorldWatch* watch() override { return this; }

  std::size_t worlds_at_once() const override { return at_once_; }
  double step_size() const override { return settings_.time_step; }
  std::uint64_t steps(WorldId id) const override { return world(id).steps; }
  std::vector<Flag> flags(WorldId id) const override { return sphere::flags_of(world(id).world); }
  std::string name() const override { return "sphere"; }
  std::string device() const override { return device_->renderer(); }

  const Profile& profile() const override {
    batch_.timer().collect(profile_, true);
    shown_ = profile_;
    shown_.count("gl_bytes_held", batch_.bytes());
    shown_.count("gl_bytes_shared", batch_.bytes_shared());
    return shown_;
  }

 private:
  Resident& world(WorldId id) const { return worlds_.at(id); }
  /// As it is now: read from the device if it was not.
  Resident& known(WorldId id) const {
    Resident& r = world(id);
    if (!r.known) read_now({&r});
    return r;
  }

  void set_rules(WorldId id, const WatchRules& rules) override {
    Resident& r = world(id);
    r.watched = true;
    sphere_gl::set_rules(r.ask, rules);
  }
  void enter(WorldId id, std::size_t body) override {
    world(id).marks[body].enters = true;
    world(id).changed.insert(body);
  }
  void ask(WorldId id, const WatchAsk& ask) override {
    Resident& r = world(id);
    r.wants_states = ask.states;
    set_ask(r.ask, ask);
  }
  const WatchSeen& seen(WorldId id) const override { return world(id).seen; }
  void read(const std::vector<WorldId>& ids) override {
    const gl::TrafficCount count(profile_);
    std::vector<Resident*> unknown;
    for (const WorldId id : ids)
      if (!world(id).known) unknown.push_back(&world(id));
    read_now(unknown);
  }
  const std::vector<WatchedBody>& bodies(WorldId id) const override { return known(id).watched_bodies; }
  WatchedEnergy energy(WorldId id) const override { return energy_of(known(id).audit); }

  void read_now(const std::vector<Resident*>& residents) const {
    if (residents.empty()) return;
    device_->make_current();
    std::vector<Batch::Slot> slots;
    for (const Resident* r : residents) slots.push_back(r->slot);
    gl::ReadBack back;
    batch_.request({}, slots, back);
    read_residents(back.wait(), residents, profile_);
  }

  /// How its world's contacts are to be solved.
  void set_phase_of(Resident& r) const {
    if (software_) r.world.effort = 1;  // software_group_bodies
    copy_phase(r.world, r.progress);
    r.progress_changed = true;
  }

  static void wake(Resident& r, std::size_t body) {
    sphere::Body& b = r.world.bodies[body];
    if (!b.present) return;
    sphere::wake(b);
    r.changed.insert(body);
  }

  /// The one that was begun with these worlds; without worlds if there is none.
  Flight take_flight(const std::vector<WorldId>& ids) {
    const auto at = std::find_if(flights_.begin(), flights_.end(), [&](const Flight& f) { return f.ids == ids; });
    if (at == flights_.end()) return {};
    Flight flight = std::move(*at);
    flights_.erase(at);
    return flight;
  }

  void end(Flight& flight) {
    spare_.push_back(std::move(flight.back));
    batch_.timer().collect(profile_);
  }

  std::unique_ptr<gl::ReadBack> spare_back() {
    if (spare_.empty()) return std::make_unique<gl::ReadBack>();
    std::unique_ptr<gl::ReadBack> back = std::move(spare_.back());
    spare_.pop_back();
    return back;
  }

  /// Worlds that are under way go on.
  /// @param ends  no steps follow these
  void start(Flight& flight, std::uint64_t steps, float share, bool ends) {
    flight.share = share;
    flight.running = flight.ids;
    std::uint64_t most = 0;
    std::vector<Batch::Slot> begins;
    std::vector<std::pair<Batch::Slot, gpu::SphereAsk>> asks;
    for (const WorldId id : flight.ids) {
      Resident& r = world(id);
      most = std::max(most, r.left);
      if (r.left > 0) continue;
      begins.push_back(r.slot);
      upload_changes(batch_, r);
      const std::uint64_t own = steps * static_cast<std::uint64_t>(r.world.cuts);
      r.left = own * r.cuts;
      most = std::max(most, r.left);
      r.steps += own;
      asks.emplace_back(r.slot, r.ask);
      asks.back().second.steps = static_cast<gpu::uint>(own);
      if (!ends) asks.back().second.observation = 0;
      if (std::exchange(r.counted, false)) asks.back().second.flags |= SPHERE_COUNTED;
      r.ask.flags = 0;  // what begins anew has begun
      if (ends) r.ask.observation = 0;
    }
    upload_progress(flight);
    const bool all = begins.size() == flight.ids.size();
    batch_.upload_asks(std::move(asks));
    if (!all && !begins.empty()) {
      batch_.run(begins, flight.share);
      batch_.begin_watch();
    }
    run(flight);
    if (all) batch_.begin_watch();
    issue(flight, most);
  }

  /// Until no steps are left.
  void go_on(Flight& flight) {
    while (const std::uint64_t left = observe(flight)) {
      run(flight);
      issue(flight, left);
    }
  }

  void run(Flight& flight) {
    flight.slots.clear();
    std::vector<const Resident*> residents;
    for (const WorldId id : flight.running) {
      residents.push_back(&world(id));
      flight.slots.push_back(residents.back()->slot);
    }
    batch_.run(longest_first(residents), flight.share);
  }

  void issue(Flight& flight, std::uint64_t left) {
    const std::uint64_t steps = std::min(left, flight.most);
    for (std::uint64_t k = 0; k < steps; ++k) batch_.step();
    batch_.watch_rest();
    batch_.audit_energy();
    std::vector<Batch::Slot> read;
    flight.read.clear();
    for (const WorldId id : flight.running) {
      const Resident& r = world(id);
      const bool last = r.left <= steps && flight.rest == 0.0f;
      if (!last || (r.watched && !r.wants_states && r.unread < most_unread)) continue;
      flight.read.push_back(id);
      read.push_back(r.slot);
    }
    batch_.request(flight.slots, read, *flight.back);
  }

  /// Waits for what the steps left behind, takes what worlds without further steps have shown, makes room where it was
  /// asked for, and returns how many dispatches the other worlds need.
  std::uint64_t observe(Flight& flight) {
    const auto* seen = static_cast<const gpu::SphereSeen*>(flight.back->wait());
    profile_.count("observations");
    std::uint64_t most = 0;
    bool blocked = false;
    std::vector<WorldId> running;
    for (const WorldId id : flight.running) {
      Resident& r = world(id);
      r.left = seen->left & 0xffffffu;
      r.cuts = std::max(1u, seen->left >> 24 & 0x7fu);
      blocked = blocked || (seen->left & SPHERE_BLOCKED) != 0;
      most = std::max(most, r.left);
      if (r.left > 0) running.push_back(id);
      if (r.left == 0 && flight.rest == 0.0f) take(r, *seen);
      ++seen;
    }
    std::vector<Resident*> read;
    for (const WorldId id : flight.read) read.push_back(&world(id));
    read_residents(seen, read, profile_);
    for (Resident* r : read) r->seen.states = r->left == 0;
    flight.running = std::move(running);
    if (blocked) make_room(flight);
    return most;
  }

  static void take(Resident& r, const gpu::SphereSeen& seen) {
    r.seen = seen_of(seen);
    r.known = false;
    ++r.unread;
  }

  /// Of worlds some of which wait for room.
  void make_room(const Flight& flight) {
    std::vector<Batch::Slot> slots;
    for (const WorldId id : flight.running) slots.push_back(world(id).slot);
    gl::ReadBack back;
    batch_.request_progress(slots, back);
    const auto* now = static_cast<const gpu::SphereProgress*>(back.wait());
    gpu::uint samples = 0, candidates = 0;
    for (const WorldId id : flight.running) {
      Resident& r = world(id);
      r.progress = *now++;
      take_counters(r.progress, profile_);
      if (r.progress.overflow) profile_.count("steps_repeated");
      make_room_for(batch_, r, samples, candidates);
    }
    if (samples + candidates > 0) batch_.grow_candidates(samples, candidates);
    upload_progress(flight);
  }

  void upload_progress(const Flight& flight) {
    std::vector<std::pair<Batch::Slot, gpu::SphereProgress>> worlds;
    for (const WorldId id : flight.running) {
      Resident& r = world(id);
      if (std::exchange(r.progress_changed, false)) worlds.emplace_back(r.slot, r.progress);
    }
    batch_.upload_progress(std::move(worlds));
  }

  std::shared_ptr<gl::Device> device_;  ///< first: what is on it goes before it
  SphereSettings settings_;
  bool software_;        ///< and used like one
  std::size_t at_once_;  ///< worlds
  std::size_t most_bodies_;
  sphere::ShapeCache shapes_;
  mutable Batch batch_;
  mutable std::map<WorldId, Resident> worlds_;
  std::vector<Flight> flights_;
  std::vector<std::unique_ptr<gl::ReadBack>> spare_;
  WorldId next_ = 0;
  mutable Profile profile_;
  mutable Profile shown_;
};

}  // namespace

std::size_t most_gl_bodies() {
  return SPHERE_MAX_BODIES;
}

std::unique_ptr<Solver> make_gl_sphere_solver(const SphereSettings& settings, const Capacity& capacity) {
  if (!(settings.time_step > 0))
    throw input_error("time_step must be above 0", "solver.sphere.time_step", "0.0025 is a good start");
  constexpr int blocks = 15;  // of collect_samples, the most of all passes; OpenGL 4.5 promises 8
  const std::shared_ptr<gl::Device> device = gl::Device::shared();
  device->make_current();
  if (device->limits().storage_blocks < blocks) {
    throw environment_error("the device has " + std::to_string(device->limits().storage_blocks) +
                                " storage blocks a shader, the solver needs " + std::to_string(blocks),
                            device->renderer(), "use solver.sphere.device: cpu");
  }
  check_bodies(capacity.bodies, most_bodies(capacity, *device), *device);  // before shaders are compiled
  return std::make_unique<GlSphereSolver>(device, settings, capacity);
}

}  // namespace bin_scenes
