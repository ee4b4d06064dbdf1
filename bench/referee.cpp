/// Overlap piece by piece by Bullet's GJK and EPA, and drift by its dynamics in small steps. Lengths are scaled so that
/// a part's diagonal is 1, which Bullet's constants are made for.
#include "referee.hpp"

#include "bin_scenes/core/error.hpp"
#include "peers/bullet_part.hpp"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>

extern btScalar gContactBreakingThreshold;  // NOLINT: a name of Bullet's

namespace bin_scenes::bench {

namespace {

// Lengths in units of the scaled world.
constexpr double breaking_threshold = 0.001;  ///< the default of 0.02 keeps contacts that are none and rattles the pile
constexpr double wall = 4.0;                  ///< thickness of floor and walls
constexpr double time_step = 0.00025;         ///< s
constexpr int iterations = 100;
constexpr double push_out = 0.0015;  ///< share of an overlap let out in a step: a tenth in 1/60 s

/// With what face contacts need.
struct Shape : BulletPart {
  Shape(const PartModel& part, const Pieces& pieces, double scale) : BulletPart(part, pieces, 0.0, scale) {
    for (const auto& hull : hulls) hull->initializePolyhedralFeatures();
    compound.setMargin(0.0);
  }
};

/// A part where it lies, with the bounds of its pieces.
struct Placed {
  const Shape* shape;
  btTransform model;  ///< model frame in the bin
  btVector3 center;   ///< of mass
  double diagonal;
  struct Box {
    btVector3 lower, upper;
    bool meets(const Box& other) const {
      for (int k = 0; k < 3; ++k)
        if (lower[k] > other.upper[k] || other.lower[k] > upper[k]) return false;
      return true;
    }
  };
  std::vector<Box> boxes;  ///< by piece
};

/// Of the deepest two pieces; 0 if they are apart.
double depth_of(const Placed& a, const Placed& b) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < a.boxes.size(); ++i)
    for (std::size_t k = 0; k < b.boxes.size(); ++k) {
      btGjkEpaSolver2::sResults found;
      if (a.boxes[i].meets(b.boxes[k]) &&
          btGjkEpaSolver2::Penetration(a.shape->hulls[i].get(), a.model, b.shape->hulls[k].get(), b.model,
                                       a.center - b.center, found))
        deepest = std::max(deepest, -found.distance);
    }
  return deepest;
}

bool is_in(const ScenePart& part) {
  return part.state != PartState::escaped && part.state != PartState::not_poured;
}

std::vector<std::unique_ptr<Shape>> shapes_of(const std::vector<PartModelPtr>& parts, const std::vector<Pieces>& pieces,
                                              double scale) {
  std::vector<std::unique_ptr<Shape>> shapes;
  for (std::size_t line = 0; line < parts.size(); ++line)
    shapes.push_back(std::make_unique<Shape>(*parts[line], pieces[line], scale));
  return shapes;
}

/// The box of a request, scaled.
struct World : BulletWorld {
  World(const Request& request, double scale) : BulletWorld(request.gravity * scale, iterations) {
    gContactBreakingThreshold = breaking_threshold;
    btContactSolverInfo& info = world.getSolverInfo();
    info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;  // one direction alone lets a pile creep
    info.m_splitImpulse = 1;                                // overlap is let out without leaving speed behind
    info.m_splitImpulsePenetrationThreshold = 0.0;
    info.m_erp = info.m_erp2 = push_out;
    const Vec3 half = 0.5 * scale * request.bin.inner_size;
    const auto add_wall = [&](const Vec3& size, const Vec3& center) {
      auto box = std::make_unique<btBoxShape>(to_bt(size));
      box->setMargin(0.0);
      box->initializePolyhedralFeatures();
      add_fixed(std::move(box), center, request.bin.friction, 0.0);
    };
    add_wall(Vec3(half.x() + 2 * wall, half.y() + 2 * wall, wall), Vec3(0, 0, -wall));
    for (const double side : {-1.0, 1.0}) {
      add_wall(Vec3(wall, half.y() + 2 * wall, half.z()), Vec3(side * (half.x() + wall), 0, half.z()));
      add_wall(Vec3(half.x() + 2 * wall, wall, half.z()), Vec3(0, side * (half.y() + wall), half.z()));
    }
  }
  btRigidBody& add(Shape& shape, const btTransform& pose, double friction) {
    btRigidBody::btRigidBodyConstructionInfo info(1.0, nullptr, &shape.compound, shape.inertia);
    info.m_startWorldTransform = pose;
    info.m_friction = friction;
    bodies.push_back(std::make_unique<btRigidBody>(info));
    bodies.back()->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(bodies.back().get());
    return *bodies.back();
  }
  void simulate(double seconds) {
    const int steps = static_cast<int>(std::lround(seconds / time_step));
    for (int k = 0; k < steps; ++k) world.stepSimulation(time_step, 0, time_step);
  }
};

}  // namespace

