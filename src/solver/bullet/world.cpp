/// Makes Bullet's shapes and bodies from a world's definition, in scaled lengths, and steps them. Bullet wakes whole
/// islands; bodies that sleep one by one are frozen here.
#include "world.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/contact.hpp"

#include "convert.hpp"
#include "core/formatted.hpp"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

extern btScalar gContactBreakingThreshold;  // NOLINT: names of Bullet's
extern btScalar gDeactivationTime;          // NOLINT

namespace bin_scenes::bullet {

namespace {

// Lengths in units of the scaled world: the median part's diagonal is 1.
constexpr double contact_distance = 0.005;
constexpr double step_length = 0.02;   ///< displacement of the fastest part in one cut of a step that has contacts
constexpr int fine_cuts = 16;          ///< no more for the sake of exactness alone
constexpr int most_cuts = 512;         ///< no more for the sake of a part that would pass through another
constexpr double patch_radius = 1e-3;  ///< of the smallest part, as Settings::patch_radius of the sphere solver
constexpr double sleep_speed = 1e-3;   ///< units/s, a quarter of what Pour::rest_move allows by default
constexpr double sleep_turn = 1e-2;    ///< rad/s, likewise of Pour::rest_turn
constexpr double sleep_time = 0.5;     ///< s an island must stay below both
constexpr double going_on = 5e-4;      ///< displacement or turn times radius at which a body wakes what it touches

btScalar geometric_mean(const btCollisionObject* a, const btCollisionObject* b) {
  return pair_friction(a->getFriction(), b->getFriction());
}
btScalar larger(const btCollisionObject* a, const btCollisionObject* b) {
  return std::max(a->getRestitution(), b->getRestitution());
}

/// Bullet keeps these per process, not per world. All worlds of this solver want the same; other users of Bullet in the
/// process may have set others. Written only where they differ: worlds of other threads read them.
void set_globals() {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto set = [](auto& global, auto value) {
    if (global != value) global = value;
  };
  set(gContactBreakingThreshold, static_cast<btScalar>(contact_distance));
  set(gDeactivationTime, static_cast<btScalar>(sleep_time));
  set(gCalculateCombinedFrictionCallback, &geometric_mean);
  set(gCalculateCombinedRestitutionCallback, &larger);
}

double smallest_diagonal(const WorldDef& def) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const BodyDef& body : def.bodies) smallest = std::min(smallest, def.parts[body.part]->diagonal());
  return smallest;
}

double median_diagonal(const WorldDef& def) {
  std::vector<double> diagonals;
  for (const BodyDef& body : def.bodies)
    if (!body.fixed) diagonals.push_back(def.parts[body.part]->diagonal());
  if (diagonals.empty())
    for (const BodyDef& body : def.bodies) diagonals.push_back(def.parts[body.part]->diagonal());
  if (diagonals.empty()) return 1.0;
  std::nth_element(diagonals.begin(), diagonals.begin() + diagonals.size() / 2, diagonals.end());
  return diagonals[diagonals.size() / 2];
}

/// Left alone, Bullet sets aside 6.6 MB in every world: room for 4096 manifolds and as many algorithms. This is room
/// for some pairs of pieces a body; parts of many hulls have more, which are allocated one by one.
btDefaultCollisionConstructionInfo pools_for(std::size_t bodies) {
  constexpr std::size_t touching = 8;  ///< pairs of pieces a body
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = info.m_defaultMaxCollisionAlgorithmPoolSize =
      static_cast<int>(touching * std::max<std::size_t>(1, std::min<std::size_t>(bodies, 512)));
  info.m_customCollisionAlgorithmMaxElementSize = sizeof(HullContact);  // elements must hold the largest algorithm
  return info;
}

}  // namespace

