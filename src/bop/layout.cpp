#include "bop/layout.hpp"

#include "bin_scenes/sensor/image_settings.hpp"
#include "core/formatted.hpp"

#include <algorithm>
#include <map>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

bool has_colours(const Sensor& sensor) {
  return sensor.model == "image" && sensor.settings.of<ImageSettings>().colour;
}

std::vector<BopPlace::File> classic_files(const std::string& split, const Sensor& sensor) {
  std::vector<BopPlace::File> files = {{"depth", "depth", ".png"}, {"gray", "gray", ".tiff"}};
  // bop_toolkit's dataset_params.py: colour images of this split are JPEG, and there are no grey ones.
  if (split == "train_pbr")
    files.push_back({"rgb", "rgb", ".jpg"});
  else if (has_colours(sensor))
    files.push_back({"rgb", "rgb", ".png"});
  return files;
}

}  // namespace

std::string six_digits(std::size_t number) {
  return formatted("%06zu", number);
}

std::string BopPlace::path_of(const File& file) const {
  return file.folder + "/" + six_digits(image) + file.extension;
}

std::vector<BopPlace> bop_places(const BopLayout& layout, const std::vector<Sensor>& sensors,
                                 const std::string& split) {
  std::vector<BopPlace> places;
  std::map<std::string, std::size_t> views;
  for (const Sensor& sensor : sensors) {
    BopPlace place;
    place.sensor = sensor_of_view(sensor);
    if (layout.kind == BopLayout::Kind::classic) {
      place.image = places.size();
      place.files = classic_files(split, sensor);
    } else {
      place.suffix = "_" + place.sensor;
      place.image = views[place.sensor]++;
      const auto known = std::find_if(layout.modalities.begin(), layout.modalities.end(),
                                      [&](const auto& item) { return item.first == place.sensor; });
      if (known != layout.modalities.end())
        for (const std::string& modality : known->second)
          place.files.push_back({modality, modality + place.suffix, layout.tif ? ".tif" : ".png"});
    }
    places.push_back(std::move(place));
  }
  return places;
}

std::string bop_picture(const BopLayout& layout) {
  if (layout.kind == BopLayout::Kind::classic) return "gray/000000.tiff";
  return layout.modality + "_" + layout.sensor + "/000000" + (layout.tif ? ".tif" : ".png");
}

std::string bop_suffix(const BopLayout& layout) {
  return layout.kind == BopLayout::Kind::classic ? "" : "_" + layout.sensor;
}

fs::path BopFiles::mask(const std::string& kind, std::size_t image, std::size_t entry) const {
  return folder(kind) / (six_digits(image) + "_" + six_digits(entry) + ".png");
}

std::vector<std::string> bop_suffixes_in(const fs::path& folder) {
  std::vector<std::string> suffixes;
  const std::string begin = "scene_gt", end = ".json";
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(begin, 0) != 0 || entry.path().extension() != end) continue;
    const std::string suffix = name.substr(begin.size(), name.size() - begin.size() - end.size());
    if (suffix.rfind("_info", 0) != 0 && suffix.rfind("_coco", 0) != 0) suffixes.push_back(suffix);
  }
  std::sort(suffixes.begin(), suffixes.end());
  return suffixes;
}

fs::path bop_models_info(const fs::path& models) {
  return models / "models_info.json";
}

fs::path bop_model_file(const fs::path& models, std::size_t object) {
  return models / ("obj_" + six_digits(object) + ".ply");
}

}  // namespace bin_scenes
