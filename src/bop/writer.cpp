#include "bop/writer.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/jpeg.hpp"
#include "output/tiff.hpp"

#include <filesystem>
#include <map>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

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
void write_masks(const BopFiles& files, const BopImage& image, std::size_t number_of_image, bool by_id) {
  BIN_SCENES_ASSERT(image.truth.size() == image.ids.size() && image.visible.size() == image.ids.size());
  const auto write = [&](const std::string& kind, std::size_t number, const MaskBox& mask) {
    write_bytes(files.mask(kind, number_of_image, number).string(), mask_png(image.width, image.height, mask));
  };
  make_directory(files.folder("mask_visib"));
  if (image.whole_known()) make_directory(files.folder("mask"));
  for (std::size_t i = 0; i < image.ids.size(); ++i) {
    std::set<std::size_t> numbers = {i};
    if (by_id) numbers.insert(static_cast<std::size_t>(image.ids[i]));
    for (const std::size_t number : numbers) {
      write("mask_visib", number, image.visible[i]);
      if (image.whole_known()) write("mask", number, image.whole[i]);
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
      write_bytes((root / place.path_of(file)).string(), encoded(image, file));
    }
    if (run_lengths) {
      of_sensor.visible[key] = run_lengths_of(image.visible, image.width, image.height);
      if (image.whole_known()) of_sensor.whole[key] = run_lengths_of(image.whole, image.width, image.height);
    } else {
      write_masks({root, place.suffix}, image, place.image, classic);
    }
  }
  for (const auto& [suffix, of_sensor] : files) {
    const BopFiles path{root, suffix};
    write_text(path.camera().string(), of_sensor.camera.dump(1) + "\n");
    write_text(path.truth().string(), of_sensor.truth.dump(1) + "\n");
    write_text(path.info().string(), of_sensor.info.dump(1) + "\n");
    if (run_lengths) {
      write_text(path.run_lengths("mask_visib").string(), of_sensor.visible.dump() + "\n");
      write_text(path.run_lengths("mask").string(), of_sensor.whole.dump() + "\n");
    }
    if (!classic || run_lengths)
      write_text(path.coco().string(), bop_coco(of_sensor.images, of_sensor.places, objects).dump() + "\n");
  }
}

void write_bop(const std::string& directory, const Scene& scene, const std::vector<PartModelPtr>& parts,
               const std::vector<RangeImage>& images) {
  write_bop(directory, bop_images(scene, parts, images, {}));
}

}  // namespace bin_scenes
