/// The solve of a step: sub-steps of soft contacts, Gauss-Seidel over bundles of eight contacts, a block of bodies that
/// touch each other at a time. What a contact is there stands in shaders/shared/sphere/contact.h; GLSL: solve.comp,
/// solve_body.h, solve_manifold.h.
#include "bin_scenes/core/cancel.hpp"
#include "core/in_parallel.hpp"
#include "solver/sphere/invariants.hpp"
#include "solver/sphere/passes/blocks.hpp"
#include "solver/sphere/passes/contact_rows.hpp"
#include "solver/sphere/passes/friction.hpp"
#include "solver/sphere/passes/gyroscope.hpp"
#include "solver/sphere/passes/held.hpp"
#include "solver/sphere/passes/restitution.hpp"
#include "solver/sphere/passes/team.hpp"
#include "solver/sphere/passes/turning_bin.hpp"
#include "solver/sphere/world.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace bin_scenes::sphere {

namespace {

constexpr std::size_t manifolds_for_a_team = 1000;  ///< fewer = helpers wait longer than they work

/// The solve of one step of a block. Bodies that sleep or are fixed take part as if nothing could move them.
class ContactSolver {
 public:
  ContactSolver(World& world, const Blocks& blocks, std::size_t block, Scratch& scratch, Team& team)
      : world_(world),
        team_(team),
        blocks_(blocks),
        block_(block),
        bodies_(blocks.bodies(block)),
        settings_(world.settings),
        plan_(world.plan()),
        h_(plan_.sub_step),
        impact_speed_(impact_speed(h_, world.gravity.norm(), settings_.restitution_speed)),
        softly_(softly(h_, world.softness().hertz_share, world.softness().damping_ratio,
                       world.softness().slop * world.smallest_size,
                       settings_.push_speed / static_cast<float>(world.softness().refinement) * world.smallest_size)),
        firmly_(firmly(h_)),
        shares_impacts_(world.impact_sweeps(false) > 0),
        tolerance_(world.tolerance(false)),
        motions_(scratch.motions),
        free_(scratch.free),
        slides_(scratch.slides),
        speeds_(scratch.speeds),
        bundles_(scratch.bundles),
        colors_(scratch.colors),
        rows_(scratch.rows),
        jaws_(world, blocks, block) {}

  void prepare();  ///< rows from contacts, with the forces of the last step
  std::uint64_t falling() const { return static_cast<std::uint64_t>(std::count(free_.begin(), free_.end(), 1)); }
  void accelerate();  ///< gravity, and the gyroscopic term of what does not turn freely
  void warm_start();  ///< impulses of the last sub-step again
  /// One round of Gauss-Seidel over all contacts. `push` lets overlap out softly; without, the velocity that pushing
  /// left is taken back (relaxation). In the `first` that pushes, patches resist turns.
  /// Returns whether it has changed a contact's speed by more than Settings::tolerance: another one has to share an
  /// impact.
  bool sweep(bool push, bool first);
  /// `least` sweeps, and more while an impact is not shared.
  void sweep_until_shared(bool push, int least);
  bool struck() const { return struck_; }                   ///< bodies met fast in this step
  std::uint64_t unresolved() const { return unresolved_; }  ///< sub-steps that left an impact unshared
  void hold_by_friction(bool holds) { friction_holds_ = holds; }
  void note_sliding();    ///< bodies that friction brakes
  void refresh_levers();  ///< of what is hit
  void move();            ///< positions
  void restitute() { Restitution(bundles_, rows_, motions_, h_, settings_.restitution_speed).apply(jaws_); }
  void finish();  ///< back into bodies and contacts

