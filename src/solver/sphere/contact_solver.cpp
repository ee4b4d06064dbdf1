#include "solver/sphere/contact_rows.hpp"
#include "solver/sphere/world.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace bin_scenes::sphere {

namespace {

/// Soft contact (Catto, "Solver2D", 2024): implicit spring over a sub-step h.
struct Spring {
  float bias_rate, mass_scale, impulse_scale;
};

Spring spring(const Softness& s, float h) {
  const float omega = 2.0f * static_cast<float>(M_PI) * s.hertz_share / h;
  const float a1 = 2.0f * s.damping_ratio + h * omega, a2 = h * omega * a1, a3 = 1.0f / (1.0f + a2);
  return {omega / a1, a2 * a3, a3};
}

constexpr std::size_t blocks_per_task = 32;  ///< fewer = more handing over; more = threads wait for the last one
constexpr int bounce_sweeps = 12;            ///< a face that strikes flat shares its blow among many contacts

/// `work(i)` for each i below `count`. Isolated: a thread that waits here for the others must not begin another world's
/// step, whose solve would take the same scratch memory.
template <class Work>
void for_each_in_parallel(std::size_t count, std::size_t per_task, const Work& work) {
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, per_task), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i) work(i);
    });
  });
}

/// What a step's solve works on. Kept between steps for its memory alone.
struct Scratch {
  std::vector<Motion> motions;  ///< of the bodies, and of the ground behind them
  std::vector<Block> blocks;    ///< in order of color
  std::vector<ContactRows> rows;
};

/// The solve of one step. Bodies that sleep or are fixed take part as if nothing could move them.
class ContactSolver {
 public:
  ContactSolver(World& world, Scratch& scratch)
      : world_(world),
        settings_(world.settings),
        h_(settings_.time_step / static_cast<float>(world.sub_steps())),
        softness_(world.softness()),
        spring_(spring(softness_, h_)),
        push_speed_(settings_.push_speed / static_cast<float>(softness_.refinement)),
        motions_(scratch.motions),
        blocks_(scratch.blocks),
        rows_(scratch.rows) {}

  void prepare();         ///< rows from contacts, with the forces of the last step
  void accelerate();      ///< gravity, gyroscopic term
  void warm_start();      ///< impulses of the last sub-step again
  void sweep(bool push);  ///< one round of Gauss-Seidel over all contacts; `push` lets overlap out
  void move();            ///< positions
  void restitute();       ///< Newton's restitution
  void finish();          ///< back into bodies and contacts

 private:
  void prepare_motions();
  const Mat3f& world_inverse_inertia(std::uint32_t body) const;
  ContactRows rows_of(Contact& c, const Manifold& m, const Block& block) const;
  void solve_normal(ContactRows& c, Motion& a, Motion& b, bool push) const;
  void solve_friction(ContactRows& c, float friction, Motion& a, Motion& b) const;
  bool struck(const ContactRows& c) const;
  void bounce(const Block& block);

  World& world_;
  const Settings& settings_;
  const float h_;
  const Softness& softness_;
  const Spring spring_;
  const float push_speed_;  ///< d per second. What is pressed has little to let out: nothing needs to be thrown
  std::vector<Motion>& motions_;
  std::vector<Block>& blocks_;
  std::vector<ContactRows>& rows_;
};

void ContactSolver::prepare_motions() {
  motions_.assign(world_.bodies.size() + 1, Motion{});
  for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
    Body& b = world_.bodies[i];
    if (!b.moves()) continue;
    motions_[i].v = padded(b.v);
    motions_[i].w = padded(b.w);
    motions_[i].inverse_mass = b.inverse_mass;
    motions_[i].free = true;
  }
}

