#include "bop/writer.hpp"

#include <algorithm>

namespace bin_scenes {

using Json = nlohmann::ordered_json;

namespace {

/// x, y, width, height of the pixels that are set.
std::array<int, 4> box_of(const MaskBox& mask) {
  PixelBox box;
  std::size_t i = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (mask.inside[i++]) box.extend(mask.left + x, mask.top + y);
  return box.xywh();
}

Json annotation(const BopImage& image, std::size_t entry, std::size_t image_id) {
  const std::size_t area = image.info[entry].at("px_count_visib");
  return {{"image_id", image_id},
          {"category_id", image.truth[entry].at("obj_id")},
          {"iscrowd", 0},
          {"area", area},
          {"bbox", box_of(image.whole_known() ? image.whole[entry] : image.visible[entry])},
          {"segmentation",
           {{"counts", run_lengths(image.visible[entry], image.width, image.height)},
            {"size", {image.height, image.width}}}},
          {"width", image.width},
          {"height", image.height},
          {"ignore", image.info[entry].at("visib_fract").get<double>() < bop_least_visible}};
}

}  // namespace

Json bop_coco(const std::vector<const BopImage*>& images, const std::vector<BopPlace>& places, std::size_t objects) {
  Json coco = {{"info", {{"description", "simulated bins"}, {"contributor", "bin_scenes"}}},
               {"licenses", Json::array()},
               {"categories", Json::array()},
               {"images", Json::array()},
               {"annotations", Json::array()}};
  for (std::size_t id = 1; id <= objects; ++id)
    coco["categories"].push_back({{"id", id}, {"name", std::to_string(id)}, {"supercategory", "bin_scenes"}});
  std::size_t number = 1;
  for (std::size_t n = 0; n < images.size(); ++n) {
    const BopImage& image = *images[n];
    const auto picture = std::find_if(places[n].files.begin(), places[n].files.end(),
                                      [](const BopPlace::File& file) { return file.modality != "depth"; });
    const BopPlace::File& file = picture == places[n].files.end() ? places[n].files.front() : *picture;
    coco["images"].push_back({{"id", places[n].image},
                              {"file_name", places[n].path_of(file)},
                              {"width", image.width},
                              {"height", image.height}});
    for (std::size_t i = 0; i < image.ids.size(); ++i) {
      if (image.info[i].at("px_count_visib") == 0) continue;
      Json entry = {{"id", number++}};
      entry.update(annotation(image, i, places[n].image));
      coco["annotations"].push_back(entry);
    }
  }
  return coco;
}

}  // namespace bin_scenes
