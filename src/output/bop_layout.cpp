#include "bin_scenes/output/bop_layout.hpp"

#include "bin_scenes/sensor/image_settings.hpp"

#include <algorithm>

namespace bin_scenes {

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

}  // namespace bin_scenes
