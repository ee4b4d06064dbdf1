/// Bullet 3.24 as it comes, by the settings that users of it begin with: metres and kilograms, sequential impulse at
/// the world's own time step, hulls with a margin around them, sleeping on with Bullet's own thresholds (0.8 m/s, 1
/// rad/s for 2 s). What solver `bullet` of this project does to it beyond that is measured beside it.
#include "peers/peer.hpp"

#include <btBulletDynamicsCommon.h>

#include <cmath>

namespace bin_scenes::bench {

namespace {

constexpr double wall = 0.2;  ///< m, thickness of floor and walls

btVector3 to_bt(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
btQuaternion to_bt(const Quat& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}
Vec3 from_bt(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

btScalar geometric_mean(const btCollisionObject* a, const btCollisionObject* b) {
  return std::sqrt(a->getFriction() * b->getFriction());
}

/// A ball, or a part's pieces about its centre of mass, in its principal axes.
struct PartShape {
  std::vector<std::unique_ptr<btConvexHullShape>> hulls;
  std::unique_ptr<btSphereShape> ball;
  btCompoundShape compound;
  btTransform principal;  ///< in the part's frame
  btVector3 inertia;      ///< at mass 1

  PartShape(const PartModel& part, const Pieces& pieces, double radius, double margin) {
    const MassProperties& mass = part.mass();
    principal = btTransform(to_bt(mass.principal_axes), to_bt(mass.center));
    if (radius > 0.0) {
      ball = std::make_unique<btSphereShape>(radius);
      ball->calculateLocalInertia(1.0, inertia);
      return;
    }
    inertia = to_bt(Vec3(mass.principal / mass.volume));
    for (const std::vector<Vec3>& piece : pieces) {
      hulls.push_back(std::make_unique<btConvexHullShape>());
      for (const Vec3& vertex : piece) hulls.back()->addPoint(to_bt(vertex), false);
      hulls.back()->setMargin(margin);
      hulls.back()->recalcLocalAabb();
      compound.addChildShape(principal.inverse(), hulls.back().get());
    }
  }
  btCollisionShape* shape() { return ball ? static_cast<btCollisionShape*>(ball.get()) : &compound; }
};

class BulletWorld final : public PeerWorld {
 public:
  BulletWorld(const WorldDef& def, const PeerSettings& settings)
      : def_(def),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        bodies_(def.bodies.size()) {
    gCalculateCombinedFrictionCallback = geometric_mean;
    world_.setGravity(to_bt(def.gravity));
    world_.getSolverInfo().m_numIterations = settings.iterations;
    for (std::size_t p = 0; p < def.parts.size(); ++p)
      shapes_.push_back(std::make_unique<PartShape>(*def.parts[p], settings.pieces[p],
                                                    settings.balls.empty() ? 0.0 : settings.balls[p], settings.margin));
    add_walls();
  }
  ~BulletWorld() override {
    for (const auto& body : bodies_)
      if (body) world_.removeRigidBody(body.get());
    for (const auto& body : walls_) world_.removeRigidBody(body.get());
  }

  void insert(std::size_t b, const BodyState& state) override {
    const BodyDef& def = def_.bodies[b];
    PartShape& shape = *shapes_[def.part];
    const btTransform pose = btTransform(to_bt(state.pose.orientation), to_bt(state.pose.position)) * shape.principal;
    const bool fresh = !bodies_[b];
    if (fresh) {
      const double mass = def.fixed ? 0.0 : def.mass;
      btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.shape(), shape.inertia * mass);
      info.m_friction = def.friction;
      info.m_restitution = def.restitution;
      bodies_[b] = std::make_unique<btRigidBody>(info);
    }
    bodies_[b]->setCenterOfMassTransform(pose);
    bodies_[b]->setInterpolationWorldTransform(pose);
    bodies_[b]->setLinearVelocity(to_bt(state.velocity.linear));
    bodies_[b]->setAngularVelocity(to_bt(state.velocity.angular));
    if (fresh)
      world_.addRigidBody(bodies_[b].get());
    else
      bodies_[b]->activate();  // its contacts stay: a push each step is no new start
  }
  void remove(std::size_t b) override {
    world_.removeRigidBody(bodies_[b].get());
    bodies_[b].reset();
  }
  void step(double dt) override { world_.stepSimulation(dt, 0, dt); }
  BodyState state(std::size_t b) const override {
    const btRigidBody& body = *bodies_[b];
    const btTransform pose = body.getWorldTransform() * shapes_[def_.bodies[b].part]->principal.inverse();
    const btQuaternion q = pose.getRotation();
    BodyState state;
    state.pose.position = from_bt(pose.getOrigin());
    state.pose.orientation = Quat(q.w(), q.x(), q.y(), q.z()).normalized();
    state.velocity = {from_bt(body.getLinearVelocity()), from_bt(body.getAngularVelocity())};
    return state;
  }
  /// Asleep is any body that has been slow for 2 s, whether or not all of its island has.
  PeerRest rest(std::size_t b) const override {
    btRigidBody& body = *bodies_[b];
    if (body.wantsSleeping()) return PeerRest::asleep;
    const bool slow = body.getLinearVelocity().length() < body.getLinearSleepingThreshold() &&
                      body.getAngularVelocity().length() < body.getAngularSleepingThreshold();
    return slow ? PeerRest::slow : PeerRest::moves;
  }

 private:
  void add_box(const Vec3& lower, const Vec3& upper) {
    wall_shapes_.push_back(std::make_unique<btBoxShape>(to_bt(Vec3(0.5 * (upper - lower)))));
    add_fixed(0.5 * (lower + upper));
  }
  /// The last shape of the walls.
  void add_fixed(const Vec3& center) {
    btRigidBody::btRigidBodyConstructionInfo info(0.0, nullptr, wall_shapes_.back().get());
    info.m_startWorldTransform.setOrigin(to_bt(center));
    info.m_friction = def_.bin.friction;
    info.m_restitution = def_.bin.restitution;
    walls_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(walls_.back().get());
  }

  void add_walls() {
    if (def_.bin.kind == Bin::Kind::none) return;
    if (def_.bin.kind == Bin::Kind::floor) {
      wall_shapes_.push_back(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0.0));
      add_fixed(Vec3::Zero());
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

  const WorldDef& def_;
  std::vector<std::unique_ptr<PartShape>> shapes_;  ///< by part
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> wall_shapes_;
  std::vector<std::unique_ptr<btRigidBody>> walls_, bodies_;
};

}  // namespace

std::unique_ptr<PeerWorld> make_bullet_world(const WorldDef& def, const PeerSettings& settings) {
  return std::make_unique<BulletWorld>(def, settings);
}

}  // namespace bin_scenes::bench
