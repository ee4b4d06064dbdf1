#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "output/bop_image.hpp"
#include "output/jpeg.hpp"
#include "output/tiff.hpp"

#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw environment_error("cannot be made: " + error.message(), path.string(), "check permissions");
}

/// Of a grey image three equal channels.
std::vector<std::uint8_t> rgb_of(const BopImage& image) {
  if (image.seen->picture.channels == 3) return in_bytes(image.seen->picture);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * image.gray.size());
  for (const std::uint8_t value : image.gray) rgb.insert(rgb.end(), 3, value);
  return rgb;
}

Bytes encoded(const BopImage& image, const BopPlace::File& file) {
  const bool tiff = file.extension.rfind(".tif", 0) == 0;
  const int width = image.width, height = image.height;
  if (file.modality == "depth") return tiff ? tiff16(width, height, image.counts) : png16(width, height, image.counts);
  if (file.extension == ".jpg") return rgb_jpeg(width, height, rgb_of(image));
  const int channels = file.modality == "rgb" ? 3 : 1;
  const std::vector<std::uint8_t> samples = channels == 3 ? rgb_of(image) : image.gray;
  return tiff ? tiff8(width, height, channels, samples) : png8(width, height, channels, samples);
}

/// Masks have the number of their entry in scene_gt. The classic layout stores them under the part's id, too, where
/// parts that were not poured make it another one.
void write_masks(const fs::path& root, const BopImage& image, const BopPlace& place, bool by_id) {
  const fs::path visible = root / ("mask_visib" + place.suffix), whole = root / ("mask" + place.suffix);
  BIN_SCENES_ASSERT(image.truth.size() == image.ids.size() && image.visible.size() == image.ids.size());
  const bool whole_known = image.whole.size() == image.ids.size();
  make_directory(visible);
  if (whole_known) make_directory(whole);
  for (std::size_t i = 0; i < image.ids.size(); ++i) {
    std::set<std::size_t> numbers = {i};
    if (by_id) numbers.insert(static_cast<std::size_t>(image.ids[i]));
    for (const std::size_t number : numbers) {
      const std::string name = six_digits(place.image) + "_" + six_digits(number) + ".png";
      write_bytes((visible / name).string(), mask_png(image.width, image.height, image.visible[i]));
      if (whole_known) write_bytes((whole / name).string(), mask_png(image.width, image.height, image.whole[i]));
    }
  }
}

/// What the JSON files of one sensor contain.
struct SensorFiles {
  Json camera = Json::object(), truth = Json::object(), info = Json::object();
  Json visible = Json::object(), whole = Json::object();  ///< run lengths of masks by image
  std::vector<const BopImage*> images;
  std::vector<BopPlace> places;
};

}  // namespace

std::string six_digits(std::size_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "%06zu", number);
  return text;
}

void write_bop(const std::string& directory, const std::vector<BopImage>& images, const BopLayout& layout,
               const std::string& split, std::size_t objects, bool run_lengths) {
  const fs::path root(directory);
  const bool classic = layout.kind == BopLayout::Kind::classic;
  std::vector<Sensor> sensors;
  for (const BopImage& image : images) sensors.push_back(image.seen->sensor);
  const std::vector<BopPlace> places = bop_places(layout, sensors, split);
  std::map<std::string, SensorFiles> files;  // by suffix
  if (classic) files[""];                    // a scene without images has its files, too
  for (std::size_t n = 0; n < images.size(); ++n) {
    const BopImage& image = images[n];
    const BopPlace& place = places[n];
    SensorFiles& of_sensor = files[place.suffix];
    const std::string key = std::to_string(place.image);
    of_sensor.camera[key] = image.camera;
    of_sensor.truth[key] = image.truth;
    of_sensor.info[key] = image.info;
    of_sensor.images.push_back(&image);
    of_sensor.places.push_back(place);
    for (const BopPlace::File& file : place.files) {
      make_directory(root / file.folder);
      write_bytes((root / file.folder / (six_digits(place.image) + file.extension)).string(), encoded(image, file));
    }
    if (run_lengths) {
      of_sensor.visible[key] = run_lengths_of(image.visible, image.width, image.height);
      if (image.whole.size() == image.ids.size())
        of_sensor.whole[key] = run_lengths_of(image.whole, image.width, image.height);
    } else {
      write_masks(root, image, place, classic);
    }
  }
  for (const auto& [suffix, of_sensor] : files) {
    write_text((root / ("scene_camera" + suffix + ".json")).string(), of_sensor.camera.dump(1) + "\n");
    write_text((root / ("scene_gt" + suffix + ".json")).string(), of_sensor.truth.dump(1) + "\n");
    write_text((root / ("scene_gt_info" + suffix + ".json")).string(), of_sensor.info.dump(1) + "\n");
    if (run_lengths) {
      write_text((root / ("scene_mask_visib" + suffix + ".json")).string(), of_sensor.visible.dump() + "\n");
      write_text((root / ("scene_mask" + suffix + ".json")).string(), of_sensor.whole.dump() + "\n");
    }
    if (!classic || run_lengths)
      write_text((root / ("scene_gt_coco" + suffix + ".json")).string(),
                 bop_coco(of_sensor.images, of_sensor.places, objects).dump() + "\n");
  }
}

void write_bop(const std::string& directory, const Scene& scene, const std::vector<PartModelPtr>& parts,
               const std::vector<RangeImage>& images) {
  write_bop(directory, bop_images(scene, parts, images, {}));
}

}  // namespace bin_scenes
