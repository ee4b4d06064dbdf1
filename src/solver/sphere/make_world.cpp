/// Fills a World from the common definition, places bodies, and takes phases. Both forms, passes and sphere_gl, begin
/// from it.
#include "solver/sphere/make_world.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "solver/sphere/effort.hpp"
#include "solver/step_limit.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace bin_scenes::sphere {

namespace {

/// Heaviest / lightest part, times the number of bodies, of worlds that solve impacts exactly: 120 for 48 bodies.
/// Beyond it, the sweeps take too long.
constexpr float exact_work = 120 * 48;
/// Sweeps in which an impact with a light part between heavy ones is shared, times heaviest / lightest part. Theory
/// asks for half the logarithm of speed / tolerance, 6. With 20, rounding has moved the light part by 2e-4 of the
/// speed.
constexpr float least_exact_sweeps = 10;

Body make_body(const Shape& shape, std::uint32_t index, const BodyDef& def) {
  Body body;
  body.shape = index;
  body.friction = static_cast<float>(def.friction);
  body.restitution = static_cast<float>(def.restitution);
  body.inverse_mass = def.fixed ? 0.0f : static_cast<float>(1.0 / def.mass);
  body.inertia = shape.unit_inertia * static_cast<float>(def.mass);
  // In double precision: the determinant of a half-millimetre part's inertia is below what single precision can
  // distinguish from 0.
  if (!def.fixed) body.inverse_inertia = body.inertia.cast<double>().inverse().cast<float>();
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

}  // namespace

World make_world(const WorldDef& def, const SphereSettings& settings,
                 const std::function<const Shape&(const PartModelPtr&)>& shape_of, const Settings& base) {
  World w;
  w.scene = def.scene;
  w.settings = base;
  w.settings.sub_steps = settings.sub_steps;
  w.settings.cut_steps = base.cut_steps && settings.cut_steps;
  if (base.recycle > 0) {
    w.settings.recycle = static_cast<float>(settings.recycle);
    w.settings.coarse_recycle = static_cast<float>(3.0 * settings.recycle);
    w.settings.pressed_recycle = static_cast<float>(std::min(settings.recycle, settings.pressed_recycle));
  }
  w.gravity = def.gravity.cast<float>();
  w.wall_top = static_cast<float>(def.wall_height);
  w.ground_friction = static_cast<float>(def.bin.friction);
  w.ground_restitution = static_cast<float>(def.bin.restitution);
  w.planes = planes_of(def.bin);
  for (const PartModelPtr& part : def.parts) w.shapes.push_back(&shape_of(part));
  BIN_SCENES_ASSERT(each_is(def.bodies, [&](const BodyDef& body) { return body.part < def.parts.size(); }));
  for (const BodyDef& body : def.bodies)
    w.bodies.push_back(make_body(*w.shapes[body.part], static_cast<std::uint32_t>(body.part), body));
  if (def.bin.kind == Bin::Kind::mesh) {
    const auto index = static_cast<std::uint32_t>(w.shapes.size());
    w.shapes.push_back(&shape_of(def.bin_model));
    BodyDef bin;
    bin.fixed = true;
    bin.friction = def.bin.friction;
    bin.restitution = def.bin.restitution;
    w.bodies.push_back(make_body(*w.shapes[index], index, bin));
    place(w, w.bodies.size() - 1, {def.bin.pose, {}});
  }
  w.smallest_size = w.thinnest = w.least_thickness = std::numeric_limits<float>::max();
  for (const BodyDef& body : def.bodies) {
    w.thinnest = std::min(w.thinnest, w.shapes[body.part]->wall);
    w.least_thickness = std::min(w.least_thickness, w.shapes[body.part]->thickness);
  }
  for (const Shape* s : w.shapes) w.smallest_size = std::min(w.smallest_size, s->size);
  w.cold_steps = w.settings.cold_steps;
  w.cuts =
      w.settings.cut_steps ? step_cuts(settings.time_step, def.gravity.norm(), w.smallest_size, settings.step_fall) : 1;
  w.settings.time_step = w.whole_step = static_cast<float>(settings.time_step / w.cuts);
  w.effort = effort_to_come(w, def);
  BIN_SCENES_ASSERT(w.effort >= 1 && w.cuts >= 1 && w.settings.sub_steps >= 1);
  BIN_SCENES_ASSERT(each_is(w.bodies, [](const Body& b) { return b.inverse_mass >= 0 && b.inertia.allFinite(); }));
  w.mass_ratio = mass_ratio_of(w);
  w.exact_impacts = def.exact_impacts && w.mass_ratio * static_cast<float>(w.bodies.size()) <= exact_work;
  if (w.exact_impacts)
    w.settings.most_impact_sweeps =
        std::max(w.settings.most_impact_sweeps, static_cast<int>(least_exact_sweeps * w.mass_ratio));
  w.mass_effort = effort_of_masses(w);
  w.settings.push_speed = push_speed_of_masses(w);
  return w;
}

std::vector<Flag> flags_of(const World& world) {
  std::vector<Flag> flags, shapes;
  if (world.cuts > 1)
    flags.push_back(
        step_cut_flag("solver.sphere.time_step", world.whole_step * world.cuts, world.cuts, world.smallest_size));
  for (auto shape = world.shapes.begin(); shape != world.shapes.end(); ++shape)
    if (std::find(world.shapes.begin(), shape, *shape) == shape)  // lines may share one
      shapes.insert(shapes.end(), (*shape)->flags.begin(), (*shape)->flags.end());
  if (shapes.empty()) return flags;
  // Of hundreds of models one stands for all: they have but one kind of flag.
  flags.push_back(shapes[0]);
  if (shapes.size() > 1) flags.back().text += "; so have those of " + std::to_string(shapes.size() - 1) + " more parts";
  return flags;
}

void place(World& world, std::size_t body, const BodyState& state) {
  BIN_SCENES_ASSERT(body < world.bodies.size() && is_rigid(state.pose));
  Body& b = world.bodies[body];
  b.q = state.pose.orientation.cast<float>().normalized();
  b.x = state.pose.position.cast<float>() + b.q * world.shapes[b.shape]->center;
  b.v = state.velocity.linear.cast<float>();
  b.w = state.velocity.angular.cast<float>();
  b.x_rest.setZero();
  b.v_rest.setZero();
  b.driven = b.inverse_mass == 0 && !(b.v.isZero() && b.w.isZero());
  b.present = true;
  b.asleep = false;
  b.still = 0;
  b.still_x = b.x;
  b.still_q = b.q;
}

void set_jaws(World& world, const Jaws& jaws) {
  BIN_SCENES_ASSERT(jaws.first != jaws.second && std::max(jaws.first, jaws.second) < world.bodies.size());
  JawPair pair;
  pair.first = static_cast<std::uint32_t>(jaws.first);
  pair.second = static_cast<std::uint32_t>(jaws.second);
  pair.axis = jaws.axis.cast<float>().normalized();
  pair.velocity = jaws.velocity.cast<float>();
  pair.force = static_cast<float>(jaws.force);
  pair.speed = static_cast<float>(jaws.speed);
  pair.mass = static_cast<float>(jaws.mass);
  world.jaws = pair;
  for (const std::uint32_t jaw : {pair.first, pair.second}) world.bodies[jaw].driven = true;
}

void set_force(World& world, std::size_t body, const Vec3& force, const Vec3& point) {
  BIN_SCENES_ASSERT(body < world.bodies.size() && force.allFinite() && point.allFinite());
  Body& b = world.bodies[body];
  const Pull pull{static_cast<std::uint32_t>(body), force.cast<float>(),
                  b.q.conjugate() * Vec3f(point.cast<float>() - b.x)};
  const auto known =
      std::find_if(world.pulls.begin(), world.pulls.end(), [&](const Pull& other) { return other.body == pull.body; });
  if (known == world.pulls.end())
    world.pulls.push_back(pull);
  else
    *known = pull;
  wake(b);
}

bool take_phase(World& world, const Phase& phase) {
  const float friction_share = world.settings.friction_reserve ? static_cast<float>(phase.friction) : 1.0f;
  if (phase.fine_samples == world.fine && phase.stiffness == world.stiffness &&
      friction_share == world.friction_share && phase.sleep == world.sleep && !phase.forgets && !phase.begins_asleep)
    return false;
  world.fine = phase.fine_samples;
  world.stiffness = phase.stiffness;
  world.friction_share = friction_share;
  world.sleep = phase.sleep;
  world.forgets = phase.forgets;
  world.effort = effort_of(world);
  if (phase.forgets)
    world.cold_steps =
        phase.stiffness == Stiffness::rigid ? world.settings.cold_steps : world.settings.pressed_cold_steps;
  return true;
}

void set_phase(World& world, const Phase& phase) {
  const bool fine = world.fine;
  if (!take_phase(world, phase)) return;
  if (fine != world.fine || phase.forgets)  // node numbers mean other points now, or nothing is to be remembered
    for (Manifold& m : world.manifolds) m.found = false;
  for (Body& b : world.bodies) {
    if (phase.begins_asleep)
      put_to_sleep(world.settings, b);
    else
      wake(b);
  }
}

BodyState state_of(const World& world, std::size_t body) {
  const Body& b = world.bodies[body];
  BodyState state;
  if (!b.present && b.still_x.isZero()) {
    state.pose.position = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return state;
  }
  state.pose.orientation = b.q.cast<double>().normalized();
  state.pose.position = b.x.cast<double>() + b.x_rest.cast<double>() -
                        state.pose.orientation * world.shapes[b.shape]->center.cast<double>();
  state.velocity = {b.v.cast<double>(), b.w.cast<double>()};
  return state;
}

std::vector<ContactForce> forces_of(const World& world, std::size_t bodies) {
  // The bin is the last body, or the ground, and so never the first of two.
  const auto named = [&](std::uint32_t body) { return body < bodies ? static_cast<int>(body) : -1; };
  std::vector<ContactForce> forces;
  for (const Manifold& m : world.manifolds) {
    const Body &a = world.bodies[m.a], *b = m.b == ground ? nullptr : &world.bodies[m.b];
    for (const Contact& c : m.contacts) {
      if (c.normal_force <= 0) continue;
      const bool field_of_a = c.feature >> 31;
      const Vec3f normal = field_of_a ? Vec3f(a.q * c.local_normal) : b ? Vec3f(b->q * c.local_normal) : c.local_normal;
      const Vec3f on_a = a.x + a.q * c.anchor_a, on_b = b ? Vec3f(b->x + b->q * c.anchor_b) : c.anchor_b;
      forces.push_back({static_cast<int>(m.a), named(m.b), on_a.cast<double>(), normal.cast<double>(),
                        Vec3f(c.normal_force * normal + c.friction_force).cast<double>(), normal.dot(on_b - on_a)});
    }
  }
  return forces;
}

WorstContact take_worst_contact(World& world, std::size_t bodies) {
  const auto named = [&](std::uint32_t body) { return body < bodies ? static_cast<int>(body) : -1; };
  const DeepestContact d = std::exchange(world.deepest, {});
  return {named(d.a), named(d.b), d.depth, d.relative, world.clock - d.time, d.unresolved_impacts};
}

}  // namespace bin_scenes::sphere
