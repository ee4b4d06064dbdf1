/// Loads contacts of eight manifolds into lanes, with masses and levers, and stores their forces back. GPU form:
/// shaders/sphere/contact_row.h.
#include "solver/sphere/passes/contact_rows.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

namespace {

constexpr int shared_color = SPHERE_COLORS - 1;  ///< its manifolds found no color of their own: one to a bundle

/// @param contact_time  StepPlan::contact_time (s)
/// @param body      null for the ground
Ahead ahead_of(float contact_time, const Body* body) {
  if (!body || !body->moves()) return {Vec3f::Zero(), Vec3f::Zero()};
  return {contact_time * body->v, contact_time * body->w};
}

/// Bodies of a manifold; b is null for the ground.
struct Bodies {
  const Body& a;
  const Body* b;
  Ahead ahead_a, ahead_b;

  Bodies(float contact_time, const Body& first, const Body* second)
      : a(first), b(second), ahead_a(ahead_of(contact_time, &first)), ahead_b(ahead_of(contact_time, second)) {}
};

void set_lane(ContactRows& rows, int lane, Contact& c, const Bodies& bodies, float warm) {
  const Body &a = bodies.a, *b = bodies.b;
  const bool field_of_a = c.feature >> 31;
  c.normal = field_of_a ? Vec3f(a.rotation * c.local_normal) : b ? Vec3f(b->rotation * c.local_normal) : c.local_normal;
  Vec3f ra = a.rotation * c.anchor_a, rb = b ? Vec3f(b->rotation * c.anchor_b) : c.anchor_b;
  rows.separation[lane] = ((b ? b->x : Vec3f(Vec3f::Zero())) + rb - a.x - ra).dot(c.normal);
  move_to_contact_time(field_of_a, bodies.ahead_a, bodies.ahead_b, ra, rb, c.normal);
  const Vec3f t1 = c.normal.unitOrthogonal();
  rows.normal.set(lane, c.normal);
  rows.tangent.set(lane, t1);
  rows.ra.set(lane, ra);
  rows.rb.set(lane, rb);
  rows.normal_impulse[lane] = warm * c.normal_force;
  rows.t1_impulse[lane] = warm * c.friction_force.dot(t1);
  rows.t2_impulse[lane] = warm * c.friction_force.dot(c.normal.cross(t1));
}

Lanes tangent_mass(const LaneVec& tangent, const ContactRows& c, const Bundle& bundle, Lanes inverse_masses) {
  const LaneVec moment_a = cross(c.ra, tangent), moment_b = cross(c.rb, tangent);
  return effective_mass(inverse_masses, moment_a, bundle.inverse_inertia_a * moment_a, moment_b,
                        bundle.inverse_inertia_b * moment_b);
}

/// What follows from levers, normals and inertia.
void set_masses(const Bundle& bundle, Lanes inverse_masses, ContactRows& c) {
  c.moment_a = cross(c.ra, c.normal);
  c.moment_b = cross(c.rb, c.normal);
  c.turn_a = bundle.inverse_inertia_a * c.moment_a;
  c.turn_b = bundle.inverse_inertia_b * c.moment_b;
  c.normal_mass = effective_mass(inverse_masses, c.moment_a, c.turn_a, c.moment_b, c.turn_b);
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  c.tangent_mass = min(tangent_mass(c.tangent, c, bundle, inverse_masses),
                       tangent_mass(cross(c.normal, c.tangent), c, bundle, inverse_masses));
}

/// Where a body is in the midst of the step.
struct Place {
  Vec3f x = Vec3f::Zero();
  Mat3f rotation = Mat3f::Identity(), inverse_inertia = Mat3f::Zero();

  Place(const Body* body, const Motion& motion) {
    if (!body) return;
    x = body->x + Vec3f(motion.moved[0], motion.moved[1], motion.moved[2]);
    rotation = integrated(Quatf::Identity(), Vec3f(motion.turned[0], motion.turned[1], motion.turned[2]), 1.0f)
                   .toRotationMatrix() *
               body->rotation;
    if (motion.inverse_mass() > 0) inverse_inertia = rotation * body->inverse_inertia * rotation.transpose();
  }
};

}  // namespace

