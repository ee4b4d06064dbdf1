#include "config/rigs.hpp"

#include "bin_scenes/core/error.hpp"
#include "config/preset_files.hpp"

namespace bin_scenes::config {

YAML::Node put_rig(YAML::Node request, const std::function<std::string(const std::string& path)>& where) {
  const YAML::Node none(YAML::NodeType::Undefined);
  const YAML::Node& read_only = request;
  const YAML::Node name = read_only["rig"];
  if (!name) return none;
  const std::string wanted = name.IsScalar() ? name.Scalar() : "";
  const std::string path = preset_path(preset_directory("sensors") + "/rigs", wanted, "rig", where("rig"));
  if (read_only["sensors"])
    throw input_error("'rig' and 'sensors' both give sensors", where("sensors"), "remove one of both");
  const YAML::Node file = YAML::LoadFile(path);
  request["sensors"] = file["sensors"];
  request.remove("rig");
  return file["bop"];
}

}  // namespace bin_scenes::config
