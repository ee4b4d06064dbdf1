/// From request to resting scene: overlap-free seeded start, entry above the growing heap, rest over a window of
/// simulated time. Knows no solver but the interface.
#pragma once

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

/// Hooks a caller may set; all optional.
struct RunHooks {
  std::function<void(const Progress&)> progress;
  const std::atomic<bool>* cancel = nullptr;  ///< polled often; throws Error(cancelled)
  /// Called at `trace_rate` (Hz, simulated time) with the states of every body: the --trace option.
  std::function<void(std::size_t scene, double time, const std::vector<BodyState>&)> trace;
  double trace_rate = 0.0;
};

/// World of one scene of the request (bodies in order of part lines, one id each).
WorldDef world_of(const Request& request, const std::vector<PartModelPtr>& parts);

/// Pours scene `index` of the request for each of the given indices, many worlds at a time, and returns the scenes
/// in that order: poses, states, at_rest, escaped, not_poured, simulated_s, steps, flags and state_hash filled in.
/// Quality and visibility are not (quality/, sensor/).
std::vector<Scene> pour(const Request& request, const std::vector<PartModelPtr>& parts, Solver& solver,
                        const std::vector<std::size_t>& indices, const RunHooks& hooks = {});

}  // namespace bin_scenes
