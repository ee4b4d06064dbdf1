/// GJK or EPA for the normal of two convex pieces, then clipping of the faces that lie against each other. Margins are
/// taken out again.
#include "hull_contact.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <initializer_list>
#include <new>

namespace bin_scenes::bullet {

namespace {

/// GJK's nearest points, with the margins of hulls and triangles taken out; a sphere's margin is its radius and stays.
struct NearestPoints : public btDiscreteCollisionDetectorInterface::Result {
  btScalar margin_a = 0, margin_b = 0, distance = 0;
  btVector3 normal{0, 0, 0}, point{0, 0, 0};
  bool found = false;

  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b, btScalar depth) override {
    normal = normal_on_b;
    point = point_on_b - normal_on_b * margin_b;
    distance = depth + margin_a + margin_b;
    found = true;
  }
};

/// The corners of the patch in which two faces lie against each other.
struct Patch : public btDiscreteCollisionDetectorInterface::Result {
  struct Corner {
    btVector3 point;
    btScalar depth;
    bool known;  ///< the manifold has it already
  };
  btVector3 normal{0, 0, 0};
  btAlignedObjectArray<Corner> corners;

  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal_on_b, const btVector3& point, btScalar depth) override {
    normal = normal_on_b;
    corners.push_back({point, depth, false});
  }

  /// Keeps four corners: of the deepest the outermost, the one farthest from it, and the farthest on either side of the
  /// line between them, where a corner counts for less the farther it is from touching. A manifold holds four points
  /// and lets every further one push out another: the crossings of edges that almost coincide took the places of
  /// corners in turn, each time without its impulse. Without depths, what rolls over a rim met its next corner when it
  /// was already under, and was lifted out of it: a bolt wobbled on its head without end, and rose. A corner that the
  /// manifold has counts for more: of two as good, one and then the other would be taken, each without its impulse.
  void spread(btScalar reach, const btPersistentManifold& manifold) {
    constexpr int most = MANIFOLD_CACHE_SIZE;
    constexpr btScalar same = 0.02;  // of the reach: depths of one face at rest
    constexpr btScalar stay = 0.1;   // what a corner that is known counts for more
    if (corners.size() <= most) return;
    for (int i = 0; i < corners.size(); ++i)
      for (int k = 0; k < manifold.getNumContacts() && !corners[i].known; ++k)
        corners[i].known = corners[i].point.distance(manifold.getContactPoint(k).getPositionWorldOnB()) < reach;
    btVector3 center(0, 0, 0);
    btScalar deepest = BT_LARGE_FLOAT;
    for (int i = 0; i < corners.size(); ++i) {
      center += corners[i].point / btScalar(corners.size());
      deepest = std::min(deepest, corners[i].depth);
    }
    const auto choose = [&](int place, const auto& measure) {
      const auto value = [&](const Corner& c) { return measure(c) * (c.known ? 1 + stay : btScalar(1)); };
      int best = place;
      for (int i = place + 1; i < corners.size(); ++i)
        if (value(corners[i]) > value(corners[best])) best = i;
      corners.swap(place, best);
    };
    const auto nearness = [&](const Corner& c) {
      return btScalar(1) - std::max(btScalar(0), c.depth - deepest - same * reach) / reach;
    };
    choose(0, [&](const Corner& c) {
      return c.depth <= deepest + same * reach ? c.point.distance2(center) : deepest - c.depth;
    });
    const btVector3 origin = corners[0].point;
    choose(1, [&](const Corner& c) { return nearness(c) * c.point.distance(origin); });
    const btVector3 across = normal.cross(corners[1].point - origin);
    choose(2, [&](const Corner& c) { return nearness(c) * across.dot(c.point - origin); });
    choose(3, [&](const Corner& c) { return -nearness(c) * across.dot(c.point - origin); });
    corners.resizeNoInitialize(most);
  }

