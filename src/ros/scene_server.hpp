/// All that serves one bin: node and nodelet own one, or several in namespaces of their own.
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
  /// In a nodelet, subscribers of the same process get clouds and images without a copy; for that the topics keep their
  /// last message themselves instead of being latched by roscpp, which would write each message out at once.
  enum class Host { node, nodelet };

  /// `node` resolves the names of topics and services, `params` those of parameters. `frame_prefix`: of its TF frames,
  /// where several bins share a tree. Throws an input Error for a wrong parameter. Needs nobody to spin.
  SceneServer(const ros::NodeHandle& node, const ros::NodeHandle& params, Host host = Host::node,
              const std::string& frame_prefix = "");
  /// Cancels what is being made.
  ~SceneServer();

 private:
  struct Parts;
  const std::unique_ptr<Parts> parts_;
};

}  // namespace bin_scenes