 private:
  void prepare_motions(std::size_t unmoved);
  /// `work(first, last)` of bundles, color by color; within a color by all threads.
  template <class Work>
  void for_each_color(const Work& work) {
    for (const Color& c : colors_) {
      const std::uint32_t count = c.last - c.first;
      team_.share(count, c.in_turn ? count : bundles_per_piece,
                  [&](std::uint32_t first, std::uint32_t last) { work(c.first + first, c.first + last); });
      jaws_.keep_to_axis(motions_);
    }
  }
  /// Of all colors at once.
  template <class Work>
  void for_each_bundle(const Work& work) {
    team_.share(static_cast<std::uint32_t>(bundles_.size()), bundles_per_piece,
                [&](std::uint32_t first, std::uint32_t last) {
                  for (std::uint32_t i = first; i < last; ++i) work(bundles_[i]);
                });
  }
  /// `work(i)` for each body of the block.
  template <class Work>
  void for_each_body(const Work& work) {
    constexpr std::uint32_t bodies_per_piece = 64;
    team_.share(static_cast<std::uint32_t>(bodies_.size()), bodies_per_piece,
                [&](std::uint32_t first, std::uint32_t last) {
                  for (std::uint32_t i = first; i < last; ++i) work(i);
                });
  }
  void warm_start(std::uint32_t first, std::uint32_t last);
  bool sweep(std::uint32_t from, std::uint32_t to, bool push, bool first);
  /// A bundle in a sweep.
  struct Swept {
    const Bundle& bundle;
    Velocities u;
    Lanes friction;
  };
  Swept begin(const Bundle& bundle, bool push, bool first);
  float speed(std::size_t body) const;
  bool gyrates(const Motion& motion) const {
    return settings_.gyroscopic && vector_of(motion.w).squaredNorm() * h_ * h_ >= LEAST_GYRATION * LEAST_GYRATION;
  }
  /// Whether nothing touches a body of the block: it falls along the exact parabola.
  bool flies(std::size_t body) const { return free_[body] && motions_[body].inverse_mass() > 0 && !jaws_.has(body); }
  /// Whether a body is turned by turn_freely(), and not with the spin after the sub-step.
  bool turns_freely(std::size_t body) const { return world_.exact_impacts && flies(body) && gyrates(motions_[body]); }
  void observe_gaps(const Bundle& bundle);
  void solve_normal(ContactRows& c, Velocities& u, const Give& give, LaneMask& unconverged) const;

  World& world_;
  Team& team_;
  const Blocks& blocks_;
  const std::size_t block_;
  const Slice bodies_;
  const Settings& settings_;
  const StepPlan plan_;
  const float h_;             ///< s, of a sub-step
  const float impact_speed_;  ///< m/s
  const Give softly_, firmly_;
  const bool shares_impacts_;  ///< by further sweeps
  float tolerance_;            ///< m/s
  bool friction_holds_ = true;
  bool struck_ = false;    ///< some contact closes fast
  bool impact_ = false;    ///< it does, or did in the step before: what is left of the impact is no force yet
  bool unshared_ = false;  ///< an impact is, in this sub-step
  std::uint64_t unresolved_ = 0;
  std::vector<Motion>& motions_;
  std::vector<char>& free_;
  std::vector<char>& slides_;
  std::vector<float>& speeds_;
  std::vector<Bundle>& bundles_;
  std::vector<Color>& colors_;
  std::vector<ContactRows>& rows_;
  const HeldJaws jaws_;
};

void ContactSolver::prepare_motions(std::size_t unmoved) {
  motions_.assign(bodies_.size() + unmoved, Motion{});
  free_.assign(bodies_.size(), 1);
  slides_.assign(bodies_.size() + unmoved, 0);
  speeds_.assign(bodies_.size(), 0.0f);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = world_.bodies[bodies_[i]];
    motions_[i].v = padded(b.v, b.inverse_mass);
    motions_[i].w = padded(b.w);
  }
  BIN_SCENES_ASSERT(each_is(bodies_, [this](std::uint32_t body) { return world_.bodies[body].moves(); }));
  jaws_.begin(motions_);
}

