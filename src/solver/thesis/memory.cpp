/// Lays worlds out in the arrays that the device reads. The CPU twins work on the same arrays.
#include "memory.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::thesis {

namespace {

gpu::uint word(std::size_t n) {
  return static_cast<gpu::uint>(n);
}

constexpr std::size_t least_slots = 4096;  // a few spheres may touch more than the mean at once

std::size_t slots_of(std::size_t moving_spheres, const Capacity& capacity) {
  return static_cast<std::size_t>(std::ceil(static_cast<double>(moving_spheres) * capacity.mean_contacts));
}

double largest_radius(const World& world) {
  double radius = 0.0;
  for (const Shape& shape : world.shapes)
    for (const Sphere& sphere : shape.spheres) radius = std::max(radius, sphere.radius);
  for (const Sphere& sphere : world.bin_spheres) radius = std::max(radius, sphere.radius);
  return radius;
}

/// Origin and cells of the grid: the part of the domain where bodies are or may come within `horizon` and the spheres
/// of the bin, at most grid_size cells along an axis, then about the centre one of the bodies. What lies outside goes
/// to the outer cells.
void lay_grid(const World& world, const ThesisSettings& settings, double horizon, gpu::ThesisWorld& out) {
  const double cell = std::max(1.0, settings.cell_size) * 2.0 * std::max(largest_radius(world), 1e-6);
  Aabb reach;
  std::vector<double> along[3];
  for (std::size_t b = 0; b < world.bodies.size(); ++b) {
    const gpu::ThesisState& state = world.states[b];
    const Vec3 p(state.position.x, state.position.y, state.position.z);
    const Vec3 v(state.velocity.x, state.velocity.y, state.velocity.z);
    if (!world.present[b] || !p.allFinite() || !v.allFinite()) continue;
    const double margin =
        world.shapes[world.bodies[b].part].radius + v.norm() * horizon + 0.5 * world.gravity.norm() * horizon * horizon;
    reach.extend(p - Vec3::Constant(margin));
    reach.extend(p + Vec3::Constant(margin));
    for (int a = 0; a < 3; ++a) along[a].push_back(p[a]);
  }
  if (reach.empty()) {
    reach.extend(Vec3::Zero());
  } else {
    // All of the bin's: what is outside gathers in the outer cells, and ordering a cell takes its count squared.
    for (const Sphere& sphere : world.bin_spheres) reach.extend(sphere.center);
  }
  if (!world.domain.empty()) {
    reach.lower = reach.lower.cwiseMax(world.domain.lower).cwiseMin(world.domain.upper);
    reach.upper = reach.upper.cwiseMin(world.domain.upper).cwiseMax(reach.lower);
  }
  Vec3 origin = reach.lower;
  std::size_t cells[3];
  for (int a = 0; a < 3; ++a) {
    const double wanted = std::floor((reach.upper[a] - reach.lower[a]) / cell) + 1.0;
    cells[a] = static_cast<std::size_t>(std::min(wanted, static_cast<double>(settings.grid_size)));
    if (wanted > settings.grid_size) {
      std::nth_element(along[a].begin(), along[a].begin() + static_cast<long>(along[a].size() / 2), along[a].end());
      const double half = 0.5 * cell * settings.grid_size;
      origin[a] = std::clamp(along[a][along[a].size() / 2] - half, reach.lower[a], reach.upper[a] - 2.0 * half);
    }
  }
  out.origin = vec4(origin, 1.0 / cell);
  out.grid = {word(cells[0]), word(cells[1]), word(cells[2]), 0};
}

/// A world's grid from `first_cell` on, and its sheets; returns how many cells it has. dt: s, of a sub-step.
std::size_t add_world(Memory& m, const World& world, const ThesisSettings& settings, double horizon, double dt,
                      std::size_t first_cell) {
  gpu::ThesisWorld out{};
  const double rest = settings.rest_velocity > 0.0 ? settings.rest_velocity : 2.0 * world.gravity.norm() * dt;
  out.gravity = vec4(world.gravity, rest);
  lay_grid(world, settings, horizon, out);
  out.grid.w = word(first_cell);
  out.sheets = {word(m.sheets.size()), word(world.sheets.size()), 0, 0};
  m.sheets.insert(m.sheets.end(), world.sheets.begin(), world.sheets.end());
  m.worlds.push_back(out);
  return std::size_t{out.grid.x} * out.grid.y * out.grid.z;
}

/// What a batch takes from the request and from how much there is. dt: s, of a sub-step.
void set_settings(Memory& m, const ThesisSettings& settings, const Capacity& capacity, double dt, std::size_t moving) {
  m.settings.bias = static_cast<float>(settings.bias / dt);
  m.settings.slop = static_cast<float>(settings.slop);
  m.settings.modified_normals = settings.modified_normals ? 1 : 0;
  m.settings.bodies = word(m.bodies.size());
  m.settings.spheres = word(m.spheres.size());
  m.settings.moving_spheres = word(moving);
  m.settings.capacity = word(capacity.contacts);
  m.settings.slots = word(std::max(least_slots, slots_of(moving, capacity)));
  m.settings.neighbour_slots = word(capacity.neighbours);
  m.settings.iterations = word(static_cast<std::size_t>(settings.iterations));
}

}  // namespace