World::World(const WorldDef& def, const BulletSettings& settings, const ShapeSource& shapes)
    : def_(def),
      settings_(settings),
      scale_(1.0 / median_diagonal(def)),
      shortening_(settings.cut_steps ? step_cuts(settings.time_step, def.gravity.norm(), smallest_diagonal(def)) : 1),
      time_step_(settings.time_step / shortening_),
      configuration_(pools_for(def.bodies.size())),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &contact_solver_, &configuration_) {
  set_globals();
  dispatcher_.setDispatcherFlags(dispatcher_.getDispatcherFlags() &
                                 ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
  hull_contact_.register_at(dispatcher_);
  world_.setGravity(to_bt(Vec3(def.gravity * scale_)));
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;
  world_.getDispatchInfo().m_useContinuous = false;  // swept boxes would find pairs that are then rejected
  world_.setForceUpdateAllAabbs(false);              // walls and sleepers do not move

  btContactSolverInfo& info = world_.getSolverInfo();
  ContactSolver::configure(info);
  contact_solver_.patch_radius = patch_radius * smallest_diagonal(def) * scale_;
  info.m_restitutionVelocityThreshold = 2.0 * def.gravity.norm() * scale_ * time_step_;

  Vec3 unset = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const BodyDef& body_def : def_.bodies) {
    auto body = std::make_unique<Body>();
    body->def = &body_def;
    body->shape = shapes(def_.parts[body_def.part], scale_);
    body->motion.inertia = body->shape->inertia * body_def.mass;
    contact_solver_.diagonals.push_back(static_cast<btScalar>(def_.parts[body_def.part]->diagonal() * scale_));
    body->last.pose.position = unset;
    bodies_.push_back(std::move(body));
  }
  add_walls(def.wall_height);
}

World::~World() {
  for (auto& body : bodies_)
    if (body->rigid) world_.removeRigidBody(body->rigid.get());
  for (auto& wall : walls_) world_.removeRigidBody(wall.get());
}

btTransform World::body_transform(const Body& body, const Pose& pose) const {
  const Pose principal = pose * body.shape->principal;
  return to_bt(Pose{principal.position * scale_, principal.orientation});
}

void World::insert(std::size_t index, const BodyState& state) {
  BIN_SCENES_ASSERT(index < bodies_.size() && is_rigid(state.pose));
  Body& body = *bodies_[index];
  const bool driven = body.def->fixed && !(state.velocity.linear.isZero() && state.velocity.angular.isZero());
  if (driven && body.rigid && body.rigid->isKinematicObject()) {  // further on its path: its contacts stay
    body.rigid->setWorldTransform(body_transform(body, state.pose));
    drive(body, state);
    return;
  }
  if (body.rigid) {
    world_.removeRigidBody(body.rigid.get());
    body.rigid.reset();
  }
  const BodyDef& def = *body.def;
  btRigidBody::btRigidBodyConstructionInfo info(def.fixed ? 0.0 : def.mass, nullptr, body.shape->shape.get(),
                                                def.fixed ? btVector3(0, 0, 0) : to_bt(body.motion.inertia));
  info.m_startWorldTransform = body_transform(body, state.pose);
  info.m_friction = def.friction;
  info.m_restitution = def.restitution;
  info.m_linearSleepingThreshold = sleep_speed;
  info.m_angularSleepingThreshold = sleep_turn;
  body.rigid = std::make_unique<btRigidBody>(info);
  body.rigid->setFlags(0);  // gravity and the gyroscopic term are the world's business
  body.rigid->setUserPointer(&body.motion);
  if (!settings_.sleeping) body.rigid->setActivationState(DISABLE_DEACTIVATION);
  if (!def.fixed) {
    body.rigid->setLinearVelocity(to_bt(Vec3(state.velocity.linear * scale_)));
    body.rigid->setAngularVelocity(to_bt(state.velocity.angular));
  }
  if (!def.fixed) body.rigid->setUserIndex(static_cast<int>(index));
  body.rigid->setUserIndex2(static_cast<int>(index));
  if (driven) {
    body.rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    body.rigid->forceActivationState(DISABLE_DEACTIVATION);
    drive(body, state);
  }
  body.frozen = false;
  body.woke_at = info.m_startWorldTransform;
  world_.addRigidBody(body.rigid.get());
  body.last = state;
}

void World::remove(std::size_t index) {
  BIN_SCENES_ASSERT(index < bodies_.size());
  Body& body = *bodies_[index];
  if (!body.rigid) return;
  body.last = states()[index];
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    const bool first = manifold.getBody0() == body.rigid.get();
    if (!first && manifold.getBody1() != body.rigid.get()) continue;
    const btCollisionObject* other = first ? manifold.getBody1() : manifold.getBody0();
    other->activate();
    if (Body* touched = body_of(other); touched && touched->frozen && manifold.getNumContacts() > 0) thaw(*touched);
  }
  world_.removeRigidBody(body.rigid.get());
  body.rigid.reset();
}

