#include "solver/sphere_gl/convert.hpp"

#include "bin_scenes/core/contact.hpp"

#include <cmath>

namespace bin_scenes::sphere_gl {

using namespace sphere;

namespace {

gpu::vec4 force_of(const Contact& c) {
  return {c.normal_force, c.friction_force.x(), c.friction_force.y(), c.friction_force.z()};
}

}  // namespace

gpu::SphereBody to_gpu(const Body& body, float diagonal, std::uint32_t shape, std::uint32_t world) {
  return {{shape, world, 0, 0}, {body.inverse_mass, body.friction, body.restitution, diagonal}};
}

gpu::SphereState state_of(const Body& b) {
  const std::uint32_t flags = (b.present ? SPHERE_PRESENT : 0u) | (b.asleep ? SPHERE_ASLEEP : 0u);
  return {vec4(b.x),       vec4(b.q),      vec4(b.v),      vec4(b.w),       vec4(b.still_x, b.still),
          vec4(b.still_q), vec4(b.x_rest), vec4(b.v_rest), {flags, 0, 0, 0}};
}

void read_state(const gpu::SphereState& state, Body& b) {
  b.x = vec3(state.position);
  b.q = quat(state.orientation);
  b.v = vec3(state.velocity);
  b.w = vec3(state.spin);
  b.still_x = vec3(state.still_position);
  b.still = state.still_position.w;
  b.still_q = quat(state.still_orientation);
  b.x_rest = vec3(state.position_rest);
  b.v_rest = vec3(state.velocity_rest);
  b.present = state.flags.x & SPHERE_PRESENT;
  b.asleep = state.flags.x & SPHERE_ASLEEP;
}

gpu::SphereSettingsBlock to_gpu(const Settings& s) {
  gpu::SphereSettingsBlock out{};
  out.time_step = s.time_step;
  out.sub_steps = static_cast<gpu::uint>(s.sub_steps);
  out.cut_steps = s.cut_steps;
  const auto softness = [&](const Softness& c) -> gpu::vec4 {
    return {c.hertz_share, c.damping_ratio, c.slop, static_cast<float>(c.refinement)};
  };
  out.sweeps = static_cast<gpu::uint>(s.sweeps);
  out.cold_sweeps = static_cast<gpu::uint>(s.cold_sweeps);
  for (const Stiffness stiffness : {Stiffness::soft, Stiffness::stiff, Stiffness::rigid})
    out.softness[static_cast<std::size_t>(stiffness)] = softness(s.softness(stiffness));
  out.probe_slip = s.probe_slip;
  out.patch_radius = s.patch_radius;
  out.push_speed = s.push_speed;
  out.margin = s.margin;
  out.recycle = s.recycle;
  out.coarse_recycle = s.coarse_recycle;
  out.pressed_recycle = s.pressed_recycle;
  out.rest_move = s.rest_move;
  out.touch_move = s.touch_move;
  out.restitution_speed = s.restitution_speed;
  out.rest_window = s.rest_window;
  return out;
}

void copy_phase(const World& world, gpu::SphereProgress& progress) {
  progress.fine = world.fine ? 1 : 0;
  static_assert(static_cast<gpu::uint>(Stiffness::soft) == SPHERE_SOFT &&
                static_cast<gpu::uint>(Stiffness::rigid) == SPHERE_RIGID);
  progress.stiffness = static_cast<gpu::uint>(world.stiffness);
  progress.friction_share = world.friction_share;
  static_assert(static_cast<gpu::uint>(sphere::Sleep::by_part) == SPHERE_SLEEP_BY_PART &&
                static_cast<gpu::uint>(sphere::Sleep::by_touch) == SPHERE_SLEEP_BY_TOUCH);
  progress.sleep = static_cast<gpu::uint>(world.sleep);
  progress.refinement = static_cast<gpu::uint>(world.refinement());
  progress.effort = static_cast<gpu::uint>(world.sweep_effort());
  progress.forgets = world.forgets ? 1 : 0;
  if (world.forgets) progress.cold_steps = static_cast<gpu::uint>(world.cold_steps);
}

gpu::SpherePlane to_gpu(const Plane& plane) {
  return {vec4(plane.normal, plane.offset), {plane.wall ? 1u : 0u, 0, 0, 0}};
}

ManifoldImage to_gpu(const World& world, std::uint32_t first_body) {
  ManifoldImage image;
  image.ranges.assign(world.bodies.size(), {0, 0, 0, 0});
  for (const Manifold& m : world.manifolds) {
    const auto p = static_cast<std::uint32_t>(image.pairs.size());
    gpu::uvec4& range = image.ranges[m.a];
    if (range.y == 0) range.x = range.z = p;
    range.y = range.w = p + 1;
    image.pairs.push_back({first_body + m.a, m.b == ground ? SPHERE_GROUND : first_body + m.b, p, SPHERE_NO_COLOR});
    std::uint32_t presses = 0;
    image.contacts.resize(SPHERE_MAX_CONTACTS * static_cast<std::size_t>(p + 1));
    gpu::SphereContact* next = &image.contacts[SPHERE_MAX_CONTACTS * static_cast<std::size_t>(p)];
    for (const Contact& c : m.contacts) {
      if (c.normal_force > 0) presses = 1;
      *next++ = {three(c.anchor_a), c.feature, three(c.anchor_b), 0, vec4(c.local_normal), force_of(c)};
    }
    image.manifolds.push_back({{static_cast<std::uint32_t>(m.contacts.size()), presses, m.found ? 1u : 0u, 0},
                               three(m.found_x),
                               0,
                               vec4(m.found_q)});
  }
  return image;
}

std::vector<Manifold> to_cpu(const ManifoldImage& image, const World& world, std::uint32_t first_body) {
  std::vector<Manifold> out;
  for (const gpu::SpherePair& pair : image.pairs) {
    Manifold m;
    m.a = pair.a - first_body;
    m.b = pair.b == SPHERE_GROUND ? ground : pair.b - first_body;
    m.color = static_cast<int>(pair.color);
    const gpu::SphereManifold& from = image.manifolds[pair.slot];
    m.contacts.resize(from.state.x);
    m.found = from.state.z;
    m.found_x = vec3(from.found_position);
    m.found_q = quat(from.found_orientation);
    const Body& a = world.bodies[m.a];
    const bool on_ground = m.b == ground;
    m.friction = pair_friction(a.friction, on_ground ? world.ground_friction : world.bodies[m.b].friction);
    m.restitution = std::max(a.restitution, on_ground ? world.ground_restitution : world.bodies[m.b].restitution);
    const gpu::SphereContact* next = &image.contacts[SPHERE_MAX_CONTACTS * static_cast<std::size_t>(pair.slot)];
    for (Contact& c : m.contacts) {
      const gpu::SphereContact& g = *next++;
      c.anchor_a = vec3(g.anchor_a);
      c.anchor_b = vec3(g.anchor_b);
      c.local_normal = vec3(g.normal);
      c.feature = g.feature;
      c.normal_force = g.force.x;
      c.friction_force = {g.force.y, g.force.z, g.force.w};
    }
    out.push_back(m);
  }
  return out;
}

}  // namespace bin_scenes::sphere_gl