std::uint32_t make_bundles(const World& world, const Blocks& blocks, std::size_t block, std::vector<Bundle>& bundles,
                           std::vector<Color>& colors, std::vector<ContactRows>& rows) {
  const Slice order = blocks.manifolds(block);
  const auto color = [&](std::uint32_t manifold) { return world.manifolds[manifold].color; };
  std::uint32_t row = 0, pieces = 1;
  bundles.clear();
  colors.clear();
  for (auto next = order.begin(); next != order.end();) {
    const int own_color = color(*next);
    const int most = own_color == shared_color ? 1 : lane_count;
    const auto index = static_cast<std::uint32_t>(bundles.size());
    if (index == 0 || bundles.back().color != own_color) colors.push_back({index, index, own_color == shared_color});
    const std::uint32_t piece = colors.back().in_turn ? 0 : (index - colors.back().first) / bundles_per_piece;
    pieces = std::max(pieces, piece + 1);
    colors.back().last = index + 1;
    Bundle& bundle = bundles.emplace_back();
    bundle.color = own_color;
    const auto place = [&](std::uint32_t body) {
      const std::uint32_t at = blocks.place(block, body);
      return at < blocks.bodies(block).size() ? at : at + piece;
    };
    bundle.a.fill(place(ground));
    bundle.b = bundle.a;
    bundle.first = bundle.last = row;
    for (; bundle.lanes < most && next != order.end() && color(*next) == own_color; ++next) {
      const int lane = bundle.lanes++;
      const Manifold& m = world.manifolds[bundle.manifold[lane] = *next];
      bundle.last = std::max(bundle.last, bundle.first + static_cast<std::uint32_t>(m.contacts.size()));
      bundle.a[lane] = place(m.a);
      bundle.b[lane] = place(m.b);
    }
    row = bundle.last;
  }
  for (const Color& c : colors)
    for (std::uint32_t i = c.first; !c.in_turn && i + 1 < c.last; i += 2) bundles[i].paired = true;
  BIN_SCENES_ASSERT(colors.empty() ? bundles.empty() : colors.back().last == bundles.size());
  BIN_SCENES_ASSERT(each_is(bundles, [](const Bundle& b) {
    return b.lanes > 0 && b.lanes <= lane_count && b.rows() > 0 && b.rows() <= max_contacts;
  }));
  rows.resize(row);
  return pieces;
}

