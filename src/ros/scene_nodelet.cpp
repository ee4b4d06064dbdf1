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
      watch_ = std::make_unique<MasterWatch>();
      server_ = std::make_unique<SceneServer>(getNodeHandle(), getPrivateNodeHandle(), SceneServer::Host::nodelet);
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
