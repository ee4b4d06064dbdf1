/// The main task of the library: from a request to judged scenes and their images. The command line, the ROS node and
/// the benchmark use this class.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/pour/heap.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace bin_scenes {

/// Keeps between requests what is expensive to make: the GL device, the loaded parts with their collision shapes, and
/// the search trees for rays. It may be used by one thread only (the GL context belongs to the thread that made it).
class Generator {
 public:
  Generator();
  ~Generator();

  struct Result {
    Scene scene;
    std::vector<RangeImage> images;     ///< only if requested
    std::optional<SceneGrasps> grasps;  ///< likewise
  };
  struct Options {
    bool render = true;   ///< false: no sensor image is made
    bool grasps = false;  ///< of the request's grippers; what cameras see of them only with render
    /// Called for each scene before it is handed over, in any thread and for several scenes at the same time, while
    /// further scenes are poured. It is the place for slow work such as writing files. It may move the images away.
    /// What it produces for the receiver of the scene it must store itself, by the index of the scene.
    std::function<void(Result&)> prepare;
    /// Index of the scene that result() returns, for a heap that gives several scenes. The index names the scene and
    /// selects the noise of its sensors.
    std::optional<std::size_t> index;
    RunHooks hooks;
  };

  /// Loads, prepares, pours, judges and renders request.scenes scenes from request.first on, and hands each over as
  /// soon as it is done (in order of index, in the calling thread). Throws Error; scenes handed over before stay valid.
  void generate(const Request& request, const Options& options, const std::function<void(Result&&)>& done);

  /// Scene request.first as a heap that can be changed and settled repeatedly. Its models are loaded and its solver is
  /// made, but nothing is poured yet. The heap may outlive the generator.
  Heap heap(const Request& request, const RunHooks& hooks = {});
  /// Part lines with their models, for Heap::add: checked, also against the heap's bin, and loaded as heap() does.
  /// Throws an input Error.
  std::vector<NewParts> new_parts(const Heap& heap, const std::vector<PartLine>& lines, const RunHooks& hooks = {});
  /// The result of generate() for the current state of a heap: judged, and rendered as its request asks.
  Result result(const Heap& heap, const Options& options);

  /// The most recent request, with its models.
  const LoadedRequest& loaded() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Estimated bytes of a request; throws an input Error with the figure if it exceeds request.memory_budget. Without
/// parts (not loaded yet) only counts and settings of the request are used. Images count for one scene.
double estimate_memory(const LoadedRequest& loaded);
/// How many scenes' images fit into the memory that `estimate` leaves of the budget, the first included.
std::size_t scenes_seen_at_once(const Request& request, double estimate);

}  // namespace bin_scenes