BIN_SCENES_WIDE
void prepare(World& world, const std::vector<Motion>& motions, float h, Bundle& bundle,
             std::vector<ContactRows>& rows) {
  for (std::uint32_t i = bundle.first; i < bundle.last; ++i) {  // of lanes that have no such contact
    ContactRows& c = rows[i];
    for (LaneVec* v : {&c.normal, &c.tangent, &c.ra, &c.rb}) *v = LaneVec{};
    for (Lanes* v : {&c.normal_impulse, &c.t1_impulse, &c.t2_impulse, &c.separation, &c.max_impulse}) *v = Lanes{};
  }
  const float warm = world.forgets || !world.settings.warm_start
                         ? 0.0f
                         : h;  // s for which the last forces have acted when the sweeps begin
  const float contact_time = world.plan().contact_time;
  // What has not moved lately, such as a part that an impact has woken, is held up by something.
  const auto falls_freely = [](const Body& body) { return body.moves() && body.inverse_mass > 0 && body.still == 0; };
  Lanes falls{};
  for (int lane = 0; lane < bundle.lanes; ++lane) {
    Manifold& m = world.manifolds[bundle.manifold[lane]];
    const Body& a = world.bodies[m.a];
    const Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
    bundle.friction[lane] = world.friction_share * m.friction;
    bundle.restitution[lane] = m.restitution;
    falls[lane] = static_cast<float>(b && falls_freely(*b)) - static_cast<float>(falls_freely(a));
    const bool rolls = world.is_ball(a) || (b && world.is_ball(*b));
    bundle.refreshed[lane] = rolls ? 0 : -1;
    bundle.tipping_arm[lane] = rolls ? 0.0f : world.settings.patch_radius * world.smallest_size;
    if (motions[bundle.a[lane]].inverse_mass() > 0) bundle.inverse_inertia_a.set(lane, a.world_inverse_inertia);
    if (b && motions[bundle.b[lane]].inverse_mass() > 0) bundle.inverse_inertia_b.set(lane, b->world_inverse_inertia);
    const Bodies bodies(contact_time, a, b);
    for (std::uint32_t k = 0; k < m.contacts.size(); ++k)
      set_lane(rows[bundle.first + k], lane, m.contacts[k], bodies, warm);
  }
  const Velocities velocities = velocities_of(bundle, motions);
  const Vec3f& g = world.gravity;
  const LaneVec gravity{all_lanes(g.x()), all_lanes(g.y()), all_lanes(g.z())};
  const Lanes inverse_masses = velocities.inverse_mass_a + velocities.inverse_mass_b;
  for (std::uint32_t i = bundle.first; i < bundle.last; ++i) {
    ContactRows& c = rows[i];
    c.gap = c.separation;
    c.lasting = c.normal_impulse;
    set_masses(bundle, inverse_masses, c);
    c.approach = speed_at_impact(velocities.along_normal(c), c.separation, falls * dot(c.normal, gravity));
    bundle.strikes |= c.approach <= -world.settings.restitution_speed;
  }
  bundle.refreshed &= bundle.strikes;
}

BIN_SCENES_WIDE
void refresh_levers(const World& world, const std::vector<Motion>& motions, Bundle& bundle,
                    std::vector<ContactRows>& rows) {
  const Displacements moved = displacements_of(bundle, motions);
  for (int lane = 0; lane < bundle.lanes; ++lane) {
    if (!bundle.refreshed[lane]) continue;
    const Manifold& m = world.manifolds[bundle.manifold[lane]];
    const Place a(&world.bodies[m.a], motions[bundle.a[lane]]);
    const Place b(m.b == ground ? nullptr : &world.bodies[m.b], motions[bundle.b[lane]]);
    bundle.inverse_inertia_a.set(lane, a.inverse_inertia);
    bundle.inverse_inertia_b.set(lane, b.inverse_inertia);
    for (std::uint32_t k = 0; k < m.contacts.size(); ++k) {
      const Contact& c = m.contacts[k];
      ContactRows& row = rows[bundle.first + k];
      Vec3f ra, rb;
      const Vec3f on_a = a.x + a.rotation * c.anchor_a, on_b = b.x + b.rotation * c.anchor_b;
      row.gap[lane] = levers_now(a.x, on_a, b.x, on_b, ra, rb).dot(c.normal);
      row.ra.set(lane, ra);
      row.rb.set(lane, rb);
    }
  }
  const Velocities velocities = velocities_of(bundle, motions);
  for (std::uint32_t i = bundle.first; i < bundle.last; ++i) {
    set_masses(bundle, velocities.inverse_mass_a + velocities.inverse_mass_b, rows[i]);
    rows[i].separation = bundle.refreshed ? rows[i].gap - moved.along(rows[i]) : rows[i].separation;
  }
}

void keep_forces(const Bundle& bundle, const std::vector<ContactRows>& rows, float h, World& world) {
  for (int lane = 0; lane < bundle.lanes; ++lane) {
    Manifold& m = world.manifolds[bundle.manifold[lane]];
    for (std::uint32_t k = 0; k < m.contacts.size(); ++k) {
      const ContactRows& c = rows[bundle.first + k];
      const Vec3f t1 = c.tangent.at(lane), t2 = c.normal.at(lane).cross(t1);
      m.contacts[k].normal_force = c.normal_impulse[lane] / h;
      m.contacts[k].friction_force = (c.t1_impulse[lane] * t1 + c.t2_impulse[lane] * t2) / h;
    }
  }
}

}  // namespace bin_scenes::sphere