/// Bullet wakes whole islands. Here bodies that sleep in the midst of what moves stand still like walls until something
/// that touches them goes on.
void World::begin(const Phase& phase) {
  const bool wakes = by_touch_ && !phase.begins_asleep;
  by_touch_ = phase.sleep == Phase::Sleep::by_touch;
  for (const auto& body : bodies_) {
    if (!body->rigid || body->def->fixed) continue;
    if (phase.begins_asleep)
      freeze(*body);
    else if (wakes)
      thaw(*body);
  }
}

void World::freeze(Body& body) {
  body.frozen = true;
  body.rigid->setLinearVelocity(btVector3(0, 0, 0));
  body.rigid->setAngularVelocity(btVector3(0, 0, 0));
  body.rigid->setMassProps(0.0, btVector3(0, 0, 0));
  body.rigid->forceActivationState(ISLAND_SLEEPING);
}

void World::thaw(Body& body) {
  if (body.frozen) {
    body.rigid->setMassProps(body.def->mass, to_bt(body.motion.inertia));
    body.rigid->updateInertiaTensor();
  }
  body.frozen = false;
  body.woke_at = body.rigid->getWorldTransform();
  body.rigid->forceActivationState(ACTIVE_TAG);
  body.rigid->activate(true);
}

World::Body* World::body_of(const btCollisionObject* object) const {
  const int index = object->getUserIndex();
  return index < 0 ? nullptr : bodies_[static_cast<std::size_t>(index)].get();
}

/// Of the contacts with which the last step began: what falls away has none any more.
void World::wake_touched() {
  std::vector<Body*> woken;
  const auto went_on = [](const Body& body) {
    const btTransform& now = body.rigid->getWorldTransform();
    return now.getOrigin().distance(body.woke_at.getOrigin()) > going_on ||
           now.getRotation().angleShortestPath(body.woke_at.getRotation()) * body.shape->radius > going_on;
  };
  for (int m = 0; m < dispatcher_.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    Body *a = body_of(manifold.getBody0()), *b = body_of(manifold.getBody1());
    if (!a || !b || a->frozen == b->frozen || manifold.getNumContacts() == 0) continue;
    if (a->frozen) std::swap(a, b);
    if (went_on(*a)) woken.push_back(b);
  }
  for (const auto& body : bodies_)
    if (body->rigid && !body->def->fixed && !body->frozen && went_on(*body))
      body->woke_at = body->rigid->getWorldTransform();
  for (Body* body : woken) thaw(*body);
}

int World::cuts(double dt) const {
  if (!settings_.cut_steps) return 1;
  const double fall = def_.gravity.norm() * scale_ * dt * dt;
  double distance = 0.0;  // of the fastest part, without what gravity adds
  bool moves = false;
  double thinnest = std::numeric_limits<double>::infinity();
  for (const auto& body : bodies_)
    if (body->rigid) thinnest = std::min(thinnest, body->shape->thickness);
  for (const auto& body : bodies_) {
    if (!body->rigid || body->rigid->isStaticObject() || !body->rigid->isActive()) continue;
    const double speed =
        body->rigid->getLinearVelocity().length() + body->rigid->getAngularVelocity().length() * body->shape->radius;
    if (std::isfinite(speed)) distance = std::max(distance, speed * dt);
    moves = true;
  }
  if (!moves) return 1;
  const auto whole = [](double ratio, int most) { return static_cast<int>(std::ceil(std::min<double>(ratio, most))); };
  const int exact = world_.getDispatcher()->getNumManifolds() > 0 ? whole(distance / step_length, fine_cuts) : 1;
  return std::max({1, exact, whole((distance + fall) / (0.5 * thinnest), most_cuts)});
}

void World::advance(const Steps& steps) {
  set_globals();
  const auto shortening = static_cast<std::uint64_t>(shortening_);
  for (std::uint64_t s = 0; s < steps.whole * shortening; ++s) step(time_step_);
  for (std::uint64_t s = 0; steps.rest > 0.0 && s < shortening; ++s) step(steps.rest / shortening_);
}

