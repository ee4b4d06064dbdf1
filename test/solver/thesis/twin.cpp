/// Each pass as a plain loop over the arrays of memory.hpp. GPU form: shaders/thesis.
#include "twin.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/contact.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace bin_scenes::thesis::twin {

namespace {

using V = Eigen::Vector3f;
using Q = Eigen::Quaternionf;
using M = Eigen::Matrix3f;

V v(const gpu::vec4& a) {
  return V(a.x, a.y, a.z);
}
Q q(const gpu::vec4& a) {
  return Q(a.w, a.x, a.y, a.z);
}
gpu::vec4 pack(const V& a, float w = 0.0f) {
  return {a.x(), a.y(), a.z(), w};
}

M matrix(const gpu::ThesisInertia& i) {
  M m;
  m << i.diagonal.x, i.mixed.x, i.mixed.y, i.mixed.x, i.diagonal.y, i.mixed.z, i.mixed.y, i.mixed.z, i.diagonal.z;
  return m;
}

Q turn(const V& by) {
  const float angle = by.norm();
  return angle > 0.0f ? Q(Eigen::AngleAxisf(angle, by / angle)) : Q::Identity();
}

const gpu::ThesisWorld& world_of(const Memory& m, gpu::uint body) {
  return m.worlds[m.bodies[body].range.z];
}

/// The contacts of a sphere; those of a const Memory are const.
template <class AnyMemory>
auto contacts_of(AnyMemory& m, gpu::uint sphere) {
  struct Range {
    decltype(m.contacts.data()) first;
    gpu::uint count;
    auto begin() const { return first; }
    auto end() const { return first + count; }
  };
  return Range{m.contacts.data() + m.contact_ranges[sphere].first, m.contact_ranges[sphere].count};
}

/// Both bodies of a contact; a node of a sheet is a body that never moves.
struct Side {
  V position = V::Zero(), velocity = V::Zero(), spin = V::Zero();
  float inverse_mass = 0.0f;
  M inverse_inertia = M::Zero();

  V velocity_at(const V& arm) const { return velocity + spin.cross(arm); }
  V response(const V& arm, const V& p) const { return inverse_mass * p + (inverse_inertia * arm.cross(p)).cross(arm); }
};

/// Split among its neighbours (contact_impulse.h).
Side side_of(const Memory& m, gpu::uint body) {
  const gpu::ThesisState& s = m.states[body];
  const float lighter = std::max(1.0f, static_cast<float>(m.neighbour_counts[body]) / 1.9f);
  return {v(s.position), v(s.velocity), v(s.spin), lighter * m.bodies[body].inverse_inertia.w,
          lighter * matrix(m.inertias[body])};
}

}  // namespace

void begin_step(Memory& m) {
  m.status.touching_spheres = m.status.touching_bodies = m.status.slots = 0;
  std::fill(m.neighbours.begin(), m.neighbours.end(), gpu::ThesisNeighbour{THESIS_NO_KEY, THESIS_NO_KEY});
}

void force(Memory& m) {
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    m.neighbour_counts[b] = 0;
    const M r = q(m.states[b].orientation).toRotationMatrix();
    const M i = r * v(m.bodies[b].inverse_inertia).asDiagonal() * r.transpose();
    m.inertias[b] = {{i(0, 0), i(1, 1), i(2, 2), 0}, {i(0, 1), i(0, 2), i(1, 2), 0}};
    if (m.bodies[b].inverse_inertia.w == 0.0f) continue;
    const V g = v(world_of(m, static_cast<gpu::uint>(b)).gravity);
    m.states[b].velocity = pack(v(m.states[b].velocity) + m.settings.time_step * g);
  }
}

void move_to_world(Memory& m) {
  for (std::size_t s = 0; s < m.settings.moving_spheres; ++s) {
    const gpu::vec4& local = m.shapes[m.spheres[s].shape].center;
    const gpu::ThesisState& body = m.states[m.spheres[s].body];
    m.centers[s] = pack(v(body.position) + q(body.orientation) * v(local), local.w);
  }
}

