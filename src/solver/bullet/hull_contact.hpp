/// Contact between convex pieces at their true surfaces. Bullet's own algorithm finds a whole contact patch only when
/// the shrunken cores of the shapes overlap, and before that one point per step, so that flat parts rock until enough
/// points have been collected; it also leaves a gap of both margins to spheres, planes and triangles. Here GJK (EPA
/// where cores overlap) gives the normal, the margins are subtracted again, and faces that touch each other are clipped
/// at once.
#pragma once

#include <BulletCollision/CollisionDispatch/btActivatingCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>

namespace bin_scenes::bullet {

class HullContact : public btActivatingCollisionAlgorithm {
 public:
  HullContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
              const btCollisionObjectWrapper* b, btConvexPenetrationDepthSolver* depth_solver);
  ~HullContact() override;

  void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                        const btDispatcherInfo& info, btManifoldResult* result) override;
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;  // no continuous collision detection: steps are divided instead
  }
  void getAllContactManifolds(btManifoldArray& manifolds) override {
    if (manifold_ && own_manifold_) manifolds.push_back(manifold_);
  }

  /// Makes Bullet use this class for every pair of a hull with a hull, a sphere or a triangle.
  struct Factory : public btCollisionAlgorithmCreateFunc {
    btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                   const btCollisionObjectWrapper* a,
                                                   const btCollisionObjectWrapper* b) override;
    void register_at(btCollisionDispatcher& dispatcher);

    btGjkEpaPenetrationDepthSolver depth_solver;
  };

 private:
  btPersistentManifold* manifold_;
  bool own_manifold_ = false;
  btConvexPenetrationDepthSolver* depth_solver_;
  btVertexArray clipped_a_, clipped_b_;
};

}  // namespace bin_scenes::bullet
