/// The node as a nodelet: subscribers in the same manager get images and clouds without a copy.
#include "bin_scenes/core/error.hpp"
#include "master_watch.hpp"
#include "scene_server.hpp"

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

namespace bin_scenes {

class SceneNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      const ros::NodeHandle& params = getPrivateNodeHandle();
      if (params.hasParam("bins"))
        throw input_error("a nodelet has one bin", "parameter " + params.resolveName("bins"),
                          "load a nodelet for each bin, in a namespace and with a frame_prefix of its own");
      watch_ = std::make_unique<MasterWatch>();
      server_ = std::make_unique<SceneServer>(getNodeHandle(), params, SceneServer::Host::nodelet);
    } catch (const Error& error) {
      NODELET_FATAL("%s", error.what());
      throw;  // the manager then answers that the nodelet was not loaded
    }
  }

  std::unique_ptr<MasterWatch> watch_;
  std::unique_ptr<SceneServer> server_;
};

}  // namespace bin_scenes

PLUGINLIB_EXPORT_CLASS(bin_scenes::SceneNodelet, nodelet::Nodelet)
