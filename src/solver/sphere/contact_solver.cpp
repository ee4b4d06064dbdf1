#include "solver/sphere/world.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

namespace {

/// Soft contact (Catto, "Solver2D", 2024; implicit spring of frequency `hertz` over a step h).
struct Softness {
  float bias_rate, mass_scale, impulse_scale;
};

Softness softness(float hertz, float damping_ratio, float h) {
  const float omega = 2.0f * static_cast<float>(M_PI) * hertz;
  const float a1 = 2.0f * damping_ratio + h * omega, a2 = h * omega * a1, a3 = 1.0f / (1.0f + a2);
  return {omega / a1, a2 * a3, a3};
}

/// Stand-in for walls and floor: nothing moves it.
Body immovable() {
  return Body{};
}

/// Manifolds of one body pair in world terms.
void prepare(Manifold& m, Body& a, Body& b) {
  for (Contact& c : m.contacts) {
    const bool field_of_a = c.feature >> 31;
    c.normal = field_of_a      ? Vec3f(a.rotation * c.local_normal)
               : m.b == ground ? c.local_normal
                               : Vec3f(b.rotation * c.local_normal);
    c.ra = a.rotation * c.anchor_a;
    c.rb = m.b == ground ? c.anchor_b : Vec3f(b.rotation * c.anchor_b);
    c.separation = (b.x + c.rb - a.x - c.ra).dot(c.normal);
    c.t1 = c.normal.unitOrthogonal();
    c.t2 = c.normal.cross(c.t1);
    const auto mass_along = [&](const Vec3f& d) {
      const Vec3f ta = c.ra.cross(d), tb = c.rb.cross(d);
      const float k =
          a.inverse_mass + b.inverse_mass + ta.dot(a.world_inverse_inertia * ta) + tb.dot(b.world_inverse_inertia * tb);
      return k > 0 ? 1.0f / k : 0.0f;
    };
    c.normal_mass = mass_along(c.normal);
    // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
    c.tangent_mass = std::min(mass_along(c.t1), mass_along(c.t2));
    c.f1 = c.friction_impulse.dot(c.t1);
    c.f2 = c.friction_impulse.dot(c.t2);
    c.approach = (b.v + b.w.cross(c.rb) - a.v - a.w.cross(c.ra)).dot(c.normal);
    c.prepared_approach = c.approach;
    c.max_impulse = 0;
  }
}

inline void apply(Body& a, Body& b, const Contact& c, const Vec3f& impulse) {
  a.v -= a.inverse_mass * impulse;
  a.w -= a.world_inverse_inertia * c.ra.cross(impulse);
  b.v += b.inverse_mass * impulse;
  b.w += b.world_inverse_inertia * c.rb.cross(impulse);
}

inline Vec3f relative_velocity(const Body& a, const Body& b, const Contact& c) {
  return b.v + b.w.cross(c.rb) - a.v - a.w.cross(c.ra);
}

void warm_start(const Settings& s, float speed_gain, Manifold& m, Body& a, Body& b) {
  for (Contact& c : m.contacts) {
    // What is about to strike gains speed until it does, but no more than gravity gives in a step.
    if (c.approach < -s.restitution_speed && c.max_impulse == 0) {
      const float vn = relative_velocity(a, b, c).dot(c.normal);
      c.approach = std::min(c.approach, std::max(vn, c.prepared_approach - speed_gain));
    }
    apply(a, b, c, c.normal_impulse * c.normal + c.f1 * c.t1 + c.f2 * c.t2);
  }
}

/// Sequential impulses over the contacts of one manifold, accumulated and clamped. With `bias`, overlap is pushed out
/// softly; without, the velocity that pushing left is taken back (relaxation).
void solve_manifold(const Settings& s, const Softness& soft, Manifold& m, Body& a, Body& b, float h, bool bias,
                    float d) {
  const float inverse_h = 1.0f / h, slop = s.slop * d, push = s.push_speed * d;
  for (Contact& c : m.contacts) {
    const Vec3f moved = b.dx + (b.turn * c.rb - c.rb) - a.dx - (a.turn * c.ra - c.ra);
    const float separation = c.separation + moved.dot(c.normal);
    float velocity_bias = 0, mass_scale = 1, impulse_scale = 0;
    if (separation > 0) {
      velocity_bias = separation * inverse_h;  // speculative: may close the distance, no more
    } else if (bias) {
      velocity_bias = std::max(soft.bias_rate * std::min(0.0f, separation + slop), -push);
      mass_scale = soft.mass_scale;
      impulse_scale = soft.impulse_scale;
    }
    c.gap = separation;
    const float vn = relative_velocity(a, b, c).dot(c.normal);
    const float impulse = -c.normal_mass * mass_scale * (vn + velocity_bias) - impulse_scale * c.normal_impulse;
    const float total = std::max(c.normal_impulse + impulse, 0.0f);
    const float change = total - c.normal_impulse;
    c.normal_impulse = total;
    c.max_impulse = std::max(c.max_impulse, total);
    apply(a, b, c, change * c.normal);
  }
  for (Contact& c : m.contacts) {
    const Vec3f v = relative_velocity(a, b, c);
    float f1 = c.f1 - c.tangent_mass * v.dot(c.t1), f2 = c.f2 - c.tangent_mass * v.dot(c.t2);
    const float most = m.friction * c.normal_impulse, size = std::sqrt(f1 * f1 + f2 * f2);
    if (size > most) {
      f1 *= most / size;
      f2 *= most / size;
    }
    const Vec3f impulse = (f1 - c.f1) * c.t1 + (f2 - c.f2) * c.t2;
    c.f1 = f1;
    c.f2 = f2;
    apply(a, b, c, impulse);
  }
}

/// Whether a contact was struck fast enough to bounce: pressed, or closed by a blow that its neighbours took.
bool struck(const Settings& s, const Contact& c) {
  if (c.approach > -s.restitution_speed) return false;
  return c.max_impulse > 0 || c.gap < -c.approach * s.time_step / s.sub_steps;
}

/// Newton's restitution: one sweep towards a separating speed of e times that of the approach.
void bounce(const Settings& s, Manifold& m, Body& a, Body& b) {
  for (Contact& c : m.contacts) {
    if (!struck(s, c)) continue;
    const float vn = relative_velocity(a, b, c).dot(c.normal);
    const float total = std::max(c.normal_impulse - c.normal_mass * (vn + m.restitution * c.approach), 0.0f);
    apply(a, b, c, (total - c.normal_impulse) * c.normal);
    c.normal_impulse = total;
  }
}

constexpr int bounce_sweeps = 12;  ///< a face that strikes flat shares its blow among many contacts

void restitute(const Settings& s, World& world, Body& wall) {
  static thread_local std::vector<Manifold*> bouncing;
  bouncing.clear();
  for (const std::uint32_t i : world.order) {
    Manifold& m = world.manifolds[i];
    const auto hit = [&](const Contact& c) { return c.max_impulse > 0 && struck(s, c); };
    if (m.restitution > 0 && std::any_of(m.contacts.begin(), m.contacts.end(), hit)) bouncing.push_back(&m);
  }
  for (int k = 0; k < bounce_sweeps; ++k)
    for (Manifold* m : bouncing) bounce(s, *m, world.bodies[m->a], m->b == ground ? wall : world.bodies[m->b]);
  for (Manifold* m : bouncing)  // a blow is over: it must not warm-start the next step
    for (Contact& c : m->contacts)
      if (struck(s, c)) c.normal_impulse = c.f1 = c.f2 = 0;
}

/// Gravity, and the gyroscopic term by the implicit midpoint rule on Euler's equations in the body frame. Both the
/// kinetic energy and |L| are quadratic, so the rule keeps them (Hairer, Lubich, Wanner 2006, IV.2).
void integrate_velocity(Body& b, const Vec3f& gravity, float h) {
  b.v += h * gravity;
  if (b.w.squaredNorm() * h * h < 1e-8f) return;  // slower than 1e-4 rad a sub-step: the term is below rounding
  // Double precision: single would let |L| creep by a thousandth in ten thousand sub-steps.
  const Mat3 r = b.q.cast<double>().normalized().toRotationMatrix();
  const Mat3 inertia = b.inertia.cast<double>(), inverse = b.inverse_inertia.cast<double>();
  const Vec3 w0 = r.transpose() * b.w.cast<double>();
  Vec3 w = w0;
  for (int i = 0; i < 6; ++i) {
    const Vec3 mid = 0.5 * (w0 + w);
    w = w0 - h * (inverse * mid.cross(inertia * mid));
  }
  b.w = (r * w).cast<float>();
}

void integrate_position(Body& b, const Vec3f& gravity, float h) {
  b.dx += h * b.v;
  if (b.free) b.dx -= 0.5f * h * h * gravity;  // nothing touches it: exactly the parabola
  b.q = integrated(b.q, b.w, h);
  b.turn = b.q.toRotationMatrix() * b.rotation.transpose();
}

}  // namespace