void World::step(double seconds) {
  const int n = cuts(seconds);
  // Cutting a step does not make sub-steps any shorter than they are.
  world_.getSolverInfo().m_numIterations = std::max(1, (settings_.iterations / ContactSolver::sweeps + n - 1) / n);
  sub_step_ = seconds / n / world_.getSolverInfo().m_numIterations;
  for (int k = 0; k < n; ++k) {
    stop_if_cancelled();
    const bool turns = frame_.turns();
    if (turns) turn_with_bin(seconds / n);
    if (turns) spin_with_bin(0.5 * seconds / n);
    contact_solver_.clock += seconds / n;
    world_.stepSimulation(seconds / n, 0);
    if (turns) spin_with_bin(0.5 * seconds / n);
    if (by_touch_) wake_touched();
    count();
  }
}

void World::count() {
  ++counters_.steps;
  counters_.contacts = contact_solver_.rows;
  counters_.pairs += static_cast<std::uint64_t>(broadphase_.getOverlappingPairCache()->getNumOverlappingPairs());
  for (const auto& body : bodies_) {
    if (!body->rigid || body->def->fixed) continue;
    if (!body->rigid->isActive())
      ++counters_.asleep;
    else if (!body->motion.touches)
      ++counters_.free_falls;
  }
}

std::vector<BodyState> World::states() const {
  std::vector<BodyState> result;
  result.reserve(bodies_.size());
  for (const auto& body : bodies_) {
    if (!body->rigid || body->def->fixed) {
      result.push_back(body->last);
      continue;
    }
    Pose principal = from_bt(body->rigid->getWorldTransform());
    principal.position /= scale_;
    BodyState state;
    state.pose = principal * body->shape->principal.inverse();
    state.velocity.linear = from_bt(body->rigid->getLinearVelocity()) / scale_;
    state.velocity.angular = from_bt(body->rigid->getAngularVelocity());
    result.push_back(state);
  }
  return result;
}

std::vector<bool> World::asleep() const {
  std::vector<bool> result;
  for (const auto& body : bodies_) result.push_back(body->rigid && !body->def->fixed && !body->rigid->isActive());
  return result;
}

std::vector<ContactForce> World::contact_forces() const {
  std::vector<ContactForce> forces;
  for (int m = 0; m < dispatcher_.getNumManifolds() && sub_step_ > 0.0; ++m) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(m);
    const int a = manifold.getBody0()->getUserIndex2(), b = manifold.getBody1()->getUserIndex2();
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      if (point.m_appliedImpulse <= 0) continue;
      const btVector3 impulse = point.m_appliedImpulse * point.m_normalWorldOnB +
                                point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
      // Bullet reports what acts on its first body.
      ContactForce f{a,
                     b,
                     from_bt(point.getPositionWorldOnA()) / scale_,
                     -from_bt(point.m_normalWorldOnB),
                     -from_bt(impulse) / (scale_ * sub_step_),
                     point.getDistance() / scale_};
      if (f.a < 0) f = {f.b, -1, f.point, -f.normal, -f.force, f.gap};
      if (f.a >= 0) forces.push_back(f);
    }
  }
  return forces;
}

WorstContact World::take_worst_contact() {
  const ContactSolver::Deepest d = std::exchange(contact_solver_.deepest, {});
  WorstContact worst{d.a, d.b, d.depth / scale_, d.relative, contact_solver_.clock - d.time, d.unresolved_impacts};
  if (worst.a < 0) std::swap(worst.a, worst.b);
  return worst;
}

std::vector<Flag> World::flags() const {
  std::vector<Flag> result;
  if (shortening_ > 1)
    result.push_back(
        step_cut_flag("solver.bullet.time_step", settings_.time_step, shortening_, smallest_diagonal(def_)));
  for (std::size_t p = 0; p < def_.parts.size(); ++p) {
    const auto user = std::find_if(bodies_.begin(), bodies_.end(), [&](const auto& b) { return b->def->part == p; });
    if (user == bodies_.end() || (*user)->shape->hulls_met) continue;
    const PartShape& shape = *(*user)->shape;
    const std::string errors = formatted(
        " leave the mesh by %.2g %% of its diagonal, and their volume is off by %+.2g %%; they may fill a play "
        "of up to %.2g mm",
        100.0 * shape.hull_error, 100.0 * shape.hull_volume_error, 2e3 * shape.hull_error * def_.parts[p]->diagonal());
    result.push_back({"hull_error", "the hulls of " + def_.parts[p]->path() + errors,
                      "raise solver.bullet.max_hulls, or hull_error and hull_volume_error beside it, or use the sphere "
                      "solver"});
  }
  return result;
}

}  // namespace bin_scenes::bullet
