/// A world that no group can hold in its shared memory, spread over many: the passes of a step as dispatches over its
/// bodies, its pairs, and the manifolds of each color (shaders/sphere/large). Each computes what the pass of one group
/// computes, with the same functions, so that a world gives the same bits either way.
///
// clang-format off
///     find_pairs       cut (twice) ─► boxes ─► count cells ─► sum ─► sort ─► count pairs ─► sum ─► list pairs ─► adopt ─► end
///     color_manifolds  begin ─► (bid ─► take) a round ─► starts ─► order
///     solve            begin ─► prepare ─► sub-steps of (velocities, warm start, sweeps, positions, sweeps) ─► keep
///     update_sleep     note ─► join islands ─► mark ─► settle
// clang-format on
///
/// A sweep is a dispatch a color that is wider than a group, and one group for all others, one after the other. How
/// many groups a dispatch has is known on the device alone: the arguments lie in SphereLarge. How many colors are wide
/// the host learns whenever it observes; those it does not know of yet are left to the one group. Buffers here serve
/// one such world after the other.
#pragma once

#include "bin_scenes/gl/buffer.hpp"
#include "bin_scenes/gl/prefix_sum.hpp"
#include "bin_scenes/gl/program.hpp"
#include "shared/sphere_large.h"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <functional>

namespace bin_scenes::sphere_gl {

/// The world of a step.
struct LargeWorld {
  gpu::uint world = 0;  ///< its place among the worlds
  std::size_t bodies = 0;
  float smallest_cell = 0;             ///< m: the diagonal of the largest part that moves
  unsigned sub_steps = 1, sweeps = 1;  ///< of this step; over all manifolds, before and after bodies move
  unsigned cold_sweeps = 0;            ///< the same while the world's contacts begin without forces; 0: they do not
  bool rigid = false;                  ///< contacts: one sweep after bodies move
  bool restitution = false;            ///< something in it bounces
  unsigned colors = 0;                 ///< that have dispatches of their own
};

class LargePasses {
 public:
  explicit LargePasses(const Capacity& capacity);

  void make_room(std::size_t bodies);
  void bind() const;

  // The passes. find_pairs takes bindings 0, 1 and 2 for a while; `bind_first` binds what belongs there.
  void find_pairs(const LargeWorld& world, const std::function<void()>& bind_first);
  void color_manifolds(const LargeWorld& world);
  void solve(const LargeWorld& world);
  void update_sleep(const LargeWorld& world);

  std::size_t bytes() const;

 private:
  void over_bodies(const gl::Program& pass, const LargeWorld& world);
  void indirect(const gl::Program& pass, std::size_t arguments, gl::Barrier after = gl::Barrier::storage);
  void sweep(unsigned kind, const LargeWorld& world);
  void sweeps(unsigned first, unsigned kind, const LargeWorld& world);
  void over_manifolds(unsigned stage);
  void set_world(const LargeWorld& world) const;

  unsigned rounds_;  ///< of coloring, with dispatches of their own
  gl::Program cut_step_, find_boxes_, sort_bodies_, list_pairs_, adopt_pairs_, end_pairs_, color_pairs_, order_colors_,
      solve_bodies_, solve_manifolds_, solve_rest_, join_islands_, sleep_bodies_;
  gl::PrefixSum prefix_sum_;
  gl::Buffer<gpu::SphereLarge> large_{"sphere.large"};
  gl::Buffer<gpu::SphereBox> boxes_{"sphere.boxes"};  ///< in the solve: motions
  gl::Buffer<gpu::SphereWork> work_{"sphere.work"};
  gl::Buffer<gpu::uint> cell_counts_{"sphere.cell_counts"};
  gl::Buffer<gpu::uint> cell_starts_{"sphere.cell_starts"};
  gl::Buffer<gpu::uint> sorted_{"sphere.sorted"};
  gl::Buffer<gpu::uint> pair_counts_{"sphere.pair_counts"};
  gl::Buffer<gpu::uint> pair_starts_{"sphere.pair_starts"};
};

}  // namespace bin_scenes::sphere_gl