Pieces read_pieces(const std::string& path, double scale) {
  std::ifstream file(path);
  Pieces pieces;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "o") pieces.emplace_back();
    Vec3 v;
    if (word == "v" && !pieces.empty() && words >> v.x() >> v.y() >> v.z()) pieces.back().push_back(v * scale);
  }
  if (pieces.empty()) throw input_error("no convex pieces", path, "give a part that models/pieces/ has");
  return pieces;
}

Overlap referee_overlap(const Scene& scene, const LoadedRequest& loaded, const std::vector<Pieces>& pieces) {
  const std::vector<PartModelPtr>& parts = loaded.parts;
  const double scale = 1.0 / parts.front()->diagonal();
  const std::vector<std::unique_ptr<Shape>> shapes = shapes_of(parts, pieces, scale);
  const Vec3 half = 0.5 * scale * loaded.request.bin.inner_size;
  Overlap overlap;
  std::vector<Placed> placed;
  for (const ScenePart& part : scene.parts) {
    if (!is_in(part)) continue;
    Placed p;
    p.shape = shapes[part.line].get();
    p.model = to_bt(part.pose, scale);
    p.center = (p.model * p.shape->principal).getOrigin();
    p.diagonal = scale * parts[part.line]->diagonal();
    double behind = 0.0;
    for (const auto& hull : p.shape->hulls) {
      Placed::Box box;
      hull->getAabb(p.model, box.lower, box.upper);
      p.boxes.push_back(box);
      for (int v = 0; v < hull->getNumPoints(); ++v) {
        const btVector3 x = p.model * hull->getScaledPoint(v);
        behind = std::max(behind, -x.z());
        if (x.z() < 2.0 * half.z()) behind = std::max({behind, std::abs(x.x()) - half.x(), std::abs(x.y()) - half.y()});
      }
    }
    overlap.bin.push_back(behind / p.diagonal);
    for (const Placed& other : placed) {
      if ((p.center - other.center).length() > p.diagonal + other.diagonal) continue;
      const double depth = depth_of(p, other);
      if (depth > 0.0) overlap.pairs.push_back(depth / std::min(p.diagonal, other.diagonal));
    }
    placed.push_back(std::move(p));
  }
  return overlap;
}

Drift referee_drift(const Scene& scene, const LoadedRequest& loaded, const std::vector<Pieces>& pieces,
                    double seconds) {
  const std::vector<PartModelPtr>& parts = loaded.parts;
  const double scale = 1.0 / parts.front()->diagonal();
  const std::vector<std::unique_ptr<Shape>> shapes = shapes_of(parts, pieces, scale);
  World world(loaded.request, scale);

  struct Judged {
    btRigidBody* body;
    btTransform start;
    double diagonal;
  };
  std::vector<Judged> judged;
  for (const ScenePart& part : scene.parts) {
    if (!is_in(part)) continue;
    Shape& shape = *shapes[part.line];
    const btTransform start = to_bt(part.pose, scale) * shape.principal;
    judged.push_back({&world.add(shape, start, loaded.request.parts[part.line].friction), start,
                      scale * parts[part.line]->diagonal()});
  }
  world.simulate(seconds);

  Drift drift;
  for (const Judged& part : judged) {
    const btTransform end = part.body->getWorldTransform();
    drift.moved.push_back((end.getOrigin() - part.start.getOrigin()).length() / part.diagonal);
    const btScalar cosine = std::abs(end.getRotation().dot(part.start.getRotation()));
    drift.turned.push_back(2.0 * std::acos(std::min(btScalar(1), cosine)) * 180.0 / M_PI);
  }
  return drift;
}

}  // namespace bin_scenes::bench