void count_cells(Memory& m) {
  for (std::size_t s = 0; s < m.spheres.size(); ++s) {
    const gpu::ThesisWorld& world = world_of(m, m.spheres[s].body);
    const gpu::uint n[3] = {world.grid.x, world.grid.y, world.grid.z};
    gpu::uint cell[3];
    for (int a = 0; a < 3; ++a) {
      const float at = std::floor((v(m.centers[s])[a] - v(world.origin)[a]) * world.origin.w);
      cell[a] = static_cast<gpu::uint>(std::clamp(at, 0.0f, static_cast<float>(n[a] - 1)));
    }
    m.sphere_cells[s] = world.grid.w + (cell[2] * n[1] + cell[1]) * n[0] + cell[0];
    ++m.cell_counts[m.sphere_cells[s]];
  }
}

void prefix_sum(Memory& m) {
  gpu::uint running = 0;
  for (std::size_t c = 0; c < m.cell_counts.size(); ++c) {
    m.cell_starts[c] = running;
    running += m.cell_counts[c];
  }
  m.cell_starts.back() = running;
}

void scatter(Memory& m) {
  for (std::size_t s = 0; s < m.spheres.size(); ++s) {
    const gpu::uint cell = m.sphere_cells[s];
    m.members[m.cell_starts[cell] + --m.cell_counts[cell]] = static_cast<gpu::uint>(s);
  }
}

void reorder(Memory& m) {
  for (std::size_t c = 0; c + 1 < m.cell_starts.size(); ++c) {
    std::vector<gpu::uint> cell(m.members.begin() + m.cell_starts[c], m.members.begin() + m.cell_starts[c + 1]);
    std::sort(cell.begin(), cell.end());
    for (std::size_t i = 0; i < cell.size(); ++i)
      m.sorted[m.cell_starts[c] + i] = {m.centers[cell[i]], {cell[i], m.spheres[cell[i]].body, 0, 0}};
  }
}

