/// ODE 0.16: quick step (projected Gauss-Seidel over maximal coordinates), boxes where a piece is one, else convexes.
#include "peers/peer.hpp"

#include "bin_scenes/part/hull_geometry.hpp"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {

namespace {

constexpr int contacts_per_pair = 8;
constexpr double wall = 4.0;            ///< thickness of floor and walls, in part diagonals
constexpr double surface_layer = 1e-3;  ///< overlap left alone, in part diagonals: steadies contacts (ODE manual 3.8)

/// A convex piece as dCreateConvex wants it: coplanar triangles of its hull joined to faces.
struct Convex {
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;
  unsigned faces = 0;

  explicit Convex(const std::vector<Vec3>& vertices) {
    const Mesh hull = convex_hull(vertices, static_cast<int>(vertices.size()));
    Aabb box;
    for (const Vec3& v : hull.vertices) {
      box.extend(v);
      points.insert(points.end(), {v.x(), v.y(), v.z()});
    }
    const double tolerance = 1e-6 * box.diagonal();
    std::vector<Vec3> normals;
    for (const auto& [a, b, c] : hull.triangles) {
      const Vec3 &p = hull.vertices[a], &q = hull.vertices[b], &r = hull.vertices[c];
      const Vec3 normal = (q - p).cross(r - p).normalized();
      if (std::any_of(normals.begin(), normals.end(), [&](const Vec3& n) { return n.dot(normal) > 1.0 - 1e-9; }))
        continue;
      normals.push_back(normal);
      add_face(hull, normal, normal.dot(p), tolerance);
    }
  }

 private:
  void add_face(const Mesh& hull, const Vec3& normal, double offset, double tolerance) {
    std::vector<unsigned> corners;
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
      if (std::abs(normal.dot(hull.vertices[i]) - offset) > tolerance) continue;
      corners.push_back(static_cast<unsigned>(i));
      middle += hull.vertices[i];
    }
    middle /= static_cast<double>(corners.size());
    const Vec3 u = (hull.vertices[corners[0]] - middle).normalized(), v = normal.cross(u);
    const auto angle = [&](unsigned i) {
      const Vec3 d = hull.vertices[i] - middle;
      return std::atan2(d.dot(v), d.dot(u));
    };
    std::sort(corners.begin(), corners.end(), [&](unsigned i, unsigned k) { return angle(i) < angle(k); });
    planes.insert(planes.end(), {normal.x(), normal.y(), normal.z(), offset});
    polygons.push_back(static_cast<unsigned>(corners.size()));
    polygons.insert(polygons.end(), corners.begin(), corners.end());
    ++faces;
  }
};