  /// Distance of the deepest corner.
  btScalar pass_on(btManifoldResult& result) const {
    btScalar deepest = BT_LARGE_FLOAT;
    for (int i = 0; i < corners.size(); ++i) {
      result.addContactPoint(normal, corners[i].point, corners[i].depth);
      deepest = std::min(deepest, corners[i].depth);
    }
    return deepest;
  }
};

btScalar own_margin(const btConvexShape& shape) {
  return shape.isPolyhedral() ? shape.getMargin() : btScalar(0);
}

const btConvexPolyhedron* faces(const btConvexShape& shape) {
  return shape.isPolyhedral() ? static_cast<const btPolyhedralConvexShape&>(shape).getConvexPolyhedron() : nullptr;
}

}  // namespace

HullContact::HullContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
                         const btCollisionObjectWrapper* b, btConvexPenetrationDepthSolver* depth_solver)
    : btActivatingCollisionAlgorithm(info, a, b), manifold_(info.m_manifold), depth_solver_(depth_solver) {}

HullContact::~HullContact() {
  if (own_manifold_ && manifold_) m_dispatcher->releaseManifold(manifold_);
}

void HullContact::processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                                   const btDispatcherInfo&, btManifoldResult* result) {
  stop_if_cancelled();
  if (!manifold_) {
    manifold_ = m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject());
    own_manifold_ = true;
  }
  result->setPersistentManifold(manifold_);

  const auto& shape_a = *static_cast<const btConvexShape*>(a->getCollisionShape());
  const auto& shape_b = *static_cast<const btConvexShape*>(b->getCollisionShape());
  const btScalar reach = manifold_->getContactBreakingThreshold() + result->m_closestPointDistanceThreshold;

  NearestPoints nearest;
  nearest.margin_a = own_margin(shape_a);
  nearest.margin_b = own_margin(shape_b);
  btVoronoiSimplexSolver simplex;
  btGjkPairDetector gjk(&shape_a, &shape_b, &simplex, depth_solver_);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA = a->getWorldTransform();
  input.m_transformB = b->getWorldTransform();
  const btScalar farthest = shape_a.getMargin() + shape_b.getMargin() + reach;
  input.m_maximumDistanceSquared = farthest * farthest;
  gjk.getClosestPoints(input, nearest, nullptr);

  if (nearest.found && nearest.distance <= reach) {
    Patch patch;
    if (const auto* faces_a = faces(shape_a), *faces_b = faces(shape_b); faces_a && faces_b)
      btPolyhedralContactClipping::clipHullAgainstHull(nearest.normal, *faces_a, *faces_b, input.m_transformA,
                                                       input.m_transformB, nearest.distance, reach, clipped_a_,
                                                       clipped_b_, patch);
    patch.spread(reach, *manifold_);
    const btScalar deepest = patch.pass_on(*result);
    // GJK's own point lies anywhere in a patch and would push a corner out of the four a manifold keeps, another one
    // every step; it is needed only where the patch misses it (an edge on an edge).
    if (deepest > nearest.distance + 0.1 * reach)
      result->addContactPoint(nearest.normal, nearest.point, nearest.distance);
  }
  if (own_manifold_) result->refreshContactPoints();
}

btCollisionAlgorithm* HullContact::Factory::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                     const btCollisionObjectWrapper* a,
                                                                     const btCollisionObjectWrapper* b) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(HullContact));
  return new (memory) HullContact(info, a, b, &depth_solver);
}

void HullContact::Factory::register_at(btCollisionDispatcher& dispatcher) {
  for (const int other : {CONVEX_HULL_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE, TRIANGLE_SHAPE_PROXYTYPE}) {
    dispatcher.registerCollisionCreateFunc(CONVEX_HULL_SHAPE_PROXYTYPE, other, this);
    dispatcher.registerCollisionCreateFunc(other, CONVEX_HULL_SHAPE_PROXYTYPE, this);
  }
}

}  // namespace bin_scenes::bullet
