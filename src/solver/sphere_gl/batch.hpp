/// The worlds that live on the GPU, and the passes of one step over any choice of them. A pass has one name everywhere:
/// its method here, its timer, its twin on the CPU (solver/sphere/world.hpp), and shaders/sphere/<name>.comp, but that
/// find_contacts is four shaders, and solve two.
///
// clang-format off
///     shapes     | part 0: nodes, edges, clusters, field | part 1 | ...  shared by all worlds, never change
///     bodies     | world 0 ............... | world 1 ...... | ...        states, tensors, boxes, ranges alike
///     near       | world 0: bits, list     | world 1 ...... | ...        of bodies that may come near each other
///     pairs      | world 0: page 0, page 1 | world 1: page 0, page 1 |   take turns, sorted by (a, b)
///     manifolds  | world 0: capacity slots | world 1 | ...               a pair keeps its slot while it lasts
///     contacts   | world 0: capacity slots | world 1 | ...              eight to a slot
///     rows       | world 0: capacity rows | world 1 | ...               of contacts that are solved, of this step;
///                                                                        impulses alike
///     jobs       | pairs whose contacts are to be found, of all worlds |
///     samples    | samples near the other part of a pair, unordered |  touches and candidates have lists of the same
///                                                                      kind; a job's candidates are linked
///
/// A step is eleven dispatches, however many worlds run:
///
///     find_pairs ─► list_jobs ─► collect_samples ─► test_samples ─► offer_contacts ─► choose_contacts ─►
///     group/world   thread/pair  group/pair         thread/sample   thread/touch      group/pair
///     color_manifolds ─► prepare_rows ─► solve ─► note_depths ─► update_sleep
///     group/world        thread/manifold  group/world, all three
// clang-format on
///
/// begin_watch comes before the steps of a stretch, watch_rest and audit_energy behind them, a group a world: the host
/// then reads 32 bytes of a world, and its states only when it asks for them.
///
/// Between the passes of one world lies nothing but a barrier, and inside `solve` a whole step's sub-steps and colors
/// run without leaving the group. A world that has done its steps, or for whose pairs there is no room, is left as it
/// is until the host has observed it.
#pragma once

#include "bin_scenes/gl/buffer.hpp"
#include "bin_scenes/gl/program.hpp"
#include "bin_scenes/gl/timer.hpp"
#include "solver/sphere_gl/arena.hpp"
#include "solver/sphere_gl/convert.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"
#include "solver/sphere_gl/shape_table.hpp"

#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace bin_scenes::sphere_gl {

class Batch {
 public:
  using Slot = std::size_t;  ///< of a world
  /// Data of the watch that are uploaded with the state of a body.
  struct Mark {
    bool enters = false;  ///< its energy begins with this state
    gpu::uint moved = 0;  ///< what WatchedBody::moved becomes
  };

  explicit Batch(const Capacity& capacity = {});

  /// Makes room for a world and uploads it: bodies, states, pairs and contacts. Settings are the same for all worlds.
  /// @param progress filled with where the world stands.
  Slot add(const sphere::World& world, gpu::SphereProgress& progress);
  void remove(Slot slot);

  /// Those of some bodies, with marks by body; neighbours are one copy.
  void upload_states(Slot slot, const sphere::World& world, const std::set<std::size_t>& bodies,
                     const std::vector<Mark>& marks);
  void upload_states(Slot slot, const sphere::World& world);
  /// What the steps of worlds left behind; upload takes effect at the next pass. Neighbours are one copy.
  void upload_progress(std::vector<std::pair<Slot, gpu::SphereProgress>> worlds);
  /// What worlds are to do and to be observed for; likewise.
  void upload_asks(std::vector<std::pair<Slot, gpu::SphereAsk>> worlds);
  /// A world's worst contact is looked for from the next step on, and no earlier one counts.
  void forget_worst(Slot slot);
  /// Asks for what is seen of these worlds after the passes issued so far, and for all of some others or the same ones.
  /// Wait for `back` later: it holds SphereSeen of each of `seen`; then of each of `read` the progress, then the worst
  /// contact of each, then the audit of each, then the states of each.
  void request(const std::vector<Slot>& seen, const std::vector<Slot>& read, gl::ReadBack& back) const;
  /// The same for progress alone.
  void request_progress(const std::vector<Slot>& slots, gl::ReadBack& back) const;

  /// Room for more pairs of a world that had too little, and for their contacts, from its progress; contents are kept.
  void grow_pairs(Slot slot, gpu::SphereProgress& progress);
  /// Makes room for `need` rows of the solve. Their contents are lost, because rows are valid within one step only.
  void grow_rows(Slot slot, std::size_t need);
  /// Room for so many samples near another body, and candidates, or for as many as there may be at once: of more than
  /// that, repeated steps find the contacts.
  void grow_candidates(std::size_t samples, std::size_t candidates);