class OdeWorld final : public PeerWorld {
 public:
  OdeWorld(const WorldDef& def, const PeerSettings& settings) : def_(def), scale_(def) {
    static const int initialised = dInitODE2(0);
    static_cast<void>(initialised);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    const Vec3 g = def.gravity * scale_.length;
    dWorldSetGravity(world_, g.x(), g.y(), g.z());
    dWorldSetQuickStepNumIterations(world_, settings.iterations);
    dWorldSetContactSurfaceLayer(world_, surface_layer);
    dWorldSetContactMaxCorrectingVel(world_, 1.0);
    for (std::size_t p = 0; p < def.parts.size(); ++p) {
      convexes_.emplace_back();
      boxes_.emplace_back();
      for (std::vector<Vec3> piece : settings.pieces[p]) {
        for (Vec3& v : piece) v = scale_.length * (v - def.parts[p]->mass().center);
        Aabb box;
        if (is_box(piece, box))
          boxes_.back().push_back(box);
        else
          convexes_.back().emplace_back(piece);
      }
    }
    bodies_.assign(def.bodies.size(), nullptr);
    spaces_.assign(def.bodies.size(), nullptr);
    add_walls();
  }
  ~OdeWorld() override {
    dJointGroupDestroy(contacts_);
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b]) remove(b);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void insert(std::size_t b, const BodyState& state) override {
    if (!bodies_[b]) create(b);
    const Vec3 x = scale_.length * (state.pose * part(b).mass().center), v = scale_.length * state.velocity.linear;
    const Quat& q = state.pose.orientation;
    const Vec3& w = state.velocity.angular;
    dBodySetPosition(bodies_[b], x.x(), x.y(), x.z());
    const dQuaternion turn = {q.w(), q.x(), q.y(), q.z()};
    dBodySetQuaternion(bodies_[b], turn);
    dBodySetLinearVel(bodies_[b], v.x(), v.y(), v.z());
    dBodySetAngularVel(bodies_[b], w.x(), w.y(), w.z());
  }
  void remove(std::size_t b) override {
    dSpaceDestroy(spaces_[b]);  // with its shapes
    dBodyDestroy(bodies_[b]);
    spaces_[b] = nullptr;
    bodies_[b] = nullptr;
  }
  void step(double dt) override {
    dSpaceCollide(space_, this, &near_pair);
    dWorldQuickStep(world_, dt);
    dJointGroupEmpty(contacts_);
  }
  BodyState state(std::size_t b) const override {
    const dReal *x = dBodyGetPosition(bodies_[b]), *q = dBodyGetQuaternion(bodies_[b]),
                *v = dBodyGetLinearVel(bodies_[b]), *w = dBodyGetAngularVel(bodies_[b]);
    BodyState state;
    state.pose.orientation = Quat(q[0], q[1], q[2], q[3]).normalized();
    state.pose.position = Vec3(x[0], x[1], x[2]) / scale_.length - state.pose.orientation * part(b).mass().center;
    state.velocity = {Vec3(v[0], v[1], v[2]) / scale_.length, Vec3(w[0], w[1], w[2])};
    return state;
  }

 private:
  const PartModel& part(std::size_t b) const { return *def_.parts[def_.bodies[b].part]; }

  void create(std::size_t b) {
    const BodyDef& def = def_.bodies[b];
    bodies_[b] = dBodyCreate(world_);
    if (def.fixed) dBodySetKinematic(bodies_[b]);
    const MassProperties& m = part(b).mass();
    const double mass = def.mass * scale_.mass;
    const Mat3 I = m.inertia * (mass / m.volume * scale_.length * scale_.length);
    dMass given;
    dMassSetParameters(&given, mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
    dBodySetMass(bodies_[b], &given);
    dBodySetData(bodies_[b], const_cast<BodyDef*>(&def));
    spaces_[b] = dSimpleSpaceCreate(space_);
    for (const Convex& c : convexes_[def.part])
      dGeomSetBody(dCreateConvex(spaces_[b], c.planes.data(), c.faces, c.points.data(),
                                 static_cast<unsigned>(c.points.size() / 3), c.polygons.data()),
                   bodies_[b]);
    for (const Aabb& box : boxes_[def.part]) {
      const Vec3 size = box.size(), center = box.center();
      const dGeomID geom = dCreateBox(spaces_[b], size.x(), size.y(), size.z());
      dGeomSetBody(geom, bodies_[b]);
      dGeomSetOffsetPosition(geom, center.x(), center.y(), center.z());
    }
  }

  void add_walls() {
    if (def_.bin.kind == Bin::Kind::none) return;
    dCreatePlane(space_, 0, 0, 1, 0);
    if (def_.bin.kind != Bin::Kind::box) return;
    const Vec3 half = 0.5 * scale_.length * def_.bin.inner_size;
    const double height = scale_.length * def_.wall_height;
    for (const double side : {-1.0, 1.0}) {
      dGeomSetPosition(dCreateBox(space_, wall, 2 * (half.y() + wall), height), side * (half.x() + wall / 2), 0,
                       height / 2);
      dGeomSetPosition(dCreateBox(space_, 2 * (half.x() + wall), wall, height), 0, side * (half.y() + wall / 2),
                       height / 2);
    }
  }

  static void near_pair(void* self, dGeomID a, dGeomID b) {
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
      dSpaceCollide2(a, b, self, &near_pair);
      return;
    }
    static_cast<OdeWorld*>(self)->collide(a, b);
  }

  void collide(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (body_a == body_b) return;  // pieces of one part, or two walls
    dContact contacts[contacts_per_pair];
    const int count = dCollide(a, b, contacts_per_pair, &contacts[0].geom, sizeof(dContact));
    const auto material = [&](dBodyID body) {
      if (body) return *static_cast<const BodyDef*>(dBodyGetData(body));
      BodyDef walls;
      walls.friction = def_.bin.friction;
      walls.restitution = def_.bin.restitution;
      return walls;
    };
    const BodyDef m = material(body_a), n = material(body_b);
    for (int i = 0; i < count; ++i) {
      dSurfaceParameters& surface = contacts[i].surface;
      surface.mode = dContactBounce | dContactApprox1;
      surface.mu = std::sqrt(m.friction * n.friction);
      surface.bounce = std::max(m.restitution, n.restitution);
      surface.bounce_vel = 0.5;
      dJointAttach(dJointCreateContact(world_, contacts_, &contacts[i]), body_a, body_b);
    }
  }

  const WorldDef& def_;
  PeerScale scale_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<std::vector<Convex>> convexes_;  ///< by part
  std::vector<std::vector<Aabb>> boxes_;
  std::vector<dBodyID> bodies_;
  std::vector<dSpaceID> spaces_;  ///< one a body, for its pieces
};

}  // namespace

std::unique_ptr<PeerWorld> make_ode_world(const WorldDef& def, const PeerSettings& settings) {
  return std::make_unique<OdeWorld>(def, settings);
}

}  // namespace bin_scenes::bench
