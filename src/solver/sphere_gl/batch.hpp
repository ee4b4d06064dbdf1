/// The worlds that are stored on the GPU, and the passes of one step over a selection of them. A pass has the same name
/// everywhere: its method here, its timer, its CPU form (solver/sphere/world.hpp), and shaders/sphere/<name>.comp. Two
/// passes consist of several shaders: find_contacts of five, and solve of two.
///
// clang-format off
///     shapes     | part 0: nodes, edges, clusters, field | part 1 | ...  shared by all worlds, never change
///     bodies     | world 0 ............... | world 1 ...... | ...        same layout: states, tensors, boxes, ranges
///     near       | world 0: bits, list     | world 1 ...... | ...        of pairs of bodies that may come near
///     pairs      | world 0: page 0, page 1 | world 1: page 0, page 1 |   pages alternate, sorted by (a, b)
///     manifolds  | world 0: capacity slots | world 1 | ...               a pair keeps its slot while it exists
///     contacts   | world 0: capacity slots | world 1 | ...              eight for each slot
///     rows       | world 0: capacity rows | world 1 | ...               data of the contacts that this step solves;
///                                                                        impulses have the same layout
///     jobs       | pairs of all worlds whose contacts are found anew |
///     samples    | samples near the other part of a pair, unordered |  touches and candidates have lists of the same
///                                                                      kind; the candidates of a job are linked
///
/// A step is eleven dispatches, however many worlds run:
///
///     find_pairs ─► list_jobs ─► collect_samples ─► test_samples ─► offer_contacts ─► choose_contacts ─►
///     group/world   thread/pair  group/pair         thread/sample   thread/touch      group/pair
///     color_manifolds ─► prepare_rows ─► solve ─► note_depths ─► update_sleep
///     group/world        thread/manifold  group/world, all three
// clang-format on
///
/// begin_watch runs before a series of steps, and watch_rest and audit_energy run after it, with one group for each
/// world. The host then reads 32 bytes for each world; it reads the states of bodies only when it needs them.
///
/// Between two passes there is only a barrier; the host does nothing. In `solve`, one group processes all sub-steps and
/// colors of a step. A world that has finished its steps, or that has too little room in a list, does not change until
/// the host has read its progress.
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
  using Slot = std::size_t;  ///< index of a world on the device
  /// Data of WorldWatch that are uploaded with the state of a body.
  struct Mark {
    bool enters = false;  ///< the body was inserted: the audit of its energy begins with this state
    gpu::uint moved = 0;  ///< new value of WatchedBody::moved
  };

  explicit Batch(const Capacity& capacity = {});

  /// Makes room for a world and uploads it: bodies, states, pairs and contacts. Settings are the same for all worlds.
  /// @param progress  is set to the initial progress of the world.
  Slot add(const sphere::World& world, gpu::SphereProgress& progress);
  void remove(Slot slot);

  /// Uploads the states of the given bodies of a world; marks[i] belongs to body i. Adjacent bodies need one copy.
  void upload_states(Slot slot, const sphere::World& world, const std::set<std::size_t>& bodies,
                     const std::vector<Mark>& marks);
  void upload_states(Slot slot, const sphere::World& world);
  /// Uploads the progress of worlds; it takes effect at the next pass. Worlds in adjacent slots need one copy.
  void upload_progress(std::vector<std::pair<Slot, gpu::SphereProgress>> worlds);
  /// Uploads the number of steps and the requested observations of worlds, in the same way.
  void upload_asks(std::vector<std::pair<Slot, gpu::SphereAsk>> worlds);
  /// Resets the worst contact of a world: only contacts of the next steps count.
  void forget_worst(Slot slot);
  /// Requests the results of the passes that were started before: the counts of the worlds `seen`, and all data of the
  /// worlds `read`. `back` can be waited for later. It contains SphereSeen of each world of `seen`; then for the worlds
  /// of `read` the progress of each, then the worst contact of each, the audit of each, and the states of each.
  void request(const std::vector<Slot>& seen, const std::vector<Slot>& read, gl::ReadBack& back) const;
  /// Requests the progress of worlds only.
  void request_progress(const std::vector<Slot>& slots, gl::ReadBack& back) const;

  /// Enlarges the lists of pairs and contacts of a world to the need that its progress states; their contents are kept.
  void grow_pairs(Slot slot, gpu::SphereProgress& progress);
  /// Makes room for `need` rows of the solve. Their contents are lost, because rows are valid within one step only.
  void grow_rows(Slot slot, std::size_t need);
  /// Enlarges the lists of samples and of candidates to these numbers of elements, but not beyond the memory limit; a
  /// step that needs more is repeated until all contacts are found.
  void grow_candidates(std::size_t samples, std::size_t candidates);

  /// Reads the states and manifolds of one world from the device, after the passes that were started before.
  void download(Slot slot, sphere::World& world) const;
  /// For tests: return the progress of a world, its worst contact, and its manifolds as they are on the device.
  gpu::SphereProgress progress(Slot slot) const { return progress_.download(slot, 1)[0]; }
  gpu::SphereWorst worst(Slot slot) const { return worst_.download(slot, 1)[0]; }
  ManifoldImage manifolds(Slot slot) const;

  /// Selects the worlds that the next passes process, and the length of their steps as a share of the full time step.
  void run(const std::vector<Slot>& slots, float share = 1.0f);
  void step();

  // The passes of step() in their order.
  void find_pairs();
  void find_contacts();
  void color_manifolds();
  void prepare_rows();
  void note_depths();
  void solve();
  void update_sleep();
  // The passes before and after a series of steps.
  void begin_watch();
  void watch_rest();
  void audit_energy();

  gl::Timer& timer() { return timer_; }
  std::size_t bytes() const;         ///< size of all buffers on the device (bytes)
  std::size_t bytes_shared() const;  ///< the part of bytes() that does not grow with worlds: shapes and settings

 private:
  struct Region {
    std::size_t first_body = 0, bodies = 0, first_word = 0, words = 0, first_pair = 0, capacity = 0, first_row = 0,
                rows = 0, sharing_sweeps = 0, impact_sweeps = 0, first_plane = 0, planes = 0;
  };
  void make_room();
  std::size_t most_candidates() const;
  void upload_world(Slot slot);
  void bind() const;
  /// Reserves the regions of a world in all lists.
  void take_region(Slot slot, const sphere::World& world);
  /// Uploads the pairs of a world with their manifolds and contacts. Returns a progress with their counts.
  gpu::SphereProgress upload_pairs(Slot slot, const sphere::World& world);

  std::vector<Region> regions_;
  std::vector<gpu::SphereWorld> host_worlds_;
  Arena slots_, body_arena_, word_arena_, pair_arena_, row_arena_, plane_arena_;
  gpu::SphereSettingsBlock settings_block_{};
  Capacity capacity_;
  std::size_t running_count_ = 0, contact_groups_ = 1;
  std::size_t most_pairs_ = 0;                            ///< largest capacity of pairs of a selected world
  std::size_t pair_group_;                                ///< number of invocations of a group that processes pairs
  std::size_t least_samples_ = 0, least_candidates_ = 0;  ///< smallest lengths of these lists
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
