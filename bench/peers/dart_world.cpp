/// DART 6.12: boxed LCP over generalised coordinates, solved by projected Gauss-Seidel (its default, Dantzig's
/// pivoting, grows with the cube of a pile's contacts), DART's own box collision.
#include "peers/peer.hpp"

#include "bin_scenes/core/error.hpp"

#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ContactConstraint.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

namespace bin_scenes::bench {

namespace {

constexpr double wall = 4.0;      ///< thickness of floor and walls, in part diagonals
constexpr double push_out = 0.2;  ///< share of an overlap let out in a step, as in ODE

class DartWorld final : public PeerWorld {
 public:
  DartWorld(const WorldDef& def, const PeerSettings& settings)
      : def_(def), scale_(def), world_(dart::simulation::World::create()), bodies_(def.bodies.size()) {
    for (std::size_t p = 0; p < def.parts.size(); ++p) {
      boxes_.emplace_back();
      for (std::vector<Vec3> piece : settings.pieces[p]) {
        for (Vec3& v : piece) v *= scale_.length;
        boxes_.back().emplace_back();
        if (!is_box(piece, boxes_.back().back()))
          throw input_error("a piece is no box", "dart", "DART 6.12's own collision detector knows no convex meshes");
      }
    }
    world_->setGravity(def.gravity * scale_.length);
    world_->setTimeStep(settings.time_step);
    auto pgs = std::make_shared<dart::constraint::PgsBoxedLcpSolver>();
    pgs->setOption({settings.iterations, 1e-6, 1e-3, 1e-9, false});
    world_->setConstraintSolver(std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(pgs));
    // The defaults let overlap out at no more than 1 mm/s, made for robots that touch gently.
    dart::constraint::ContactConstraint::setErrorReductionParameter(push_out);
    dart::constraint::ContactConstraint::setMaxErrorReductionVelocity(1.0);
    world_->getConstraintSolver()->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
    world_->getConstraintSolver()->getCollisionOption().maxNumContacts = 1000000;
    add_walls();
  }

  void insert(std::size_t b, const BodyState& state) override {
    if (!bodies_[b]) create(b);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = state.pose.orientation.toRotationMatrix();
    pose.translation() = scale_.length * state.pose.position;
    auto* joint = static_cast<dart::dynamics::FreeJoint*>(bodies_[b]->getParentJoint());
    joint->setRelativeTransform(pose);
    const Vec3 arm = state.pose.orientation * part(b).mass().center;  // DART wants the velocity of the frame's origin
    joint->setLinearVelocity(scale_.length * (state.velocity.linear - state.velocity.angular.cross(arm)));
    joint->setAngularVelocity(state.velocity.angular);
  }
  void remove(std::size_t b) override {
    world_->removeSkeleton(bodies_[b]->getSkeleton());
    bodies_[b] = nullptr;
  }
  void step(double) override { world_->step(); }
  BodyState state(std::size_t b) const override {
    const Eigen::Isometry3d pose = bodies_[b]->getWorldTransform();
    BodyState state;
    state.pose.orientation = Quat(pose.linear()).normalized();
    state.pose.position = pose.translation() / scale_.length;
    state.velocity = {bodies_[b]->getCOMLinearVelocity() / scale_.length, bodies_[b]->getAngularVelocity()};
    return state;
  }

 private:
  const PartModel& part(std::size_t b) const { return *def_.parts[def_.bodies[b].part]; }

  static void give(dart::dynamics::BodyNode& body, const Aabb& box, double friction, double restitution) {
    auto* node = body.createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(
        std::make_shared<dart::dynamics::BoxShape>(box.size()));
    node->setRelativeTranslation(box.center());
    node->getDynamicsAspect()->setFrictionCoeff(friction);  // DART takes the smaller of the two
    node->getDynamicsAspect()->setRestitutionCoeff(restitution);
  }

  void create(std::size_t b) {
    const BodyDef& def = def_.bodies[b];
    const auto skeleton = dart::dynamics::Skeleton::create("part_" + std::to_string(b));
    auto* body = skeleton->createJointAndBodyNodePair<dart::dynamics::FreeJoint>().second;
    const MassProperties& m = part(b).mass();
    const double mass = def.mass * scale_.mass;
    body->setInertia(dart::dynamics::Inertia(mass, scale_.length * m.center,
                                             m.inertia * (mass / m.volume * scale_.length * scale_.length)));
    for (const Aabb& box : boxes_[def.part]) give(*body, box, def.friction, def.restitution);
    skeleton->setMobile(!def.fixed);
    world_->addSkeleton(skeleton);
    bodies_[b] = body;
  }

  void add_walls() {
    if (def_.bin.kind == Bin::Kind::none) return;
    const auto skeleton = dart::dynamics::Skeleton::create("bin");
    auto* body = skeleton->createJointAndBodyNodePair<dart::dynamics::WeldJoint>().second;
    const Vec3 half = 0.5 * scale_.length * def_.bin.inner_size, out = half + Vec3(wall, wall, 0);
    const double height = scale_.length * def_.wall_height;
    const auto add = [&](const Vec3& lower, const Vec3& upper) {
      Aabb box;
      box.extend(lower);
      box.extend(upper);
      give(*body, box, def_.bin.friction, def_.bin.restitution);
    };
    add(Vec3(-out.x(), -out.y(), -wall), Vec3(out.x(), out.y(), 0));
    if (def_.bin.kind == Bin::Kind::box) {
      add(Vec3(half.x(), -out.y(), 0), Vec3(out.x(), out.y(), height));
      add(Vec3(-out.x(), -out.y(), 0), Vec3(-half.x(), out.y(), height));
      add(Vec3(-out.x(), half.y(), 0), Vec3(out.x(), out.y(), height));
      add(Vec3(-out.x(), -out.y(), 0), Vec3(out.x(), -half.y(), height));
    }
    skeleton->setMobile(false);
    world_->addSkeleton(skeleton);
  }

  const WorldDef& def_;
  PeerScale scale_;
  dart::simulation::WorldPtr world_;
  std::vector<dart::dynamics::BodyNode*> bodies_;
  std::vector<std::vector<Aabb>> boxes_;  ///< by part
};

}  // namespace

std::unique_ptr<PeerWorld> make_dart_world(const WorldDef& def, const PeerSettings& settings) {
  return std::make_unique<DartWorld>(def, settings);
}

}  // namespace bin_scenes::bench
