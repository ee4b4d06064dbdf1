/// Keeps the host's copy of each world, sends what changed, and observes results when the device is done. CPU form:
/// src/solver/sphere/sphere_solver.cpp.
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/traffic.hpp"
#include "solver/sphere/make_world.hpp"
#include "solver/sphere/shapes/shape_cache.hpp"
#include "solver/sphere_gl/batch.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace bin_scenes {

namespace {

using namespace sphere_gl;

constexpr std::uint64_t steps_per_observation = 16;  ///< a world without room waits no longer than these for the host

/// What the host knows of a world: where it stood when the steps that were begun last were finished, but for the bodies
/// changed since.
struct Resident {
  sphere::World world;
  std::size_t bodies = 0;  ///< of the caller; a mesh bin adds one more behind them
  Batch::Slot slot = 0;
  gpu::SphereProgress progress{};
  gpu::SphereWorst worst{};       ///< of the steps that were finished last, since it was taken
  bool worst_taken = false;       ///< since then: the device is to forget it
  std::set<std::size_t> changed;  ///< bodies to upload
  std::uint64_t steps = 0;
};

/// Worlds whose steps were issued and not observed yet.
struct Flight {
  std::vector<WorldId> ids;
  std::vector<Batch::Slot> slots;
  std::unique_ptr<gl::ReadBack> back;
  float share = 1.0f;  ///< of a whole step that each of the steps is
  float rest = 0.0f;   ///< the same of a last one that is yet to come; 0: none
};

/// Whether it is a software device that is also used like one.
bool is_software(const Capacity& capacity, const gl::Device& device) {
  return device.software() && !capacity.as_on_card;
}

/// Bodies of a world that a work group of the device can hold.
std::size_t most_bodies(const Capacity& capacity, const gl::Device& device) {
  if (capacity.group_bodies > 0) return std::min<std::size_t>(capacity.group_bodies, SPHERE_MAX_BODIES);
  return is_software(capacity, device) ? software_group_bodies : SPHERE_MAX_BODIES;
}

/// Throws for a world of more bodies than that.
void check_bodies(std::size_t bodies, std::size_t most, const gl::Device& device) {
  if (bodies <= most) return;
  throw input_error("on " + device.renderer() + " the sphere solver takes at most " + std::to_string(most) +
                        " bodies per scene, a mesh bin counted; this scene has " + std::to_string(bodies),
                    "solver.sphere.device", "set solver.sphere.device: cpu");
}

class GlSphereSolver final : public Solver {
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
    report(r);
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
    Resident& r = world(id);
    for (const std::uint32_t other : touched(r.world, body)) wake(r, other);
    wake(r, static_cast<std::uint32_t>(body));
    r.world.bodies[body].present = false;
    r.changed.insert(body);
  }

