/// The main task of the library: from a request to judged scenes and their images. Generator connects the layers below
/// it: it loads the models, pours, judges, renders, and searches for grasps. The command line, the ROS node, the Python
/// module and the benchmark use it. It writes no files; callers pass its results to output/.
#pragma once

#include "bin_scenes/grasp/scene_grasps.hpp"
#include "bin_scenes/pour/heap.hpp"
#include "bin_scenes/quality/quality.hpp"
#include "bin_scenes/sensor/range_image.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace bin_scenes {

/// Makes scenes, and keeps what is expensive to make between requests: the GL device, the loaded parts with their
/// collision shapes, and the search trees for rays. Only the thread that made a Generator may use it, because the GL
/// context belongs to that thread.
class Generator {
 public:
  Generator();
  ~Generator();

  /// One finished scene.
  struct Result {
    Scene scene;
    std::vector<RangeImage> images;     ///< one for each sensor; empty unless requested
    std::optional<SceneGrasps> grasps;  ///< none unless requested
  };
  /// What is made, and who is informed meanwhile.
  struct Options {
    bool render = true;   ///< false: no sensor image is made
    bool gray = true;     ///< false: sensor images are made without their grey images (gray_image.hpp)
    bool grasps = false;  ///< whether grasps of the request's grippers are searched; what cameras see of them is
                          ///< determined only with `render`
    /// Called for each scene before it is handed over, in any thread and for several scenes at the same time, while
    /// further scenes are poured. It is intended for slow work such as writing files. It may move the images out of the
    /// result. If it produces something for the receiver of the scene, it must store that itself, by the index of the
    /// scene.
    std::function<void(Result&)> prepare;
    /// The index of the scene that result() returns, for a heap from which several scenes are made. The index
    /// identifies the scene and determines the noise of its sensors.
    std::optional<std::size_t> index;
    RunHooks hooks;
  };

  /// Makes request.scenes scenes from index request.first on: loads, prepares, pours, judges and renders. Each scene is
  /// passed to `done` as soon as it is finished, in order of index and in the calling thread. Throws Error; scenes that
  /// were handed over before stay valid.
  void generate(const Request& request, const Options& options, const std::function<void(Result&&)>& done);

  /// Returns scene request.first as a heap that can be changed and settled repeatedly. Its models are loaded and its
  /// solver is made, but nothing is poured yet. The heap may outlive the generator.
  Heap heap(const Request& request, const RunHooks& hooks = {});
  /// Returns part lines with their models for Heap::add(). They are checked, also against the bin of the heap, and
  /// loaded as heap() does it. Throws an input Error.
  std::vector<NewParts> new_parts(const Heap& heap, const std::vector<PartLine>& lines, const RunHooks& hooks = {});
  /// Returns the current state of a heap as generate() would return it: judged, and rendered as its request asks.
  Result result(const Heap& heap, const Options& options);

  /// Returns the most recent request with its models.
  const LoadedRequest& loaded() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the estimated memory of a request (bytes), and throws an input Error with the figure if it exceeds
/// request.memory_budget. Before the models are loaded, only the counts and settings of the request are used. Images
/// count for one scene.
double estimate_memory(const LoadedRequest& loaded);
/// Returns how many scenes, including the first, may have their images in memory at the same time: as many as fit into
/// the part of the budget that `estimate` (bytes) leaves.
std::size_t scenes_seen_at_once(const Request& request, double estimate);

}  // namespace bin_scenes