void ContactSolver::prepare() {
  prepare_motions(make_bundles(world_, blocks_, block_, bundles_, colors_, rows_));
  for_each_bundle([&](Bundle& bundle) { sphere::prepare(world_, motions_, h_, bundle, rows_); });
  for (const Bundle& bundle : bundles_) {
    struck_ = struck_ || any(bundle.strikes);
    for (int lane = 0; lane < bundle.lanes; ++lane)
      for (const std::uint32_t i : {bundle.a[lane], bundle.b[lane]})
        if (i < free_.size()) free_[i] = 0;
  }
  impact_ = struck_ || world_.struck;
  tolerance_ = world_.tolerance(impact_);
}

void ContactSolver::accelerate() {
  const Vec3f gain = h_ * world_.gravity;
  if (world_.frame.turns()) turn_with_bin(world_, bodies_, h_, motions_);
  for_each_body([&](std::size_t i) {
    Motion& motion = motions_[i];
    if (motion.inverse_mass() == 0 || jaws_.has(i)) return;  // on a path
    speeds_[i] = speed(i);
    Body& b = world_.bodies[bodies_[i]];
    Vec3f v = vector_of(motion.v);
    add_exactly(gain, v, b.v_rest);
    motion.v = padded(v, motion.inverse_mass());
    if (turns_freely(i) || !gyrates(motion)) return;
    const Mat3f rotation = b.q.toRotationMatrix();
    motion.w += padded(rotation * gyroscopic_change(b, rotation, vector_of(motion.w), h_));
  });
  pull(world_, blocks_, block_, h_, motions_);
  jaws_.press(h_, motions_);
}

void ContactSolver::warm_start() {
  for_each_color([&](std::uint32_t first, std::uint32_t last) { warm_start(first, last); });
}

BIN_SCENES_WIDE
void ContactSolver::warm_start(std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t k = first; k < last; ++k) {
    const Bundle& bundle = bundles_[k];
    Velocities u = velocities_of(bundle, motions_);
    for (std::uint32_t i = bundle.first; i < bundle.last; ++i) {
      ContactRows& c = rows_[i];
      forget_impact(c, bundle, impact_speed_, settings_.restitution_speed);
      c.lasting = c.normal_impulse;
      u.push(c.normal_impulse * c.normal + c.t1_impulse * c.tangent + c.t2_impulse * cross(c.normal, c.tangent), c,
             bundle);
    }
    store(u, bundle, motions_);
  }
}

/// Sequential impulse, accumulated and clamped.
void ContactSolver::solve_normal(ContactRows& c, Velocities& u, const Give& give, LaneMask& unconverged) const {
  const Lanes before = c.normal_impulse;
  c.normal_impulse = normal_impulse(before, u.along_normal(c), c.gap, c.normal_mass, give);
  c.max_impulse = max(c.max_impulse, c.normal_impulse);
  const Lanes more = c.normal_impulse - before;
  if (shares_impacts_) unconverged |= is_unconverged(more, c.normal_mass, tolerance_);
  u.push_along_normal(more, c);
}

/// How far apart contacts are, bodies having moved.
void ContactSolver::observe_gaps(const Bundle& bundle) {
  const Displacements moved = displacements_of(bundle, motions_);
  for (std::uint32_t i = bundle.first; i < bundle.last; ++i) rows_[i].gap = rows_[i].separation + moved.along(rows_[i]);
}

/// What a sweep begins a bundle with.
ContactSolver::Swept ContactSolver::begin(const Bundle& bundle, bool push, bool first) {
  Swept swept{bundle, velocities_of(bundle, motions_), friction_holds_ ? bundle.friction : Lanes{}};
  if (first && (!push || !settings_.relaxation)) observe_gaps(bundle);
  const Lanes radius = all_lanes(settings_.patch_radius * world_.smallest_size);
  if (push && first) resist_turn(bundle, rows_, radius, swept.friction, swept.u);
  return swept;
}

