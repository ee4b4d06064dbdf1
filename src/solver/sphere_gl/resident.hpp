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

/// The state of a world when its steps were last read, except for bodies that were changed since.
struct Resident {
  sphere::World world;
  std::size_t bodies = 0;  ///< of the caller; a mesh bin adds one more behind them
  Batch::Slot slot = 0;
  std::set<std::size_t> changed;   ///< bodies to upload
  std::vector<Batch::Mark> marks;  ///< by body
  std::uint64_t steps = 0;
  gpu::SphereProgress progress{};
  bool progress_changed = true;  ///< it is to be uploaded
  bool counted = false;          ///< its counters were taken: the device is to begin them anew
  gpu::SphereWorst worst{};      ///< since it was taken
  bool worst_taken = false;      ///< the device is to forget it
  bool known = true;             ///< all of the above is up to date
  int unread = 0;                ///< series of steps that were issued since it was

  bool watched = false;  ///< states are read only when they are asked for
  bool wants_states = false;
  gpu::SphereAsk ask{};
  gpu::SphereAudit audit{};
  WatchSeen seen;
  std::vector<WatchedBody> watched_bodies;
};

/// Worlds whose steps were issued and not observed yet.
struct Flight {
  std::vector<WorldId> ids;
  std::vector<Batch::Slot> slots;
  std::vector<WorldId> read;  ///< those whose states are copied behind the last steps
  std::unique_ptr<gl::ReadBack> back;
  float share = 1.0f;  ///< of a whole step that each of the steps is
  float rest = 0.0f;   ///< the same of a last one that is yet to come; 0: none
};

/// What has contacts with a body: found anew by the passes on the CPU, for which all others sleep.
std::vector<std::uint32_t> touched(sphere::World world, std::size_t body);
/// Bodies that changed since the last steps; and the device forgets a worst contact that was taken.
void upload_changes(Batch& batch, Resident& r);
/// Provides the room that a world needs by its progress. What it needs of the common lists is added to `samples` and
/// `candidates`.
void make_room_for(Batch& batch, Resident& r, gpu::uint& samples, gpu::uint& candidates);
/// Moves the counters of a world to a profile.
void take_counters(gpu::SphereProgress& progress, Profile& profile);
void set_rules(gpu::SphereAsk& ask, const WatchRules& rules);
void set_ask(gpu::SphereAsk& to, const WatchAsk& from);
WatchSeen seen_of(const gpu::SphereSeen& seen);
WatchedEnergy energy_of(const gpu::SphereAudit& audit);

/// Reads what Batch::request() wrote of worlds that were wanted: progress of each, then worst contacts, audits, states.
void read_residents(const void* from, const std::vector<Resident*>& residents, Profile& profile);

}  // namespace bin_scenes::sphere_gl
