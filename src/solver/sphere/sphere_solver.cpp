#include "solver/sphere/sphere_solver.hpp"

#include "bin_scenes/core/error.hpp"
#include "solver/sphere/world.hpp"

#include <algorithm>
#include <map>
#include <thread>

namespace bin_scenes {

namespace {

using namespace sphere;

/// A world with the shapes it points into and the frame of its poses.
struct Slot {
  World world;
  std::vector<std::size_t> part_of_shape;
  bool used = false;
  std::size_t bodies = 0;  ///< of the caller; a mesh bin adds one more behind them
};

Body make_body(const Shape& shape, std::uint32_t index, const BodyDef& def) {
  Body body;
  body.shape = index;
  body.friction = static_cast<float>(def.friction);
  body.restitution = static_cast<float>(def.restitution);
  body.inverse_mass = def.fixed ? 0.0f : static_cast<float>(1.0 / def.mass);
  body.inertia = shape.unit_inertia * static_cast<float>(def.mass);
  body.inverse_inertia = def.fixed ? Mat3f(Mat3f::Zero()) : Mat3f(body.inertia.inverse());
  return body;
}

std::vector<Plane> planes_of(const Bin& bin) {
  if (bin.kind == Bin::Kind::none || bin.kind == Bin::Kind::mesh) return {};
  std::vector<Plane> planes = {{Vec3f::UnitZ(), 0.0f, false}};
  if (bin.kind == Bin::Kind::floor) return planes;
  const float x = static_cast<float>(0.5 * bin.inner_size.x()), y = static_cast<float>(0.5 * bin.inner_size.y());
  planes.push_back({Vec3f::UnitX(), -x, true});
  planes.push_back({-Vec3f::UnitX(), -x, true});
  planes.push_back({Vec3f::UnitY(), -y, true});
  planes.push_back({-Vec3f::UnitY(), -y, true});
  return planes;
}

class SphereSolver final : public Solver {
 public:
  explicit SphereSolver(const SphereSettings& settings) : settings_(settings) {}

  WorldId add_world(const WorldDef& def) override {
    WorldId id = 0;
    while (id < slots_.size() && slots_[id]->used) ++id;
    if (id == slots_.size()) slots_.push_back(std::make_unique<Slot>());
    Slot& slot = *slots_[id];
    slot = Slot{};
    slot.used = true;
    slot.bodies = def.bodies.size();
    World& w = slot.world;
    w.settings.time_step = static_cast<float>(settings_.time_step);
    w.settings.sub_steps = settings_.sub_steps;
    w.gravity = def.gravity.cast<float>();
    w.wall_top = static_cast<float>(def.wall_height);
    w.ground_friction = static_cast<float>(def.bin.friction);
    w.ground_restitution = static_cast<float>(def.bin.restitution);
    w.planes = planes_of(def.bin);
    for (const PartModelPtr& part : def.parts) w.shapes.push_back(&shape_of(part));
    for (const BodyDef& body : def.bodies)
      w.bodies.push_back(make_body(*w.shapes[body.part], static_cast<std::uint32_t>(body.part), body));
    if (def.bin.kind == Bin::Kind::mesh) add_mesh_bin(slot, def);
    w.smallest_diagonal = std::numeric_limits<float>::max();
    for (const Shape* s : w.shapes) w.smallest_diagonal = std::min(w.smallest_diagonal, s->diagonal);
    return id;
  }

  void remove_world(WorldId id) override {
    collect(slots_[id]->world.counters);
    *slots_[id] = Slot{};
  }

  void insert(WorldId id, std::size_t body, const BodyState& state) override {
    World& w = slots_[id]->world;
    Body& b = w.bodies[body];
    b.q = state.pose.orientation.cast<float>().normalized();
    b.x = state.pose.position.cast<float>() + b.q * w.shapes[b.shape]->center;
    b.v = b.inverse_mass > 0 ? Vec3f(state.velocity.linear.cast<float>()) : Vec3f(Vec3f::Zero());
    b.w = b.inverse_mass > 0 ? Vec3f(state.velocity.angular.cast<float>()) : Vec3f(Vec3f::Zero());
    b.present = true;
    b.asleep = false;
    b.still = 0;
    b.still_x = b.x;
    b.still_q = b.q;
  }

  void remove(WorldId id, std::size_t body) override {
    World& w = slots_[id]->world;
    wake(w, static_cast<std::uint32_t>(body));
    w.bodies[body].present = false;
  }

  void set_phase(WorldId id, Phase phase) override {
    World& w = slots_[id]->world;
    const bool fine = phase == Phase::settle;
    if (w.fine == fine) return;
    w.fine = fine;
    for (Manifold& m : w.manifolds) m.found = false;  // node numbers mean other points now
    for (Body& b : w.bodies) {
      b.asleep = false;
      b.still = 0;
    }
  }