bool ContactSolver::sweep(bool push, bool first) {
  std::atomic<bool> unconverged{false};
  for_each_color([&](std::uint32_t begin, std::uint32_t end) {
    if (sweep(begin, end, push, first)) unconverged.store(true, std::memory_order_relaxed);
  });
  return unconverged;
}

BIN_SCENES_WIDE
bool ContactSolver::sweep(std::uint32_t from, std::uint32_t to, bool push, bool first) {
  LaneMask unconverged{};
  const Give& give = push ? softly_ : firmly_;
  const auto normal = [&](Swept& s, std::uint32_t k) {
    if (s.bundle.first + k < s.bundle.last) solve_normal(rows_[s.bundle.first + k], s.u, give, unconverged);
  };
  const auto friction = [&](Swept& s, std::uint32_t k) {
    if (s.bundle.first + k < s.bundle.last && any(has_friction(rows_[s.bundle.first + k])))
      solve_friction(rows_[s.bundle.first + k], s.friction, s.bundle, s.u);
  };
  for (std::uint32_t i = from; i < to; ++i) {
    Swept p = begin(bundles_[i], push, first);
    if (!p.bundle.paired) {
      for (std::uint32_t k = 0; k < p.bundle.rows(); ++k) normal(p, k);
      for (std::uint32_t k = 0; k < p.bundle.rows(); ++k) friction(p, k);
      store(p.u, p.bundle, motions_);
      continue;
    }
    // Contact by contact in turn: while one bundle waits for the result of its last contact, the other is solved.
    Swept q = begin(bundles_[++i], push, first);
    const std::uint32_t longest = std::max(p.bundle.rows(), q.bundle.rows());
    for (std::uint32_t k = 0; k < longest; ++k) {
      normal(p, k);
      normal(q, k);
    }
    for (std::uint32_t k = 0; k < longest; ++k) {
      friction(p, k);
      friction(q, k);
    }
    store(p.u, p.bundle, motions_);
    store(q.u, q.bundle, motions_);
  }
  return any(unconverged);
}

void ContactSolver::sweep_until_shared(bool push, int least) {
  const int most = world_.impact_sweeps(impact_);
  unshared_ = unshared_ && !push;
  for (int i = 0; i < least || (unshared_ && i < most); ++i) unshared_ = sweep(push, i == 0);
  unresolved_ += push && unshared_ && impact_ && most > 0;
}

void ContactSolver::refresh_levers() {
  for_each_bundle([&](Bundle& bundle) {
    if (any(bundle.refreshed)) sphere::refresh_levers(world_, motions_, bundle, rows_);
  });
}

float ContactSolver::speed(std::size_t body) const {
  const Motion& motion = motions_[body];
  const float radius = world_.shapes[world_.bodies[bodies_[body]].shape]->radius;
  return std::sqrt(vector_of(motion.v).squaredNorm() + radius * radius * vector_of(motion.w).squaredNorm());
}

void ContactSolver::note_sliding() {
  std::fill(slides_.begin(), slides_.end(), 0);
  const float slow = 4.0f * h_ * world_.gravity.norm();  // stops within a few sub-steps
  if (std::all_of(speeds_.begin(), speeds_.end(), [&](float speed) { return speed <= slow; })) return;
  const auto fast = [&](std::uint32_t body) { return body < speeds_.size() && speeds_[body] > slow; };
  for (const Bundle& bundle : bundles_) {
    if (std::none_of(bundle.a.begin(), bundle.a.end(), fast) && std::none_of(bundle.b.begin(), bundle.b.end(), fast))
      continue;
    LaneMask slip{};
    for (std::uint32_t i = bundle.first; i < bundle.last; ++i)
      slip |= slips(bundle.friction * rows_[i].normal_impulse, rows_[i].t1_impulse, rows_[i].t2_impulse);
    for (int lane = 0; any(slip) && lane < bundle.lanes; ++lane)
      if (slip[lane]) slides_[bundle.a[lane]] = slides_[bundle.b[lane]] = 1;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) slides_[i] &= speeds_[i] > slow;
}

