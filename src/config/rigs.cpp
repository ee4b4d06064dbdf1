#include "config/rigs.hpp"

#include "bin_scenes/config/sensor_presets.hpp"
#include "bin_scenes/core/error.hpp"
#include "config/suggest.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace bin_scenes::config {

namespace fs = std::filesystem;

YAML::Node put_rig(YAML::Node request, const std::function<std::string(const std::string& path)>& where) {
  const YAML::Node none(YAML::NodeType::Undefined);
  const YAML::Node& read_only = request;
  const YAML::Node name = read_only["rig"];
  if (!name) return none;
  const fs::path folder = fs::path(sensor_preset_directory()) / "rigs";
  std::vector<std::string> known;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there))
    if (entry.path().extension() == ".yaml") known.push_back(entry.path().stem().string());
  std::sort(known.begin(), known.end());
  const std::string wanted = name.IsScalar() ? name.Scalar() : "";
  if (std::find(known.begin(), known.end(), wanted) == known.end()) {
    std::string remedy = "there are:";
    for (const std::string& rig : known) remedy += " " + rig;
    const std::string meant = nearest(wanted, known);
    throw input_error("there is no rig '" + wanted + "'", where("rig"),
                      meant.empty() ? remedy : "did you mean '" + meant + "'?");
  }
  if (read_only["sensors"])
    throw input_error("'rig' and 'sensors' both give sensors", where("sensors"), "remove one of both");
  const YAML::Node file = YAML::LoadFile((folder / (wanted + ".yaml")).string());
  request["sensors"] = file["sensors"];
  request.remove("rig");
  return file["bop"];
}

}  // namespace bin_scenes::config
