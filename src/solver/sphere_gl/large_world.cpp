/// The passes of a world that fills more than one group, as chains of dispatches (shaders/sphere/large). CPU form:
/// src/solver/sphere/passes.
#include "solver/sphere_gl/large_world.hpp"

#include <algorithm>
#include <cstddef>

namespace bin_scenes::sphere_gl {

namespace {

gl::Program spread_pass(const char* name, const gl::Defines& defines = {}) {
  return gl::Program::compute(std::string("sphere/large/") + name + ".comp", defines);
}

/// Cells that bodies fall into by hash: a power of two, at least as many as bodies.
std::size_t buckets_for(std::size_t bodies) {
  std::size_t buckets = 64;
  while (buckets < bodies) buckets *= 2;
  return buckets;
}

}  // namespace

LargePasses::LargePasses(const Capacity& capacity)
    : rounds_(static_cast<unsigned>(std::min<std::size_t>(capacity.rounds, SPHERE_MOST_ROUNDS))),
      cut_step_(spread_pass("cut_step")),
      find_boxes_(spread_pass("find_boxes")),
      sort_bodies_(spread_pass("sort_bodies")),
      list_pairs_(spread_pass("list_pairs")),
      adopt_pairs_(spread_pass("adopt_pairs")),
      end_pairs_(spread_pass("end_pairs")),
      color_pairs_(spread_pass("color_pairs")),
      order_colors_(spread_pass("order_colors")),
      solve_bodies_(spread_pass("solve_bodies")),
      solve_manifolds_(spread_pass("solve_manifolds")),
      solve_rest_(spread_pass("solve_manifolds", {{"REST", ""}})),
      join_islands_(spread_pass("join_islands")),
      sleep_bodies_(spread_pass("sleep_bodies")) {}

void LargePasses::make_room(std::size_t bodies) {
  large_.grow(1);
  boxes_.grow(bodies);
  work_.grow(bodies);
  cell_counts_.grow(buckets_for(bodies));
  cell_starts_.grow(buckets_for(bodies) + 1);
  sorted_.grow(bodies);
  pair_counts_.grow(bodies);
  pair_starts_.grow(bodies + 1);
}

void LargePasses::bind() const {
  large_.bind(BIND_LARGE);
  boxes_.bind(BIND_BOXES);
  work_.bind(BIND_WORK);
  cell_counts_.bind(BIND_CELL_COUNTS);
  cell_starts_.bind(BIND_CELL_STARTS);
  sorted_.bind(BIND_SORTED);
  pair_counts_.bind(BIND_PAIR_COUNTS);
  pair_starts_.bind(BIND_PAIR_STARTS);
}

void LargePasses::set_world(const LargeWorld& world) const {
  for (const gl::Program* p :
       {&cut_step_, &find_boxes_, &sort_bodies_, &list_pairs_, &adopt_pairs_, &end_pairs_, &color_pairs_,
        &order_colors_, &solve_bodies_, &solve_manifolds_, &solve_rest_, &join_islands_, &sleep_bodies_})
    p->set("large_world", world.world);
  for (const gl::Program* p : {&sort_bodies_, &list_pairs_}) {
    p->set("smallest_cell", world.smallest_cell);
    p->set("buckets", static_cast<unsigned>(buckets_for(world.bodies)));
  }
  order_colors_.set("coloring_round", rounds_);
  order_colors_.set("spread_colors", world.colors);
}

void LargePasses::over_bodies(const gl::Program& pass, const LargeWorld& world) {
  gl::dispatch(pass, world.bodies);
}

void LargePasses::indirect(const gl::Program& pass, std::size_t arguments, gl::Barrier after) {
  gl::dispatch_indirect(pass, large_.storage(), arguments, after);
}

void LargePasses::find_pairs(const LargeWorld& world, const std::function<void()>& bind_first) {
  set_world(world);
  const auto bodies = [&](const gl::Program& pass, unsigned stage) {
    pass.set("stage", stage);
    over_bodies(pass, world);
  };
  const auto sum = [&](const gl::Buffer<gpu::uint>& counts, gl::Buffer<gpu::uint>& starts, std::size_t count) {
    prefix_sum_.run(counts, starts, count);
    bind_first();
  };
  bodies(cut_step_, CUT_MEASURE);
  bodies(cut_step_, CUT_SET);
  over_bodies(find_boxes_, world);
  bodies(sort_bodies_, LIST_COUNT);
  sum(cell_counts_, cell_starts_, buckets_for(world.bodies));
  bodies(sort_bodies_, LIST_PLACE);
  bodies(list_pairs_, LIST_COUNT);
  sum(pair_counts_, pair_starts_, world.bodies);
  bodies(list_pairs_, LIST_PLACE);
  over_bodies(adopt_pairs_, world);
  gl::dispatch_groups(end_pairs_, 1, gl::Barrier::arguments);
}

void LargePasses::color_manifolds(const LargeWorld& world) {
  set_world(world);
  color_pairs_.set("stage", COLOR_BEGIN);
  indirect(color_pairs_, offsetof(gpu::SphereLarge, pair_groups), gl::Barrier::arguments);
  for (unsigned round = 0; round < rounds_; ++round) {
    const std::size_t groups = offsetof(gpu::SphereLarge, round_groups) + round * sizeof(gpu::uvec4);
    color_pairs_.set("coloring_round", round);
    color_pairs_.set("stage", COLOR_BID);
    indirect(color_pairs_, groups);
    color_pairs_.set("stage", COLOR_TAKE);
    indirect(color_pairs_, groups, gl::Barrier::arguments);
  }
  gl::dispatch_groups(order_colors_, 1, gl::Barrier::arguments);
  for (const unsigned stage : {COLOR_ORDER, COLOR_JOIN}) {
    color_pairs_.set("stage", stage);
    indirect(color_pairs_, offsetof(gpu::SphereLarge, pair_groups));
  }
}

void LargePasses::over_manifolds(unsigned stage) {
  solve_manifolds_.set("stage", stage);
  indirect(solve_manifolds_, offsetof(gpu::SphereLarge, manifold_groups));
}

void LargePasses::sweep(unsigned kind, const LargeWorld& world) {
  solve_manifolds_.set("stage", kind);
  for (unsigned color = 0; color < world.colors; ++color) {
    solve_manifolds_.set("color", color);
    indirect(solve_manifolds_, offsetof(gpu::SphereLarge, color_groups) + color * sizeof(gpu::uvec4));
  }
  solve_rest_.set("stage", kind);
  indirect(solve_rest_, offsetof(gpu::SphereLarge, rest_groups));
}

/// The device knows in which step a world is no longer cold, the host learns it later.
void LargePasses::sweeps(unsigned first, unsigned kind, const LargeWorld& world) {
  for (unsigned i = 0; i < std::max(world.sweeps, world.cold_sweeps); ++i) {
    for (const gl::Program* p : {&solve_manifolds_, &solve_rest_}) p->set("only_cold", i < world.sweeps ? 0u : 1u);
    sweep(i == 0 ? first : kind, world);
  }
  for (const gl::Program* p : {&solve_manifolds_, &solve_rest_}) p->set("only_cold", 0u);
}

void LargePasses::solve(const LargeWorld& world) {
  set_world(world);
  const auto bodies = [&](unsigned stage) {
    solve_bodies_.set("stage", stage);
    over_bodies(solve_bodies_, world);
  };
  bodies(BODIES_BEGIN);
  over_manifolds(MANIFOLDS_PREPARE);
  for (unsigned k = 0; k < world.sub_steps; ++k) {
    for (const gl::Program* p : {&solve_manifolds_, &solve_rest_}) p->set("current_sub_step", k);
    bodies(BODIES_VELOCITIES);
    sweep(SWEEP_WARM_START, world);
    sweeps(SWEEP_FIRST_PUSH, SWEEP_PUSH, world);
    over_manifolds(MANIFOLDS_NOTE);
    bodies(BODIES_POSITIONS);
    if (world.rigid)
      sweep(SWEEP_FIRST_RELAX, world);
    else
      sweeps(SWEEP_FIRST_RELAX, SWEEP_RELAX, world);
  }
  if (world.restitution) {
    over_manifolds(MANIFOLDS_STRIKE);
    for (unsigned k = 0; k < SPHERE_BOUNCE_SWEEPS; ++k) sweep(SWEEP_BOUNCE, world);
  }
  over_manifolds(MANIFOLDS_KEEP);
  bodies(BODIES_KEEP);
}

void LargePasses::update_sleep(const LargeWorld& world) {
  set_world(world);
  sleep_bodies_.set("stage", SLEEP_NOTE);
  over_bodies(sleep_bodies_, world);
  indirect(join_islands_, offsetof(gpu::SphereLarge, pair_groups));
  for (const unsigned stage : {SLEEP_MARK, SLEEP_SETTLE}) {
    sleep_bodies_.set("stage", stage);
    over_bodies(sleep_bodies_, world);
  }
}

std::size_t LargePasses::bytes() const {
  std::size_t sum = 0;
  for (const gl::Storage* s :
       {&large_.storage(), &boxes_.storage(), &work_.storage(), &cell_counts_.storage(), &cell_starts_.storage(),
        &sorted_.storage(), &pair_counts_.storage(), &pair_starts_.storage()})
    sum += s->bytes();
  return sum;
}

}  // namespace bin_scenes::sphere_gl