  double advance(const std::vector<WorldId>& worlds, double seconds) override {
    StageTimer timer(profile_, "step");
    const int steps = std::max(1, static_cast<int>(std::lround(seconds / settings_.time_step)));
    // Worlds share nothing, so that threads cannot change a result.
    const std::size_t threads = std::min<std::size_t>(worlds.size(), std::max(1u, std::thread::hardware_concurrency()));
    const auto run = [&](std::size_t first) {
      for (std::size_t i = first; i < worlds.size(); i += threads)
        for (int k = 0; k < steps; ++k) step(slots_[worlds[i]]->world);
    };
    std::vector<std::thread> pool;
    for (std::size_t t = 1; t < threads; ++t) pool.emplace_back(run, t);
    run(0);
    for (std::thread& t : pool) t.join();
    return steps * settings_.time_step;
  }

  std::vector<BodyState> states(WorldId id) const override {
    const Slot& slot = *slots_[id];
    std::vector<BodyState> out(slot.bodies);
    for (std::size_t i = 0; i < slot.bodies; ++i) {
      const Body& b = slot.world.bodies[i];
      if (!b.present && b.still_x.isZero()) {
        out[i].pose.position = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      out[i].pose.orientation = b.q.cast<double>().normalized();
      out[i].pose.position =
          b.x.cast<double>() - out[i].pose.orientation * slot.world.shapes[b.shape]->center.cast<double>();
      out[i].velocity = {b.v.cast<double>(), b.w.cast<double>()};
    }
    return out;
  }

  std::vector<bool> asleep(WorldId id) const override {
    const Slot& slot = *slots_[id];
    std::vector<bool> out(slot.bodies);
    for (std::size_t i = 0; i < slot.bodies; ++i) out[i] = slot.world.bodies[i].asleep;
    return out;
  }

  std::size_t worlds_at_once() const override { return std::max(1u, std::thread::hardware_concurrency()); }
  double step_size() const override { return settings_.time_step; }
  std::uint64_t steps(WorldId id) const override { return slots_[id]->world.counters.steps; }
  std::vector<Flag> flags(WorldId) const override { return {}; }
  std::string name() const override { return "sphere"; }
  std::string device() const override { return "cpu"; }

  const Profile& profile() const override {
    shown_ = profile_;
    for (const auto& slot : slots_)
      if (slot->used) add(shown_, slot->world.counters);
    return shown_;
  }

 private:
  const Shape& shape_of(const PartModelPtr& part) {
    auto& entry = shapes_[part.get()];
    if (!entry.shape) {
      StageTimer timer(profile_, "shape");
      entry.part = part;  // keeps the address, and with it the key, alive
      entry.shape = std::make_unique<Shape>(
          make_shape(*part, settings_.coarse_samples, settings_.fine_samples, settings_.field_cell));
    }
    return *entry.shape;
  }

  /// A bin given as a mesh is one more fixed body.
  void add_mesh_bin(Slot& slot, const WorldDef& def) {
    World& w = slot.world;
    const auto index = static_cast<std::uint32_t>(w.shapes.size());
    w.shapes.push_back(&shape_of(def.bin_model));
    BodyDef bin;
    bin.fixed = true;
    bin.friction = def.bin.friction;
    bin.restitution = def.bin.restitution;
    w.bodies.push_back(make_body(*w.shapes[index], index, bin));
    insert_fixed(w, w.bodies.back(), def.bin.pose);
  }

  static void insert_fixed(World& w, Body& b, const Pose& pose) {
    b.q = pose.orientation.cast<float>().normalized();
    b.x = pose.position.cast<float>() + b.q * w.shapes[b.shape]->center;
    b.present = true;
  }

  static void add(Profile& p, const Counters& c) {
    p.count("steps", c.steps);
    p.count("body_steps_in_free_fall", c.free_steps);
    p.count("pairs", c.pairs);
    p.count("pairs_recycled", c.pairs_recycled);
    p.count("pairs_asleep", c.pairs_asleep);
    p.count("groups_tested", c.groups_tested);
    p.count("clusters_tested", c.clusters_tested);
    p.count("nodes_tested", c.nodes_tested);
    p.count("nodes_possible", c.nodes_possible);
    p.count("contacts", c.contacts);
    p.count("contacts_reduced", c.dropped);
  }
  void collect(const Counters& c) { add(profile_, c); }

  struct Entry {
    PartModelPtr part;
    std::unique_ptr<Shape> shape;
  };
  SphereSettings settings_;
  std::map<const PartModel*, Entry> shapes_;
  std::vector<std::unique_ptr<Slot>> slots_;
  Profile profile_;
  mutable Profile shown_;
};

}  // namespace

std::unique_ptr<Solver> make_sphere_solver(const SphereSettings& settings) {
  if (!(settings.time_step > 0))
    throw input_error("time_step must be above 0", "solver.sphere.time_step", "0.0025 is a good start");
  return std::make_unique<SphereSolver>(settings);
}

}  // namespace bin_scenes
