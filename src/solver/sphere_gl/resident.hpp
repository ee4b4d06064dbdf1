/// The host's record of a world on the device: where its regions are in the buffers, how far it has been simulated, and
/// what was last read back. It also reads the states and results of the device. The passes themselves are in batch.hpp.
#pragma once

#include "bin_scenes/gl/buffer.hpp"
#include "bin_scenes/solver/world_watch.hpp"
#include "solver/sphere_gl/batch.hpp"

#include <memory>
#include <set>
#include <vector>

namespace bin_scenes::sphere_gl {

/// The host's copy of a world: as it was last read, with the later changes of bodies by the caller.
struct Resident {
  sphere::World world;
  std::size_t bodies = 0;  ///< number of bodies of the caller; a bin that is a mesh is one more body, after these
  Batch::Slot slot = 0;
  std::set<std::size_t> changed;   ///< bodies whose states must be uploaded
  std::vector<Batch::Mark> marks;  ///< index: body
  std::uint64_t steps = 0;
  std::uint64_t left = 0;  ///< number of dispatches of step() that the present steps still need; above 0: under way
  std::uint64_t cuts = 1;  ///< number of dispatches that the last whole step needed
  gpu::SphereProgress progress{};
  bool progress_changed = true;  ///< `progress` must be uploaded
  bool counted = false;          ///< the counters of `progress` were read: the device must set them to 0
  gpu::SphereWorst worst{};      ///< deepest contact since take_worst_contact()
  bool worst_taken = false;      ///< take_worst_contact() was called: the device must reset the deepest contact
  bool known = true;             ///< the members above agree with the device
  int unread = 0;                ///< number of series of steps that were started since they were last read

  bool watched = false;  ///< the device observes the world (WorldWatch); states are read only on request
  bool wants_states = false;
  gpu::SphereAsk ask{};
  gpu::SphereAudit audit{};
  WatchSeen seen;
  std::vector<WatchedBody> watched_bodies;
};

/// A world without room waits no longer than these steps for the host. A slice of 7 steps seldom needs more, as parts
/// that fall into a bin cut a step into 4.
constexpr std::uint64_t most_steps = 32;

/// Worlds whose steps were started, and whose results were not read yet.
struct Flight {
  std::vector<WorldId> ids;
  std::vector<WorldId> running;    ///< worlds that had steps left when they were last observed
  std::vector<Batch::Slot> slots;  ///< slots of `running`
  std::vector<WorldId> read;       ///< worlds of `running` whose states are read together with the counts
  std::unique_ptr<gl::ReadBack> back;
  std::uint64_t most = most_steps;  ///< largest number of dispatches of step() between two observations
  float share = 1.0f;               ///< length of each step / length of a full step
  float rest = 0.0f;                ///< the same for one more step that follows the others; 0: none
};

/// Returns the slots of worlds, those whose steps have the most sweeps first: a card begins groups in this order, and a
/// dispatch lasts as long as its last group.
std::vector<Batch::Slot> longest_first(const std::vector<const Resident*>& residents);
/// Returns the bodies that have contacts with `body`. The CPU passes find them, with all other bodies asleep.
std::vector<std::uint32_t> touched(sphere::World world, std::size_t body);
/// Uploads the bodies that changed since the last steps, and resets the worst contact on the device if it was taken.
void upload_changes(Batch& batch, Resident& r);
/// Enlarges the lists of a world that were full in its last step. `samples` and `candidates` become at least the
/// lengths that it needs of the lists that all worlds share.
void make_room_for(Batch& batch, Resident& r, gpu::uint& samples, gpu::uint& candidates);
/// Adds the counters of a world to a profile and sets them to 0.
void take_counters(gpu::SphereProgress& progress, Profile& profile);
void set_rules(gpu::SphereAsk& ask, const WatchRules& rules);
void set_ask(gpu::SphereAsk& to, const WatchAsk& from);
WatchSeen seen_of(const gpu::SphereSeen& seen);
WatchedEnergy energy_of(const gpu::SphereAudit& audit);

/// Reads the data that Batch::request() gives for its worlds `read`: all progress, worst contacts, audits and states.
/// Those of worlds that have steps left are skipped.
void read_residents(const void* from, const std::vector<Resident*>& residents, Profile& profile);

}  // namespace bin_scenes::sphere_gl