namespace {

/// A sphere or a node of a sheet that a sphere overlaps.
struct Found {
  float depth = 0.0f;            ///< m, of the overlap
  gpu::uint other = 0, key = 0;  ///< of the sphere or node, and of its body or sheet
  V center = V::Zero(), normal = V::Zero();
  bool face = false;  ///< `normal` is that of a face
  bool deep = false;  ///< a sheet pushes along its normal
  float radius = 0.0f, friction = 0.0f, restitution = 0.0f;
};

/// Normal of a sphere's face, and whether it has one.
std::pair<V, bool> face_of(const Memory& m, gpu::uint sphere) {
  const gpu::vec4& normal = m.shapes[m.spheres[sphere].shape].normal;
  return {q(m.states[m.spheres[sphere].body].orientation) * v(normal), normal.w > 0.5f};
}

/// Every sphere against every other: what a grid may save, it must not change.
void find_spheres(const Memory& m, gpu::uint sphere, std::vector<Found>& found) {
  const gpu::uint body = m.spheres[sphere].body;
  const V p = v(m.centers[sphere]);
  for (gpu::uint o = 0; o < m.spheres.size(); ++o) {
    const gpu::uint other = m.spheres[o].body;
    if (other == body || m.bodies[other].range.z != m.bodies[body].range.z) continue;
    const float depth = m.centers[sphere].w + m.centers[o].w - (p - v(m.centers[o])).norm();
    if (depth <= 0.0f) continue;
    Found sphere_found;
    sphere_found.depth = depth;
    sphere_found.other = o;
    sphere_found.key = other;
    sphere_found.center = v(m.centers[o]);
    std::tie(sphere_found.normal, sphere_found.face) = face_of(m, o);
    sphere_found.radius = m.centers[o].w;
    sphere_found.friction = m.bodies[other].surface.x;
    sphere_found.restitution = m.bodies[other].surface.y;
    found.push_back(sphere_found);
  }
}

/// The nodes of the k-th sheet of a world that a sphere reaches; of what is deep in it, the nearest alone.
void find_nodes(const gpu::ThesisSheet& sheet, gpu::uint k, const gpu::vec4& sphere, std::vector<Found>& found) {
  const float r = sphere.w, radius = sheet.origin.w, pitch = sheet.normal.w;
  const V p = v(sphere), from = p - v(sheet.origin), n = v(sheet.normal);
  const float height = from.dot(n), at_u = from.dot(v(sheet.u)), at_v = from.dot(v(sheet.v));
  if (height >= r + radius || height <= -sheet.surface.z) return;
  const bool deep = height < 0.5f * (r + radius);
  const int reach = deep ? 0 : static_cast<int>(std::ceil((r + radius) / pitch));
  for (int dv = -reach; dv <= reach; ++dv)
    for (int du = -reach; du <= reach; ++du) {
      const float node_u = (std::round(at_u / pitch) + static_cast<float>(du)) * pitch;
      const float node_v = (std::round(at_v / pitch) + static_cast<float>(dv)) * pitch;
      if (std::abs(node_u) > sheet.u.w || std::abs(node_v) > sheet.v.w) continue;
      const V center = v(sheet.origin) + node_u * v(sheet.u) + node_v * v(sheet.v);
      const float depth = r + radius - (deep ? height : (p - center).norm());
      const gpu::uint code =
          THESIS_NODE | k << 16 | static_cast<gpu::uint>(du + 128) << 8 | static_cast<gpu::uint>(dv + 128);
      if (depth <= 0.0f) continue;
      Found node;
      node.depth = depth;
      node.other = code;
      node.key = THESIS_NODE | k;
      node.center = center;
      node.normal = n;
      node.face = true;
      node.deep = deep;
      node.radius = radius;
      node.friction = sheet.surface.x;
      node.restitution = sheet.surface.y;
      found.push_back(node);
    }
}

/// The deepest first.
std::vector<Found> overlaps_of(const Memory& m, gpu::uint sphere) {
  std::vector<Found> found;
  find_spheres(m, sphere, found);
  const gpu::ThesisWorld& world = world_of(m, m.spheres[sphere].body);
  for (gpu::uint k = 0; k < world.sheets.y; ++k) find_nodes(m.sheets[world.sheets.x + k], k, m.centers[sphere], found);
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.depth != b.depth ? a.depth > b.depth : a.other < b.other; });
  return found;
}

/// Slots for the contacts of a sphere, if enough are free. Notes how many were wanted.
void reserve_slots(Memory& m, gpu::uint sphere, std::size_t wanted) {
  const std::size_t kept = std::min<std::size_t>(wanted, m.settings.capacity);
  m.contact_ranges[sphere] = {0, 0};
  if (kept == 0) return;
  gpu::ThesisNeed& need = m.needs[m.bodies[m.spheres[sphere].body].range.z];
  need.contacts = std::max(need.contacts, static_cast<gpu::uint>(wanted));
  if (wanted > kept) m.status.overflow |= THESIS_CONTACT_OVERFLOW;
  const gpu::uint first = m.status.slots;
  m.status.slots += static_cast<gpu::uint>(kept);
  if (m.status.slots > m.settings.slots) {
    m.status.overflow |= THESIS_SLOT_OVERFLOW;
    return;
  }
  BIN_SCENES_ASSERT(m.status.slots <= m.contacts.size());
  m.contact_ranges[sphere] = {first, static_cast<gpu::uint>(kept)};
  m.touching_spheres[m.status.touching_spheres++] = sphere;
}

/// `line`: direction between both centers, which modified normals turn towards those of the faces.
V normal_of(const Memory& m, gpu::uint sphere, const Found& f, const V& line) {
  if (f.deep) return f.normal;
  if (!m.settings.modified_normals) return line;
  const auto [own_normal, own_face] = face_of(m, sphere);
  const V mean = (f.face ? f.normal : V::Zero().eval()) - (own_face ? own_normal : V::Zero().eval());
  return mean.norm() >= 0.5f && mean.normalized().dot(line) >= 0.5f ? V(mean.normalized()) : line;
}

