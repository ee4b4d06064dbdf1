/// --trace: states of every part over simulated time. The extension of the file says how they are written: .bag and
/// .mcap as messages of ROS with the contacts (a build with ROS), all others as CSV.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// The scene at one moment.
struct TraceSample {
  double time = 0.0;                   ///< s since the scene began
  std::vector<ScenePart> parts;        ///< all of them, with id, pose (bin frame; not finite = not in the bin yet) and
                                       ///< velocity
  std::vector<SceneContact> contacts;  ///< of the step that ends then; only for a trace that shows_contacts()
};

class Trace {
 public:
  virtual ~Trace() = default;
  /// Whether samples need their contacts, which cost the solver some time to list.
  virtual bool shows_contacts() const { return false; }
  /// Once, before the first sample, as soon as the models are loaded.
  virtual void begin(const LoadedRequest& /*loaded*/) {}
  virtual void add(const TraceSample& sample) = 0;
  /// Completes the file; before this call it does not exist under its name.
  virtual void finish() = 0;
};

/// For the one scene of `request`. `profile`: of the messages in a .mcap file. Throws an environment Error where no
/// file can be written, before anything is simulated.
std::unique_ptr<Trace> open_trace(const std::string& path, const Request& request, McapProfile profile);

using MessageTraceMaker =
    std::function<std::unique_ptr<Trace>(const std::string& path, const Request& request, McapProfile profile)>;
/// Makes .bag and .mcap known; called by the part of the program that knows ROS (ros/bag_format.cpp).
void register_message_trace(MessageTraceMaker maker);

}  // namespace bin_scenes