/// Greedy, in key order: a manifold takes the lowest color that neither of its moving bodies has yet.
void color_manifolds(World& world) {
  static thread_local std::vector<std::uint64_t> used;
  used.assign(world.bodies.size(), 0);
  int colors = 0;
  for (Manifold& m : world.manifolds) {
    m.color = -1;
    if (m.contacts.empty()) continue;
    Body& a = world.bodies[m.a];
    Body* b = m.b == ground ? nullptr : &world.bodies[m.b];
    const bool a_moves = a.moves(), b_moves = b && b->moves();
    if (!a_moves && !b_moves) continue;
    const std::uint64_t taken = (a_moves ? used[m.a] : 0) | (b_moves ? used[m.b] : 0);
    m.color = taken == ~std::uint64_t{0} ? 63 : __builtin_ctzll(~taken);
    const std::uint64_t bit = std::uint64_t{1} << m.color;
    if (a_moves) used[m.a] |= bit;
    if (b_moves) used[m.b] |= bit;
    colors = std::max(colors, m.color + 1);
  }
  world.color_start.assign(colors + 1, 0);
  for (const Manifold& m : world.manifolds)
    if (m.color >= 0) ++world.color_start[m.color + 1];
  for (int c = 0; c < colors; ++c) world.color_start[c + 1] += world.color_start[c];
  world.order.resize(colors ? world.color_start[colors] : 0);
  std::vector<std::uint32_t> next(world.color_start.begin(), world.color_start.end());
  for (std::uint32_t i = 0; i < world.manifolds.size(); ++i)
    if (world.manifolds[i].color >= 0) world.order[next[world.manifolds[i].color]++] = i;
}

