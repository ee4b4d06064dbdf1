/// A world of Bullet for each world of this project, with Bullet's own solver, sleeping and margins. Nothing is scaled
/// or tuned.
#include "peers/stock_bullet.hpp"

#include "peers/bullet_part.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace bin_scenes::bench {

namespace {

constexpr double wall = 0.2;  ///< m, thickness of floor and walls

Vec3 from_bt(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Bodies that parts are come behind the fixed ones, which the walls are.
class World : BulletWorld {
 public:
  World(const WorldDef& def, const StockBullet& settings)
      : BulletWorld(def.gravity, settings.iterations), def_(def), damping_(settings.damping) {
    for (std::size_t p = 0; p < def.parts.size(); ++p) {
      parts_.push_back(std::make_unique<BulletPart>(*def.parts[p], settings.pieces[p], settings.margin));
      const double radius = settings.balls.empty() ? 0.0 : settings.balls[p];
      balls_.push_back(radius > 0.0 ? std::make_unique<btSphereShape>(radius) : nullptr);
      if (balls_.back()) balls_.back()->calculateLocalInertia(1.0, parts_.back()->inertia);
    }
    add_walls();
    walls_ = bodies.size();
    bodies.resize(walls_ + def.bodies.size());
  }
  ~World() { clear(); }

  void insert(std::size_t b, const BodyState& state) {
    const BodyDef& def = def_.bodies[b];
    BulletPart& part = *parts_[def.part];
    const btTransform pose = to_bt(state.pose) * part.principal;
    std::unique_ptr<btRigidBody>& body = bodies[walls_ + b];
    const bool fresh = !body;
    if (fresh) {
      const double mass = def.fixed ? 0.0 : def.mass;
      btCollisionShape* shape = &part.compound;
      if (balls_[def.part]) shape = balls_[def.part].get();
      btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, part.inertia * mass);
      info.m_friction = def.friction;
      info.m_restitution = def.restitution;
      info.m_linearDamping = info.m_angularDamping = damping_;
      body = std::make_unique<btRigidBody>(info);
    }
    body->setCenterOfMassTransform(pose);
    body->setInterpolationWorldTransform(pose);
    body->setLinearVelocity(to_bt(state.velocity.linear));
    body->setAngularVelocity(to_bt(state.velocity.angular));
    if (fresh)
      world.addRigidBody(body.get());
    else
      body->activate();  // its contacts stay: a push each step is no new start
  }
  void remove(std::size_t b) {
    world.removeRigidBody(bodies[walls_ + b].get());
    bodies[walls_ + b].reset();
  }
  void step(double dt) { world.stepSimulation(dt, 0, dt); }
  bool has(std::size_t b) const { return bodies[walls_ + b] != nullptr; }
  BodyState state(std::size_t b) const {
    const btRigidBody& body = *bodies[walls_ + b];
    const btTransform pose = body.getWorldTransform() * parts_[def_.bodies[b].part]->principal.inverse();
    const btQuaternion q = pose.getRotation();
    BodyState state;
    state.pose.position = from_bt(pose.getOrigin());
    state.pose.orientation = Quat(q.w(), q.x(), q.y(), q.z()).normalized();
    state.velocity = {from_bt(body.getLinearVelocity()), from_bt(body.getAngularVelocity())};
    return state;
  }
  /// Of the body that moves most; one that is not in yet moves.
  BulletRest rest() const {
    BulletRest least = BulletRest::asleep;
    for (std::size_t b = 0; b < def_.bodies.size() && least != BulletRest::moves; ++b)
      least = has(b) ? std::min(least, rest_of(*bodies[walls_ + b])) : BulletRest::moves;
    return least;
  }

 private:
  /// Asleep is any body that has been slow for 2 s, whether or not all of its island has.
  static BulletRest rest_of(btRigidBody& body) {
    if (body.wantsSleeping()) return BulletRest::asleep;
    const bool slow = body.getLinearVelocity().length() < body.getLinearSleepingThreshold() &&
                      body.getAngularVelocity().length() < body.getAngularSleepingThreshold();
    return slow ? BulletRest::slow : BulletRest::moves;
  }
  void add_wall(std::unique_ptr<btCollisionShape> shape, const Vec3& center) {
    add_fixed(std::move(shape), center, def_.bin.friction, def_.bin.restitution);
  }
  void add_box(const Vec3& lower, const Vec3& upper) {
    add_wall(std::make_unique<btBoxShape>(to_bt(Vec3(0.5 * (upper - lower)))), 0.5 * (lower + upper));
  }
  void add_walls() {
    if (def_.bin.kind == Bin::Kind::none) return;
    if (def_.bin.kind == Bin::Kind::floor) {
      add_wall(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0), Vec3::Zero());
      return;
    }
    const Vec3 half = 0.5 * def_.bin.inner_size, out = half + Vec3(wall, wall, 0);
    const double height = def_.wall_height;
    add_box({-out.x(), -out.y(), -wall}, {out.x(), out.y(), 0});
    if (def_.bin.kind != Bin::Kind::box) return;
    add_box({half.x(), -out.y(), 0}, {out.x(), out.y(), height});
    add_box({-out.x(), -out.y(), 0}, {-half.x(), out.y(), height});
    add_box({-out.x(), half.y(), 0}, {out.x(), out.y(), height});
    add_box({-out.x(), -out.y(), 0}, {out.x(), -half.y(), height});
  }

