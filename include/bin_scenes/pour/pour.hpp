/// From a request to a scene at rest: parts start from seeded poses without overlap, enter above the growing heap, and
/// rest is decided over a window of simulated time. The code depends on the interface of solvers only.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <atomic>
#include <functional>

namespace bin_scenes {

struct Progress {
  std::string phase;      ///< "load", "prepare", "pour", "settle", "quality", "render", "write"
  std::size_t scene = 0;  ///< index of the scene
  std::size_t parts = 0, resting = 0;
  double simulated_s = 0.0;
  double fraction = 0.0;  ///< 0..1, never falls
};

/// Optional callbacks of a caller.
struct RunHooks {
  std::function<void(const Progress&)> progress;
  const std::atomic<bool>* cancel = nullptr;  ///< polled often; throws Error(cancelled)
  /// Called with the states of all bodies (option --trace): at the start, at the ends of the steps nearest to whole
  /// multiples of 1 / `trace_rate` (Hz of simulated time; at most once a step), and at the end.
  std::function<void(std::size_t scene, double time, const std::vector<BodyState>&)> trace;
  double trace_rate = 0.0;
  /// Called before `trace` with the contacts of the same moment (Solver::contact_forces()).
  std::function<void(const std::vector<ContactForce>&)> trace_contacts;
};

/// World of one scene of the request (bodies in order of part lines, one id each; walls up to the rim).
/// The model of a mesh bin is loaded through the cache when not given.
WorldDef world_of(const LoadedRequest& loaded);

/// Pours scene `index` of the request for each of the given indices, as settle_scenes() (heap.hpp) does; scenes in the
/// order of the indices.
///
/// While parts come in, the walls of a box reach above the rim far enough to hold what enters; when all are in and
/// slow, they are cut back to the rim if the heap stands above it or a motion follows. A part whose centre of mass is
/// then beside the inner floor area (at any height), below the floor, or not finite, has escaped: it is taken out of
/// the world and keeps its last finite pose. A part that lies above the rim but within the floor area has not. With a
/// mesh bin the bounds of the mesh stand for the inner box, with an endless floor only falling through it counts, with
/// no bin only NaN. A part that finds no room below the rim while everything else has come to rest is not poured: it
/// keeps its id, and its pose is Pose::none().
///
/// Ends when every part that is in has stayed within Pour::rest_move and rest_turn for Pour::rest_window (RestWatch),
/// or at Pour::limit with parts in state `moving`; with Request::seconds exactly then, rest or not.
std::vector<Scene> pour(const LoadedRequest& loaded, Solver& solver, const std::vector<std::size_t>& indices,
                        const RunHooks& hooks = {});

/// Hash over the bits of the poses of all parts.
std::uint64_t state_hash(const std::vector<ScenePart>& parts);

}  // namespace bin_scenes