/// Speed along the normal at which the contact is to part: of its rebound, or of what lets overlap out.
float goal_of(const Memory& m, gpu::uint sphere, const Found& f, const V& n, const V& point) {
  const gpu::uint body = m.spheres[sphere].body;
  const gpu::ThesisWorld& world = world_of(m, body);
  const auto velocity_at = [&](gpu::uint b) {
    return V(v(m.states[b].velocity) + v(m.states[b].spin).cross(point - v(m.states[b].position)));
  };
  V relative = velocity_at(body), fall = m.settings.time_step * v(world.gravity);
  if (!(f.key & THESIS_NODE)) {
    relative -= velocity_at(f.key);
    if (m.bodies[f.key].inverse_inertia.w > 0.0f) fall.setZero();
  }
  const float approach = -n.dot(relative - fall);
  const float restitution = std::max(m.bodies[body].surface.y, f.restitution);
  const float bounce = approach <= world.gravity.w ? 0.0f : restitution * approach + n.dot(fall);
  const float left = m.settings.slop * std::min(m.centers[sphere].w, f.radius);
  return std::max(bounce, m.settings.bias * std::max(0.0f, f.depth - left));
}

gpu::ThesisContact contact_of(const Memory& m, gpu::uint sphere, const Found& f) {
  const gpu::uint body = m.spheres[sphere].body;
  const V p = v(m.centers[sphere]), line = (p - f.center).normalized(), n = normal_of(m, sphere, f, line);
  const float r = m.centers[sphere].w;
  const V point = f.deep ? V(p - n * r) : V(p - line * (r - 0.5f * f.depth));
  const V arm = point - v(m.states[body].position);
  return {pack(n, f.depth),
          pack(arm, pair_friction(m.bodies[body].surface.x, f.friction)),
          {f.other, f.key, 1, 0},
          pack(V::Zero()),
          pack(V::Zero(), goal_of(m, sphere, f, n, point))};
}

}  // namespace

void detect(Memory& m) {
  for (gpu::uint s = 0; s < m.settings.moving_spheres; ++s) {
    const std::vector<Found> found = overlaps_of(m, s);
    reserve_slots(m, s, found.size());
    for (gpu::uint i = 0; i < m.contact_ranges[s].count; ++i)
      m.contacts[m.contact_ranges[s].first + i] = contact_of(m, s, found[i]);
  }
}

void plan(Memory& m) {
  // As many groups as there is work; folding over two axes starts at 65,536 groups, which no twin will see.
  const gpu::uint groups = (m.status.touching_spheres + THESIS_GROUP - 1) / THESIS_GROUP;
  m.status.sphere_groups = {groups, groups ? 1u : 0u, 1, 0};
  m.status.body_groups = {m.status.touching_bodies, m.status.touching_bodies ? 1u : 0u, 1, 0};
  m.status.contacts += m.status.slots;
  if (m.status.most_slots <= m.settings.slots) m.status.most_slots = std::max(m.status.most_slots, m.status.slots);
  m.status.slots = 0;
}

namespace {
/// Contacts by (body, neighbour).
std::map<std::pair<gpu::uint, gpu::uint>, gpu::uint> pairs(const Memory& m) {
  std::map<std::pair<gpu::uint, gpu::uint>, gpu::uint> count;
  for (gpu::uint s = 0; s < m.settings.moving_spheres; ++s)
    for (const gpu::ThesisContact& contact : contacts_of(m, s)) ++count[{m.spheres[s].body, contact.other.y}];
  return count;
}
}  // namespace

void count_pairs(Memory& m) {
  for (const auto& [pair, count] : pairs(m)) {
    const auto [body, key] = pair;
    gpu::uint& neighbours = m.neighbour_counts[body];
    // Any free slot will do; the pass finds its slots by hashing.
    if (neighbours < m.settings.neighbour_slots)
      m.neighbours[body * m.settings.neighbour_slots + neighbours] = {key, count - 1};
    if (neighbours++ == 0) m.touching_bodies[m.status.touching_bodies++] = body;
    gpu::ThesisNeed& need = m.needs[m.bodies[body].range.z];
    need.neighbours = std::max(need.neighbours, neighbours);
  }
}