  const WorldDef def_;
  double damping_;
  std::vector<std::unique_ptr<BulletPart>> parts_;
  std::vector<std::unique_ptr<btSphereShape>> balls_;  ///< by part; none for what is no ball
  std::size_t walls_ = 0;                              ///< bodies that are walls
};

class StockBulletSolver final : public Solver {
 public:
  explicit StockBulletSolver(const StockBullet& settings) : settings_(settings) {}

  WorldId add_world(const WorldDef& def) override {
    Slot& slot = slots_[next_];
    slot.world = std::make_unique<World>(def, settings_);
    slot.last.resize(def.bodies.size());
    for (BodyState& state : slot.last) state.pose.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    return next_++;
  }
  void remove_world(WorldId world) override { slots_.erase(world); }
  void insert(WorldId world, std::size_t body, const BodyState& state) override {
    slots_.at(world).world->insert(body, state);
  }
  void remove(WorldId world, std::size_t body) override {
    Slot& slot = slots_.at(world);
    slot.last[body] = slot.world->state(body);
    slot.world->remove(body);
  }
  bool set_phase(WorldId, const Phase&) override { return false; }
  double advance(const std::vector<WorldId>& worlds, double seconds) override {
    StageTimer timer(profile_, "step");
    const Steps steps = steps_in(seconds, settings_.time_step);
    for (const WorldId id : worlds) {
      Slot& slot = slots_.at(id);
      const auto step = [&](double length) {
        slot.world->step(length);
        slot.time += length;
        ++slot.steps;
        if (settings_.watch) settings_.watch(slot.time, slot.world->rest());
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
      if (slot.world->has(b)) out[b] = slot.world->state(b);
    return out;
  }
  std::vector<bool> asleep(WorldId world) const override {
    return std::vector<bool>(slots_.at(world).last.size(), false);
  }
  double step_size() const override { return settings_.time_step; }
  std::uint64_t steps(WorldId world) const override { return slots_.at(world).steps; }
  const Profile& profile() const override { return profile_; }
  std::vector<Flag> flags(WorldId) const override { return {}; }
  std::string name() const override { return "bullet_stock"; }
  std::string device() const override { return "cpu"; }

 private:
  struct Slot {
    std::unique_ptr<World> world;
    std::vector<BodyState> last;  ///< of bodies that are not in
    std::uint64_t steps = 0;
    double time = 0.0;  ///< s
  };
  StockBullet settings_;
  std::map<WorldId, Slot> slots_;
  WorldId next_ = 0;
  Profile profile_;
};

}  // namespace

std::unique_ptr<Solver> make_stock_bullet(const StockBullet& settings) {
  return std::make_unique<StockBulletSolver>(settings);
}

}  // namespace bin_scenes::bench