Row row_along(const Vec3f& direction, const Vec3f& ra, const Vec3f& rb, const Mat3f& inverse_a, const Mat3f& inverse_b,
              float inverse_masses) {
  const Vec3f moment_a = ra.cross(direction), moment_b = rb.cross(direction);
  const Vec3f turn_a = inverse_a * moment_a, turn_b = inverse_b * moment_b;
  const float k = inverse_masses + moment_a.dot(turn_a) + moment_b.dot(turn_b);
  return {padded(direction), padded(moment_a), padded(moment_b), padded(turn_a), padded(turn_b), k > 0 ? 1 / k : 0, 0};
}

const Mat3f& ContactSolver::world_inverse_inertia(std::uint32_t body) const {
  static const Mat3f none = Mat3f::Zero();
  return motions_[body].inverse_mass > 0 ? world_.bodies[body].world_inverse_inertia : none;
}

ContactRows ContactSolver::rows_of(Contact& c, const Manifold& m, const Block& block) const {
  const Body& a = world_.bodies[m.a];
  const Body* b = m.b == ground ? nullptr : &world_.bodies[m.b];
  const bool field_of_a = c.feature >> 31;
  c.normal = field_of_a ? Vec3f(a.rotation * c.local_normal) : b ? Vec3f(b->rotation * c.local_normal) : c.local_normal;
  const Vec3f ra = a.rotation * c.anchor_a, rb = b ? Vec3f(b->rotation * c.anchor_b) : c.anchor_b;
  const Vec3f t1 = c.normal.unitOrthogonal(), t2 = c.normal.cross(t1);
  const Mat3f &inverse_a = world_inverse_inertia(block.a), &inverse_b = world_inverse_inertia(block.b);
  const Motion &motion_a = motions_[block.a], &motion_b = motions_[block.b];
  const float inverse_masses = motion_a.inverse_mass + motion_b.inverse_mass;
  const auto row = [&](const Vec3f& along) { return row_along(along, ra, rb, inverse_a, inverse_b, inverse_masses); };
  ContactRows rows{row(c.normal), row(t1), row(t2)};
  rows.normal.impulse = h_ * c.normal_force;
  rows.t1.impulse = h_ * c.friction_force.dot(t1);
  rows.t2.impulse = h_ * c.friction_force.dot(t2);
  // One mass for both directions: two would turn the friction of a sliding part away from its velocity.
  rows.t1.effective_mass = rows.t2.effective_mass = std::min(rows.t1.effective_mass, rows.t2.effective_mass);
  rows.separation = ((b ? b->x : Vec3f(Vec3f::Zero())) + rb - a.x - ra).dot(c.normal);
  rows.approach = rows.prepared_approach = rows.normal.speed(motion_a, motion_b);
  rows.max_impulse = rows.gap = 0;
  return rows;
}

void ContactSolver::prepare() {
  prepare_motions();
  blocks_.clear();
  const auto no_body = static_cast<std::uint32_t>(world_.bodies.size());
  std::uint32_t rows = 0;
  for (const std::uint32_t i : world_.order) {
    const Manifold& m = world_.manifolds[i];
    const std::uint32_t first = rows;
    rows += static_cast<std::uint32_t>(m.contacts.size());
    blocks_.push_back({i, m.a, m.b == ground ? no_body : m.b, first, rows, m.friction, m.restitution});
    motions_[m.a].free = motions_[blocks_.back().b].free = false;
  }
  rows_.resize(rows);
  for_each_in_parallel(blocks_.size(), blocks_per_task, [&](std::size_t i) {
    const Block& block = blocks_[i];
    Manifold& m = world_.manifolds[block.manifold];
    for (std::size_t k = 0; k < m.contacts.size(); ++k) rows_[block.first + k] = rows_of(m.contacts[k], m, block);
  });
  for (const Motion& motion : motions_) world_.counters.free_steps += motion.free;
}