Memory lay_out(const std::vector<const World*>& worlds, const ThesisSettings& settings, const Capacity& capacity,
               double horizon, std::vector<BodyIndex>& index, double share) {
  Memory m;
  index.clear();
  const double dt = settings.time_step / settings.sub_steps;
  std::vector<gpu::ThesisSphere> fixed_spheres;
  std::size_t cells = 0;
  for (std::size_t w = 0; w < worlds.size(); ++w) {
    const World& world = *worlds[w];
    cells += add_world(m, world, settings, horizon, dt, cells);

    std::vector<std::size_t> first_shape;
    const auto add_shape = [&](const std::vector<Sphere>& spheres) {
      for (const Sphere& s : spheres)
        m.shapes.push_back({vec4(s.center, s.radius), vec4(s.normal, s.normal.squaredNorm() > 0.5 ? 1.0 : 0.0)});
    };
    for (const Shape& shape : world.shapes) {
      first_shape.push_back(m.shapes.size());
      add_shape(shape.spheres);
    }
    const auto add_body = [&](const gpu::ThesisState& state, gpu::ThesisBody body, std::size_t shape,
                              std::size_t count) {
      std::vector<gpu::ThesisSphere>& list = body.inverse_inertia.w > 0.0f ? m.spheres : fixed_spheres;
      body.range = {word(list.size()), word(count), word(w), 0};
      for (std::size_t s = 0; s < count; ++s) list.push_back({word(m.bodies.size()), word(shape + s)});
      m.bodies.push_back(body);
      m.states.push_back(state);
    };
    for (std::size_t b = 0; b < world.bodies.size(); ++b) {
      if (!world.present[b]) continue;
      const BodyDef& def = world.bodies[b];
      const Shape& shape = world.shapes[def.part];
      gpu::ThesisBody body{};
      if (!def.fixed) body.inverse_inertia = vec4((def.mass * shape.gyration).cwiseInverse(), 1.0 / def.mass);
      body.surface = {static_cast<float>(def.friction), static_cast<float>(def.restitution), 0, 0};
      index.push_back({w, b});
      add_body(world.states[b], body, first_shape[def.part], shape.spheres.size());
    }
    if (!world.bin_spheres.empty()) {
      gpu::ThesisBody body{};
      body.surface = {static_cast<float>(world.bin_friction), static_cast<float>(world.bin_restitution), 0, 0};
      const std::size_t shape = m.shapes.size();
      add_shape(world.bin_spheres);
      index.push_back({w, world.bodies.size()});  // not a body of the caller's
      add_body({{0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}}, body, shape, world.bin_spheres.size());
    }
  }
  const std::size_t moving = m.spheres.size();
  m.spheres.insert(m.spheres.end(), fixed_spheres.begin(), fixed_spheres.end());
  for (gpu::ThesisBody& body : m.bodies)
    if (body.inverse_inertia.w == 0.0f) body.range.x += word(moving);

  set_settings(m, settings, capacity, dt, moving);
  m.settings.time_step = static_cast<float>(share * dt);
  m.settings.cells = word(cells);
  m.needs.resize(worlds.size());
  BIN_SCENES_ASSERT(each_is(
      m.spheres, [&](const gpu::ThesisSphere& s) { return s.body < m.bodies.size() && s.shape < m.shapes.size(); }));
  BIN_SCENES_ASSERT(index.size() == m.bodies.size());
  return m;
}

void size_scratch(Memory& m) {
  const gpu::ThesisSettingsBlock& s = m.settings;
  m.inertias.resize(s.bodies);
  m.centers.resize(s.spheres);
  m.sphere_cells.resize(s.spheres);
  m.cell_counts.resize(s.cells);
  m.cell_starts.resize(s.cells + 1);
  m.members.resize(s.spheres);
  m.sorted.resize(s.spheres);
  m.contact_ranges.resize(s.moving_spheres);
  m.contacts.resize(s.slots);
  m.neighbours.resize(std::size_t{s.bodies} * s.neighbour_slots);
  m.neighbour_counts.resize(s.bodies);
  m.touching_spheres.resize(s.moving_spheres);
  m.touching_bodies.resize(s.bodies);
  m.pushes.resize(s.moving_spheres);
}

std::size_t largest_buffer(const World& world, const ThesisSettings& settings, const Capacity& capacity) {
  std::size_t spheres = 0;
  for (std::size_t b = 0; b < world.bodies.size(); ++b)
    if (world.present[b]) spheres += world.shapes[world.bodies[b].part].spheres.size();
  gpu::ThesisWorld grid{};
  lay_grid(world, settings, 0.1, grid);
  const std::size_t cells = std::size_t{grid.grid.x} * grid.grid.y * grid.grid.z;
  return std::max({slots_of(spheres, capacity) * sizeof(gpu::ThesisContact), cells * sizeof(gpu::uint),
                   world.bodies.size() * capacity.neighbours * sizeof(gpu::ThesisNeighbour)});
}

}  // namespace bin_scenes::thesis
