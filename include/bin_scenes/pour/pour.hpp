/// Makes a scene at rest from a request. Parts enter above the growing heap, at poses drawn from the seed and without
/// overlap. Parts that stay in place during a window of simulated time are at rest. Solvers are used through their
/// interface only (solver/solver.hpp). The result is judged elsewhere (quality/).
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <atomic>
#include <functional>

namespace bin_scenes {

/// The state of a running job, for the user.
struct Progress {
  std::string phase;      ///< "load", "prepare", "pour", "settle", "quality", "render", "write"
  std::size_t scene = 0;  ///< index of the scene
  std::size_t parts = 0, resting = 0;
  double simulated_s = 0.0;
  double fraction = 0.0;  ///< share of the job that is done, 0..1; never decreases
};

/// Optional callbacks of the caller.
struct RunHooks {
  std::function<void(const Progress&)> progress;
  const std::atomic<bool>* cancel = nullptr;  ///< if it becomes true, Error(cancelled) is thrown soon
  /// Called with the states of all bodies (option --trace): at the start, at the end of the step that is nearest to
  /// each multiple of 1 / `trace_rate` (Hz of simulated time; at most once per step), and at the end.
  std::function<void(std::size_t scene, double time, const std::vector<BodyState>&)> trace;
  double trace_rate = 0.0;
  /// Receives the contacts (Solver::contact_forces()) of the same instant as `trace`, which is called after it.
  std::function<void(const std::vector<ContactForce>&)> trace_contacts;
};

/// Returns the world of one scene of the request: one body for each part in the order of part lines, and walls up to
/// the rim. If the model of a mesh bin is not given, it is loaded through the cache.
WorldDef world_of(const LoadedRequest& loaded);

/// Pours the scenes with the given indices, as settle_scenes() (heap.hpp) does, and returns them in the order of the
/// indices.
///
/// While parts enter, the walls of a box are extended above the rim far enough to hold them. When all parts are in the
/// bin and slow, the walls are cut back to the rim if the heap is higher than the rim or if a motion follows.
///
/// A part has escaped if its centre of mass is then outside the inner floor area (at any height), below the floor, or
/// not finite. It is removed from the world and keeps its last finite pose. A part above the rim but within the floor
/// area has not escaped. For a mesh bin, the bounds of the mesh take the place of the inner box; with an endless floor,
/// a part escapes only below the floor; with no bin, only by NaN.
///
/// A part that finds no room below the rim when everything else has come to rest is not poured: it keeps its id, and
/// its pose is Pose::none().
///
/// Pouring ends when every part in the bin has stayed within Pour::rest_move and rest_turn for Pour::rest_window
/// (RestWatch), or at Pour::limit with parts in state `moving`. With Request::seconds, it ends at exactly that time, at
/// rest or not.
std::vector<Scene> pour(const LoadedRequest& loaded, Solver& solver, const std::vector<std::size_t>& indices,
                        const RunHooks& hooks = {});

/// Returns a hash of the bits of the poses of all parts.
std::uint64_t state_hash(const std::vector<ScenePart>& parts);

}  // namespace bin_scenes