/// Gravity, and the gyroscopic term by the implicit midpoint rule on Euler's equations in the body frame. Both the
/// kinetic energy and |L| are quadratic, so the rule keeps them (Hairer, Lubich, Wanner 2006, IV.2).
void ContactSolver::accelerate() {
  const Vec4f gain = h_ * padded(world_.gravity);
  for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
    Motion& motion = motions_[i];
    if (motion.inverse_mass == 0) continue;
    motion.v += gain;
    if (motion.w.squaredNorm() * h_ * h_ < 1e-8f) continue;  // below 1e-4 rad a sub-step the term is below rounding
    // Double precision: single would let |L| creep by a thousandth in ten thousand sub-steps.
    const Body& b = world_.bodies[i];
    const Mat3 r = b.q.cast<double>().normalized().toRotationMatrix();
    const Mat3 inertia = b.inertia.cast<double>(), inverse = b.inverse_inertia.cast<double>();
    const Vec3 w0 = r.transpose() * motion.w.head<3>().cast<double>();
    Vec3 w = w0;
    for (int k = 0; k < 6; ++k) {
      const Vec3 mid = 0.5 * (w0 + w);
      w = w0 - h_ * (inverse * mid.cross(inertia * mid));
    }
    motion.w = padded((r * w).cast<float>());
  }
}

void ContactSolver::warm_start() {
  const float speed_gain = world_.gravity.norm() * settings_.time_step;
  for (const Block& block : blocks_) {
    Motion &a = motions_[block.a], &b = motions_[block.b];
    for (std::uint32_t i = block.first; i < block.last; ++i) {
      ContactRows& c = rows_[i];
      // What is about to strike gains speed until it does, but no more than gravity gives in a step.
      if (c.approach < -settings_.restitution_speed && c.max_impulse == 0)
        c.approach = std::min(c.approach, std::max(c.normal.speed(a, b), c.prepared_approach - speed_gain));
      c.normal.push(c.normal.impulse, a, b);
      c.t1.push(c.t1.impulse, a, b);
      c.t2.push(c.t2.impulse, a, b);
    }
  }
}

/// Sequential impulse, accumulated and clamped. With `push`, overlap is let out softly; without, the velocity that
/// pushing left is taken back (relaxation).
void ContactSolver::solve_normal(ContactRows& c, Motion& a, Motion& b, bool push) const {
  const float d = world_.smallest_diagonal, separation = c.separation + c.normal.way(a, b);
  float bias = 0, mass_scale = 1, impulse_scale = 0;
  if (separation > 0) {
    bias = separation / h_;  // speculative: may close the distance, no more
  } else if (push) {
    bias = std::max(spring_.bias_rate * std::min(0.0f, separation + softness_.slop * d), -push_speed_ * d);
    mass_scale = spring_.mass_scale;
    impulse_scale = spring_.impulse_scale;
  }
  const float before = c.normal.impulse;
  const float change = -c.normal.effective_mass * mass_scale * (c.normal.speed(a, b) + bias) - impulse_scale * before;
  c.normal.impulse = std::max(before + change, 0.0f);
  c.max_impulse = std::max(c.max_impulse, c.normal.impulse);
  c.gap = separation;
  c.normal.push(c.normal.impulse - before, a, b);
}

/// Coulomb's cone: both directions at once.
void ContactSolver::solve_friction(ContactRows& c, float friction, Motion& a, Motion& b) const {
  float f1 = c.t1.impulse - c.t1.effective_mass * c.t1.speed(a, b);
  float f2 = c.t2.impulse - c.t2.effective_mass * c.t2.speed(a, b);
  const float most = friction * c.normal.impulse, size = std::sqrt(f1 * f1 + f2 * f2);
  if (size > most) {
    f1 *= most / size;
    f2 *= most / size;
  }
  c.t1.push(f1 - c.t1.impulse, a, b);
  c.t2.push(f2 - c.t2.impulse, a, b);
  c.t1.impulse = f1;
  c.t2.impulse = f2;
}

