/// All threads and objects that serve one bin. A node or nodelet has one such object, or one per namespace.
///
///     thread        owns                              serves
///     control       action, rates, diagnostics        goals, cancels, the service cancel, timers: never blocks
///     calls         -                                 blocking services, one call at a time
///     jobs          generator, solver, heap           goals and calls, one after the other
///     publication   scene shown, topics               new subscribers, publishing again
///     ahead         a generator of its own            scenes for next_scene, if wanted
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>

namespace bin_scenes {

class SceneServer {
 public:
  /// In a nodelet, subscribers of the same process get clouds and images without a copy. For this, topics store their
  /// last message themselves, because roscpp serialises each message of a topic that it latches.
  enum class Host { node, nodelet };

  /// `node` resolves the names of topics and services, `params` those of parameters. `frame_prefix` begins the names of
  /// frames if several bins share a TF tree. Throws an input Error for a wrong parameter. No spinner is needed.
  SceneServer(const ros::NodeHandle& node, const ros::NodeHandle& params, Host host = Host::node,
              const std::string& frame_prefix = "");
  /// Cancels all jobs.
  ~SceneServer();

 private:
  struct Parts;
  const std::unique_ptr<Parts> parts_;
};

}  // namespace bin_scenes