void split_mass(Memory& m) {
  const auto count = pairs(m);
  for (gpu::uint s = 0; s < m.settings.moving_spheres; ++s)
    for (gpu::ThesisContact& contact : contacts_of(m, s))
      contact.other.z = count.at({m.spheres[s].body, contact.other.y});
}

void impulse(Memory& m) {
  for (gpu::uint s = 0; s < m.settings.moving_spheres; ++s)
    for (gpu::ThesisContact& contact : contacts_of(m, s)) {
      const Side own = side_of(m, m.spheres[s].body);
      const Side other = contact.other.y & THESIS_NODE ? Side() : side_of(m, contact.other.y);
      const V n = v(contact.normal), arm = v(contact.arm), total = v(contact.total);
      const V other_arm = arm + own.position - other.position;
      const V velocity = own.velocity_at(arm) - other.velocity_at(other_arm);
      const float vn = n.dot(velocity), k = static_cast<float>(contact.other.z);
      const auto stiffness = [&](const V& d) { return d.dot(own.response(arm, d) + other.response(other_arm, d)); };

      const float push = std::max(0.0f, n.dot(total) + (contact.total.w - vn) / (stiffness(n) * k));
      V tangent = total - n.dot(total) * n;
      const V slip = velocity - vn * n;
      if (slip.norm() > 1e-9f) tangent -= slip / (stiffness(slip.normalized()) * k);
      const float limit = contact.arm.w * push;
      if (tangent.norm() > limit) tangent *= limit / tangent.norm();
      const V change = push * n + tangent - total;
      contact.impulse = pack(change);
      contact.total = pack(total + change, contact.total.w);
    }
}

void pre_velocity(Memory& m) {
  for (gpu::uint s = 0; s < m.settings.moving_spheres; ++s) {
    V linear = V::Zero(), angular = V::Zero();
    for (const gpu::ThesisContact& contact : contacts_of(m, s)) {
      linear += v(contact.impulse);
      angular += v(contact.arm).cross(v(contact.impulse));
    }
    if (m.contact_ranges[s].count) m.pushes[s] = {pack(linear), pack(angular)};
  }
}

void velocity(Memory& m) {
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    if (m.bodies[b].inverse_inertia.w == 0.0f) continue;
    V linear = V::Zero(), angular = V::Zero();
    for (gpu::uint s = m.bodies[b].range.x; s < m.bodies[b].range.x + m.bodies[b].range.y; ++s) {
      if (m.contact_ranges[s].count == 0) continue;
      linear += v(m.pushes[s].linear);
      angular += v(m.pushes[s].angular);
    }
    m.states[b].velocity = pack(v(m.states[b].velocity) + m.bodies[b].inverse_inertia.w * linear);
    m.states[b].spin = pack(v(m.states[b].spin) + matrix(m.inertias[b]) * angular);
  }
}

void position(Memory& m) {
  const float dt = m.settings.time_step;
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    if (m.bodies[b].inverse_inertia.w == 0.0f) continue;
    gpu::ThesisState& state = m.states[b];
    V displacement = dt * v(state.velocity);
    if (m.neighbour_counts[b] == 0) displacement -= 0.5f * dt * dt * v(world_of(m, static_cast<gpu::uint>(b)).gravity);
    state.position = pack(v(state.position) + displacement);

    const V inverse = v(m.bodies[b].inverse_inertia);
    const Q old = q(state.orientation);
    const V momentum = old * (old.conjugate() * v(state.spin)).cwiseQuotient(inverse);
    const auto spin_of = [&](const Q& at) { return V(at * inverse.cwiseProduct(at.conjugate() * momentum)); };
    V spin = v(state.spin);
    for (int i = 0; i < 6; ++i) spin = spin_of(turn(0.5f * dt * spin) * old);
    const Q now = (turn(dt * spin) * old).normalized();
    state.orientation = pack(now.vec(), now.w());
    state.spin = pack(spin_of(now));
  }
}

}  // namespace bin_scenes::thesis::twin