/// Friction that slips brakes evenly: with the speed that a sub-step ends with, a sliding part stops too early by
/// half a sub-step's distance. What holds, rolls or swings keeps its energy with that speed, and would gain some with
/// the mean.
void ContactSolver::move() {
  const Quad parabola = padded(0.5f * h_ * h_ * world_.gravity);
  for_each_body([&](std::size_t i) {
    Motion& motion = motions_[i];
    const float h = slides_[i] ? h_ * mean_share(speeds_[i], speed(i)) : h_;
    motion.moved += h * motion.v;
    if (flies(i)) motion.moved -= parabola;
    motion.turned += h * motion.w;
    Body& b = world_.bodies[bodies_[i]];
    if (turns_freely(i)) {
      Vec3f w = vector_of(motion.w);
      turn_freely(b, w, h);
      motion.w = padded(w);
    } else {
      b.q = integrated(b.q, vector_of(motion.w), h);
    }
  });
}

void ContactSolver::finish() {
  for_each_bundle([&](Bundle& bundle) {
    for (std::uint32_t i = bundle.first; i < bundle.last; ++i)
      forget_impact(rows_[i], bundle, impact_speed_, settings_.restitution_speed);
    keep_forces(bundle, rows_, h_, world_);
  });
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& b = world_.bodies[bodies_[i]];
    b.v = vector_of(motions_[i].v);
    b.w = vector_of(motions_[i].w);
    add_exactly(vector_of(motions_[i].moved), b.x, b.x_rest);
  }
}

void solve_block(ContactSolver& solver, const StepPlan& plan) {
  BIN_SCENES_ASSERT(plan.sub_steps >= 1 && plan.sweeps >= 1 && plan.relaxing_sweeps >= 0);
  solver.prepare();
  solver.refresh_levers();
  for (int k = 0; k < plan.sub_steps; ++k) {
    solver.hold_by_friction(k >= plan.slip_sub_steps);
    solver.accelerate();
    stop_if_cancelled();
    solver.warm_start();
    solver.sweep_until_shared(true, plan.sweeps);
    solver.note_sliding();
    solver.move();
    solver.refresh_levers();
    solver.sweep_until_shared(false, plan.relaxing_sweeps);
  }
  solver.restitute();
  solver.finish();
}

/// Sums over blocks.
struct Counts {
  std::atomic<std::uint64_t> falling{0}, unresolved{0};
  std::atomic<bool> struck{false};
};

void solve_block(World& world, const Blocks& blocks, std::size_t block, Counts& counts) {
  static thread_local Scratch scratch;
  Team team;
  ContactSolver solver(world, blocks, block, scratch, team);
  const bool large = blocks.manifolds(block).size() >= manifolds_for_a_team;
  tbb::this_task_arena::isolate([&] {
    team.run(large ? tbb::this_task_arena::max_concurrency() - 1 : 0, [&] { solve_block(solver, world.plan()); });
  });
  counts.falling += solver.falling();
  counts.unresolved += solver.unresolved();
  if (solver.struck()) counts.struck = true;
}

}  // namespace

void solve(World& world) {
  static thread_local Blocks kept;  // for its memory alone
  Blocks& blocks = kept;            // of this thread, in whatever thread a block is solved
  BIN_SCENES_ASSERT(colors_share_no_body(world));
  blocks.make(world);
  Counts counts;
  in_parallel(blocks.count(), [&](std::size_t block) { solve_block(world, blocks, block, counts); });
  BIN_SCENES_ASSERT(counts.falling <= world.bodies.size());
  world.counters.free_steps += counts.falling;
  world.deepest.unresolved_impacts += counts.unresolved;
  world.struck = world.exact_impacts && counts.struck;
  BIN_SCENES_ASSERT(orientations_are_unit(world));
}

}  // namespace bin_scenes::sphere