void ContactSolver::sweep(bool push) {
  for (const Block& block : blocks_) {
    Motion &a = motions_[block.a], &b = motions_[block.b];
    for (std::uint32_t i = block.first; i < block.last; ++i) solve_normal(rows_[i], a, b, push);
    for (std::uint32_t i = block.first; i < block.last; ++i) solve_friction(rows_[i], block.friction, a, b);
  }
}

void ContactSolver::move() {
  const Vec4f parabola = 0.5f * h_ * h_ * padded(world_.gravity);
  for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
    Motion& motion = motions_[i];
    if (motion.inverse_mass == 0) continue;
    motion.moved += h_ * motion.v;
    if (motion.free) motion.moved -= parabola;  // nothing touches it: exactly the parabola
    motion.turned += h_ * motion.w;
    world_.bodies[i].q = integrated(world_.bodies[i].q, motion.w.head<3>(), h_);
  }
}

/// Whether a contact was struck fast enough to bounce: pressed, or closed by a blow that its neighbours took.
bool ContactSolver::struck(const ContactRows& c) const {
  if (c.approach > -settings_.restitution_speed) return false;
  return c.max_impulse > 0 || c.gap < -c.approach * h_;
}

/// One sweep towards a separating speed of e times that of the approach.
void ContactSolver::bounce(const Block& block) {
  Motion &a = motions_[block.a], &b = motions_[block.b];
  for (std::uint32_t i = block.first; i < block.last; ++i) {
    ContactRows& c = rows_[i];
    if (!struck(c)) continue;
    const float before = c.normal.impulse, wanted = c.normal.speed(a, b) + block.restitution * c.approach;
    c.normal.impulse = std::max(before - c.normal.effective_mass * wanted, 0.0f);
    c.normal.push(c.normal.impulse - before, a, b);
  }
}

void ContactSolver::restitute() {
  const auto none = [&](const Block& block) {
    if (block.restitution <= 0) return true;
    return std::none_of(rows_.begin() + block.first, rows_.begin() + block.last,
                        [&](const ContactRows& c) { return c.max_impulse > 0 && struck(c); });
  };
  static thread_local std::vector<Block> bouncing;
  bouncing.clear();
  std::remove_copy_if(blocks_.begin(), blocks_.end(), std::back_inserter(bouncing), none);
  for (int k = 0; k < bounce_sweeps; ++k)
    for (const Block& block : bouncing) bounce(block);
  for (const Block& block : bouncing)  // a blow is over: it must not warm-start the next step
    for (std::uint32_t i = block.first; i < block.last; ++i)
      if (struck(rows_[i])) rows_[i].normal.impulse = rows_[i].t1.impulse = rows_[i].t2.impulse = 0;
}

void ContactSolver::finish() {
  for (const Block& block : blocks_) {
    Manifold& m = world_.manifolds[block.manifold];
    for (std::size_t i = 0; i < m.contacts.size(); ++i) {
      const ContactRows& rows = rows_[block.first + i];
      m.contacts[i].normal_force = rows.normal.impulse / h_;
      m.contacts[i].friction_force =
          (rows.t1.impulse * rows.t1.direction + rows.t2.impulse * rows.t2.direction).head<3>() / h_;
    }
  }
  for (std::size_t i = 0; i < world_.bodies.size(); ++i) {
    Body& b = world_.bodies[i];
    b.v = motions_[i].v.head<3>();
    b.w = motions_[i].w.head<3>();
    if (b.moves()) b.x += motions_[i].moved.head<3>();
  }
}

}  // namespace

void solve(World& world) {
  static thread_local Scratch scratch;
  ContactSolver solver(world, scratch);
  solver.prepare();
  for (int k = 0; k < world.sub_steps(); ++k) {
    solver.accelerate();
    solver.warm_start();
    solver.sweep(true);
    solver.move();
    solver.sweep(false);
  }
  solver.restitute();
  solver.finish();
}

}  // namespace bin_scenes::sphere
