/// One world of the solver `bullet`: bodies, walls and gravity, at a scale at which the median part is one unit.
/// BulletSolver converts between this scale and SI units.
#pragma once

#include "contact_solver.hpp"
#include "dynamics_world.hpp"
#include "hull_contact.hpp"
#include "shape.hpp"

#include "bin_scenes/solver/solver.hpp"
#include "solver/step_limit.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>

#include <functional>
#include <memory>
#include <vector>

namespace bin_scenes::bullet {

using PartShapePtr = std::shared_ptr<const PartShape>;
/// Returns the shape of a part at a scale. The solver keeps the shapes, so that the worlds of a batch share them.
using ShapeSource = std::function<PartShapePtr(const PartModelPtr&, double scale)>;

class World {
 public:
  World(const WorldDef& def, const BulletSettings& settings, const ShapeSource& shapes);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void insert(std::size_t body, const BodyState& state);
  void remove(std::size_t body);
  void set_frame(const Frame& frame);
  void begin(const Phase& phase);
  /// Simulates these steps. Each is divided so that the fastest part moves by a small share of its size at a time.
  void advance(const Steps& steps);

  std::vector<BodyState> states() const;
  std::vector<bool> asleep() const;
  std::vector<ContactForce> contact_forces() const;
  WorstContact take_worst_contact();
  /// Counts, summed over all steps, for the profile.
  struct Counters {
    std::uint64_t steps = 0, free_falls = 0, asleep = 0, pairs = 0, contacts = 0;
  };
  const Counters& counters() const { return counters_; }
  std::vector<Flag> flags() const;

 private:
  struct Body {
    const BodyDef* def = nullptr;
    PartShapePtr shape;
    Motion motion;
    std::unique_ptr<btRigidBody> rigid;  ///< null while the body is absent
    BodyState last;                      ///< last state of an absent body
    bool frozen = false;                 ///< asleep alone among moving bodies, which Bullet does not support
    btTransform woke_at;                 ///< pose when it woke, or when it last moved on noticeably
  };

  void add_static(btCollisionShape* shape, const btTransform& pose);
  void add_walls(double wall_height);
  void step(double seconds);
  int cuts(double dt) const;
  void freeze(Body& body);
  void thaw(Body& body);
  void drive(Body& body, const BodyState& state);
  Body* body_of(const btCollisionObject* object) const;
  void wake_touched();
  void turn_with_bin(double dt);
  void spin_with_bin(double dt);
  void count();
  btTransform body_transform(const Body& body, const Pose& pose) const;

  WorldDef def_;
  BulletSettings settings_;
  Frame frame_;
  double scale_ = 1.0;     ///< units per metre
  int shortening_ = 1;     ///< number of steps of time_step_ per step of the settings; small parts need short ones
  double time_step_;       ///< s
  double sub_step_ = 0.0;  ///< s: sub-step of the last step
  btDefaultCollisionConfiguration configuration_;
  HullContact::Factory hull_contact_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  ContactSolver contact_solver_;
  DynamicsWorld world_;
  std::vector<std::unique_ptr<Body>> bodies_;
  MeshShape bin_mesh_;
  std::vector<std::unique_ptr<btCollisionShape>> wall_shapes_;
  std::vector<std::unique_ptr<btRigidBody>> walls_;
  bool by_touch_ = false;  ///< bodies sleep and wake by the rule Phase::Sleep::by_touch
  Counters counters_;
};

}  // namespace bin_scenes::bullet