  bool set_phase(WorldId id, const Phase& phase) override {
    Resident& r = world(id);
    const bool fine = r.world.fine;
    if (!sphere::take_phase(r.world, phase)) return true;
    if (r.world.fine != fine || phase.forgets) r.progress.refresh = 1;  // as set_phase() in make_world.cpp
    report(r);
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
      start(flight, steps.whole, 1.0f);
    } else {
      start(flight, 1, rest);
    }
    flights_.push_back(std::move(flight));
    return static_cast<double>(steps.whole) * settings_.time_step + steps.rest;
  }

  void finish(const std::vector<WorldId>& ids) override {
    device_->make_current();
    const gl::TrafficCount count(profile_);
    const auto at = std::find_if(flights_.begin(), flights_.end(), [&](const Flight& f) { return f.ids == ids; });
    if (at == flights_.end()) return;
    Flight flight = std::move(*at);
    flights_.erase(at);
    while (const std::uint64_t left = observe(flight)) issue(flight, left);
    if (flight.rest > 0.0f) {
      start(flight, 1, flight.rest);
      while (const std::uint64_t left = observe(flight)) issue(flight, left);
    }
    read_states(flight);
    spare_.push_back(std::move(flight.back));
    batch_.timer().collect(profile_);
  }

  bool works_aside() const override { return true; }

  std::vector<BodyState> states(WorldId id) const override {
    const Resident& r = world(id);
    std::vector<BodyState> out;
    for (std::size_t i = 0; i < r.bodies; ++i) out.push_back(sphere::state_of(r.world, i));
    return out;
  }

  std::vector<bool> asleep(WorldId id) const override {
    const Resident& r = world(id);
    std::vector<bool> out(r.bodies);
    for (std::size_t i = 0; i < r.bodies; ++i) out[i] = r.world.bodies[i].asleep;
    return out;
  }

  std::vector<ContactForce> contact_forces(WorldId id) const override {
    const Resident& r = world(id);
    device_->make_current();
    sphere::World now = r.world;
    batch_.download(r.slot, now);
    return sphere::forces_of(now, r.bodies);
  }

  std::optional<WorstContact> take_worst_contact(WorldId id) override {
    Resident& r = world(id);
    const gpu::SphereWorst worst = std::exchange(r.worst, {});
    r.worst_taken = r.worst_taken || worst.relative > 0;
    if (worst.relative <= 0) return WorstContact();
    const auto named = [&](gpu::uint body) { return body < r.bodies ? static_cast<int>(body) : -1; };
    return WorstContact{named(worst.a), named(worst.b), worst.depth, worst.relative, worst.ago, 0};
  }

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

  /// How its world's contacts are to be solved.
  void report(Resident& r) const {
    if (software_) r.world.effort = 1;  // software_group_bodies
    tell_phase(r.world, r.progress);
  }

  /// What has contacts with a body: found anew by the passes on the CPU, for which all others sleep.
  static std::vector<std::uint32_t> touched(sphere::World world, std::size_t body) {
    for (sphere::Body& b : world.bodies) sphere::put_to_sleep(world.settings, b);
    sphere::wake(world.bodies[body]);
    if (world.bodies[body].inverse_mass == 0) world.bodies[body].inverse_mass = 1;
    sphere::find_pairs(world);
    sphere::find_contacts(world);
    return sphere::touched_by(world, static_cast<std::uint32_t>(body));
  }

  static void wake(Resident& r, std::size_t body) {
    sphere::Body& b = r.world.bodies[body];
    if (!b.present) return;
    sphere::wake(b);
    r.changed.insert(body);
  }

  std::unique_ptr<gl::ReadBack> spare_back() {
    if (spare_.empty()) return std::make_unique<gl::ReadBack>();
    std::unique_ptr<gl::ReadBack> back = std::move(spare_.back());
    spare_.pop_back();
    return back;
  }

  void start(Flight& flight, std::uint64_t steps, float share) {
    flight.share = share;
    flight.slots.clear();
    std::uint64_t most = 0;
    for (const WorldId id : flight.ids) {
      Resident& r = world(id);
      batch_.upload_states(r.slot, r.world, r.changed);
      r.changed.clear();
      if (std::exchange(r.worst_taken, false)) batch_.forget_worst(r.slot);
      const std::uint64_t own = steps * static_cast<std::uint64_t>(r.world.cuts);
      most = std::max(most, own);
      r.steps += own;
      r.progress.steps_left = static_cast<gpu::uint>(own);
      flight.slots.push_back(r.slot);
    }
    upload_progress(flight);
    issue(flight, most);
  }

  void issue(Flight& flight, std::uint64_t left) {
    batch_.run(flight.slots, flight.share);
    for (std::uint64_t k = 0; k < std::min(left, steps_per_observation); ++k) batch_.step();
    batch_.request(flight.slots, *flight.back);
  }

  /// Waits for what the steps left behind, makes room where it was asked for, and returns how many steps are left.
  std::uint64_t observe(const Flight& flight) {
    const auto* seen = static_cast<const gpu::SphereProgress*>(flight.back->wait());
    std::uint64_t left = 0;
    gpu::uint samples = 0, candidates = 0;
    for (const WorldId id : flight.ids) {
      Resident& r = world(id);
      r.progress = *seen++;
      const gpu::uint overflow = r.progress.overflow;
      count(r.progress);
      r.progress.overflow = 0;
      if (overflow) profile_.count("steps_repeated");
      if (overflow & SPHERE_PAIR_OVERFLOW) batch_.grow_pairs(r.slot, r.progress);
      if (overflow & SPHERE_ROW_OVERFLOW) batch_.grow_rows(r.slot, r.progress.rows);
      if (overflow & SPHERE_SAMPLE_OVERFLOW) samples = std::max(samples, r.progress.need);
      candidates = std::max(candidates, r.progress.need_candidates);
      r.progress.need = r.progress.need_candidates = 0;
      left = std::max<std::uint64_t>(left, r.progress.steps_left);
    }
    if (samples + candidates > 0) batch_.grow_candidates(samples, candidates);
    if (left > 0) upload_progress(flight);  // counters were taken
    return left;
  }

  void upload_progress(const Flight& flight) {
    std::vector<std::pair<Batch::Slot, gpu::SphereProgress>> worlds;
    for (const WorldId id : flight.ids) worlds.emplace_back(world(id).slot, world(id).progress);
    batch_.upload_progress(std::move(worlds));
  }

  /// Moves the counters of a world to the profile.
  void count(gpu::SphereProgress& p) {
    profile_.count("body_steps_in_free_fall", p.free_steps);
    profile_.count("body_steps_asleep", p.asleep_steps);
    profile_.count("pairs", p.pairs_tested);
    profile_.count("pairs_recycled", p.pairs_recycled);
    profile_.count("pairs_asleep", p.pairs_asleep);
    profile_.count("pairs_culled", p.pairs_culled);
    profile_.count("clusters_tested", p.clusters_tested);
    profile_.count("nodes_tested", p.nodes_tested);
    profile_.count("nodes_possible", p.nodes_possible + (std::uint64_t{p.nodes_possible_high} << 32));
    profile_.count("contacts", p.contacts);
    profile_.count("contacts_reduced", p.dropped);
    profile_.count("colors", p.colors);
    profile_.count("coloring_rounds", p.coloring_rounds);
    profile_.count("colorings", p.colorings);
    profile_.count("pair_lists_made", p.lists_made);
    profile_.count("steps", p.steps);
    p.steps = p.free_steps = p.pairs_tested = p.pairs_recycled = p.pairs_asleep = p.clusters_tested = p.nodes_tested =
        p.nodes_possible = p.nodes_possible_high = p.contacts = p.dropped = p.colors = p.coloring_rounds =
            p.asleep_steps = p.pairs_culled = p.lists_made = p.colorings = 0;
  }

  void read_states(const Flight& flight) {
    const auto* progress = static_cast<const gpu::SphereProgress*>(flight.back->wait());
    const auto* worst = reinterpret_cast<const gpu::SphereWorst*>(progress + flight.ids.size());
    const auto* state = reinterpret_cast<const gpu::SphereState*>(worst + flight.ids.size());
    for (const WorldId id : flight.ids) {
      Resident& r = world(id);
      r.worst = *worst++;
      for (std::size_t i = 0; i < r.world.bodies.size(); ++i, ++state) {
        read_state(*state, r.world.bodies[i]);
      }
    }
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

std::size_t sphere_gl::worlds_at_once(const Capacity& capacity, std::size_t storage_bytes, bool software) {
  constexpr double body_bytes = 6000.0;  // on the device, with a share of the common lists: docs/develop/gpu.md
  const double most = software ? 4.0 : 1024.0;
  const double bodies = static_cast<double>(std::max<std::size_t>(capacity.bodies, 1));
  const double largest_list =
      static_cast<double>(capacity.pairs * SPHERE_MAX_CONTACTS * sizeof(gpu::SphereContact)) * bodies;
  const double fit = std::min(
      {most, capacity.memory / (body_bytes * bodies), 0.5 * static_cast<double>(storage_bytes) / largest_list});
  return static_cast<std::size_t>(std::max(1.0, fit));
}

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
