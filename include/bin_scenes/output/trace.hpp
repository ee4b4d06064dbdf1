/// The option --trace of `generate`: it records the states of all parts over simulated time. The extension of the file
/// determines the format: .bag and .mcap contain ROS messages with markers of the contacts and need a program with ROS,
/// .jsonl contains parts and contacts for the page of `view`, and all other files are CSV. A trace is for looking at;
/// nothing reads it back into a simulation.
#pragma once

#include "bin_scenes/config/formats.hpp"
#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/scene/scene.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// The scene at one moment of simulated time.
struct TraceSample {
  double time = 0.0;  ///< simulated time since the scene began (s)
  /// All parts with id, pose (bin frame; not finite if the part is not in the bin yet) and velocity.
  std::vector<ScenePart> parts;
  /// The contacts of the step that ends at this time; only for a trace that shows_contacts().
  std::vector<SceneContact> contacts;
};

/// A trace that is being written. Calls are in the order begin(), add() for ascending times, finish().
class Trace {
 public:
  virtual ~Trace() = default;
  /// Whether samples must contain their contacts, which the solver needs some time to list.
  virtual bool shows_contacts() const { return false; }
  /// Called once before the first sample, as soon as the models are loaded.
  virtual void begin(const LoadedRequest& /*loaded*/) {}
  virtual void add(const TraceSample& sample) = 0;
  /// Completes the file and gives it its name.
  virtual void finish() = 0;
};

/// Opens a trace for the one scene of `request`. Throws an environment Error if the file cannot be written, before
/// anything is simulated. @param profile  version of the ROS messages in an .mcap file
std::unique_ptr<Trace> open_trace(const std::string& path, const Request& request, McapProfile profile);

using MessageTraceMaker =
    std::function<std::unique_ptr<Trace>(const std::string& path, const Request& request, McapProfile profile)>;
/// Registers the maker of .bag and .mcap traces. The ROS layer calls it (ros/bag_format.cpp).
void register_message_trace(MessageTraceMaker maker);

}  // namespace bin_scenes