void solve(World& world) {
  const Settings& s = world.settings;
  const float h = s.time_step / s.sub_steps;
  const Softness soft = softness(s.contact_hertz_share / h, s.damping_ratio, h);
  Body wall = immovable();
  const auto each = [&](auto&& visit) {
    for (const std::uint32_t i : world.order) {
      Manifold& m = world.manifolds[i];
      visit(m, world.bodies[m.a], m.b == ground ? wall : world.bodies[m.b]);
    }
  };
  const auto each_body = [&](auto&& visit) {
    for (Body& b : world.bodies)
      if (b.moves()) visit(b);
  };
  const float d = world.smallest_diagonal;

  for (Body& b : world.bodies) {  // sleeping bodies too: their contacts with awake ones read these
    b.dx.setZero();
    b.turn.setIdentity();
    b.free = true;
    if (!b.moves()) {
      b.v.setZero();
      b.w.setZero();
    }
  }
  // A sleeping body takes part as if fixed, until it is woken.
  static thread_local std::vector<std::pair<std::uint32_t, Body>> frozen;
  frozen.clear();
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    Body& b = world.bodies[i];
    if (b.present && b.asleep && b.inverse_mass > 0) {
      frozen.emplace_back(i, b);
      b.inverse_mass = 0;
      b.world_inverse_inertia.setZero();
    }
  }
  each([&](Manifold& m, Body& a, Body& b) {
    a.free = b.free = false;
    prepare(m, a, b);
  });
  each_body([&](Body& b) { world.counters.free_steps += b.free; });
  for (int k = 0; k < s.sub_steps; ++k) {
    each_body([&](Body& b) { integrate_velocity(b, world.gravity, h); });
    each([&](Manifold& m, Body& a, Body& b) { warm_start(s, world.gravity.norm() * s.time_step, m, a, b); });
    each([&](Manifold& m, Body& a, Body& b) { solve_manifold(s, soft, m, a, b, h, true, d); });
    each_body([&](Body& b) { integrate_position(b, world.gravity, h); });
    each([&](Manifold& m, Body& a, Body& b) { solve_manifold(s, soft, m, a, b, h, false, d); });
  }
  restitute(s, world, wall);
  each([&](Manifold& m, Body&, Body&) {
    for (Contact& c : m.contacts) c.friction_impulse = c.f1 * c.t1 + c.f2 * c.t2;
  });
  for (const auto& [i, body] : frozen) {
    world.bodies[i].inverse_mass = body.inverse_mass;
    world.bodies[i].world_inverse_inertia = body.world_inverse_inertia;
  }
  each_body([&](Body& b) { b.x += b.dx; });
}

}  // namespace bin_scenes::sphere