  /// Everything of one world, after waiting for the passes so far.
  void download(Slot slot, sphere::World& world) const;
  /// For tests: the progress of a world, its worst contact, and its manifolds as they are on the device.
  gpu::SphereProgress progress(Slot slot) const { return progress_.download(slot, 1)[0]; }
  gpu::SphereWorst worst(Slot slot) const { return worst_.download(slot, 1)[0]; }
  ManifoldImage manifolds(Slot slot) const;

  /// Worlds that the passes work on from now on, and the share of a whole step that their steps are.
  void run(const std::vector<Slot>& slots, float share = 1.0f);
  void step();

  // The passes in their order.
  void find_pairs();
  void find_contacts();
  void color_manifolds();
  void solve();
  void note_depths();
  void update_sleep();
  // Before and after the steps of a stretch.
  void begin_watch();
  void watch_rest();
  void audit_energy();

  gl::Timer& timer() { return timer_; }
  std::size_t bytes() const;         ///< of all buffers on the device
  std::size_t bytes_shared() const;  ///< of these, what does not grow with bodies: shapes, and what groups work with

 private:
  struct Region {
    std::size_t first_body = 0, bodies = 0, first_word = 0, words = 0, first_pair = 0, capacity = 0, first_row = 0,
                rows = 0, sharing_sweeps = 0, impact_sweeps = 0, first_plane = 0, planes = 0;
  };
  void make_room();
  std::size_t most_candidates() const;
  void upload_world(Slot slot);
  void bind() const;
  /// Places in all lists.
  void take_region(Slot slot, const sphere::World& world);
  /// Pairs with their manifolds and contacts; returns where a world stands that has them.
  gpu::SphereProgress upload_pairs(Slot slot, const sphere::World& world);

  std::vector<Region> regions_;
  std::vector<gpu::SphereWorld> host_worlds_;
  Arena slots_, body_arena_, word_arena_, pair_arena_, row_arena_, plane_arena_;
  gpu::SphereSettingsBlock settings_block_{};
  Capacity capacity_;
  std::size_t running_count_ = 0, contact_groups_ = 1;
  std::size_t most_pairs_ = 0;                            ///< room for them in one of the running worlds
  std::size_t pair_group_;                                ///< invocations of a group that takes a pair
  std::size_t least_samples_ = 0, least_candidates_ = 0;  ///< room for them
  bool bound_ = false;

  gl::Program find_pairs_, list_jobs_, collect_samples_, test_samples_, offer_contacts_, choose_contacts_,
      color_manifolds_, prepare_rows_, solve_, note_depths_, update_sleep_, begin_watch_, watch_rest_, audit_energy_;
  gl::Timer timer_;

  ShapeTable shapes_;
  gl::Buffer<gpu::SphereSettingsBlock> settings_{"sphere.settings"};
  gl::Buffer<gpu::uint> running_{"sphere.running"};
  gl::Buffer<gpu::SphereWorld> worlds_{"sphere.worlds"};
  gl::Buffer<gpu::SphereProgress> progress_{"sphere.progress"};
  gl::Buffer<gpu::SpherePlane> planes_{"sphere.planes"};
  gl::Buffer<gpu::SphereBody> bodies_{"sphere.bodies"};
  gl::Buffer<gpu::SphereState> states_{"sphere.states"};
  gl::Buffer<gpu::SphereTensor> tensors_{"sphere.tensors"};
  gl::Buffer<gpu::uint> near_{"sphere.near"};
  gl::Buffer<gpu::SphereBox> boxes_{"sphere.boxes"};
  gl::Buffer<gpu::uvec4> ranges_{"sphere.ranges"};
  gl::Buffer<gpu::SpherePair> pairs_{"sphere.pairs"};
  gl::Buffer<gpu::uint> free_{"sphere.free"};
  gl::Buffer<gpu::SphereManifold> manifolds_{"sphere.manifolds"};
  gl::Buffer<gpu::SphereContact> contacts_{"sphere.contacts"};
  gl::Buffer<gpu::uint> jobs_{"sphere.jobs"};
  gl::Buffer<gpu::SphereSample> near_samples_{"sphere.near_samples"};
  gl::Buffer<gpu::SphereTouch> touches_{"sphere.touches"};
  gl::Buffer<gpu::SphereCandidate> candidate_list_{"sphere.candidates"};
  gl::Buffer<gpu::uint> colors_{"sphere.colors"};
  gl::Buffer<gpu::SphereOrdered> order_{"sphere.order"};
  gl::Buffer<gpu::vec4> rows_{"sphere.rows"};
  gl::Buffer<gpu::vec2> impulses_{"sphere.impulses"};
  gl::Buffer<gpu::SphereWorst> worst_{"sphere.worst"};
  gl::Buffer<gpu::SphereAsk> asks_{"sphere.asks"};
  gl::Buffer<gpu::SphereWatched> watched_{"sphere.watched"};
  gl::Buffer<gpu::SphereAudit> audits_{"sphere.audits"};
  gl::Buffer<gpu::SphereSeen> seen_{"sphere.seen"};
};

}  // namespace bin_scenes::sphere_gl
