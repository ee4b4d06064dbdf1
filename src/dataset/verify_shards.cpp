/// Reads every shard as a tar file and compares keys, offsets, sizes and masks with what the set states of its images.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/image_channel.hpp"
#include "core/formatted.hpp"
#include "core/read_file.hpp"
#include "dataset/shards.hpp"
#include "dataset/verify.hpp"
#include "output/png_reader.hpp"

#include <fstream>
#include <optional>

namespace bin_scenes {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* files_of_image[] = {"camera.json",  "depth.png", "gray.tiff",      "gt.json",
                                          "gt_info.json", "mask.json", "mask_visib.json"};

bool holds_all(const std::map<std::string, std::string>& files) {
  bool all = true;
  for (const char* file : files_of_image) all &= files.count(file) == 1;
  for (const ImageChannel& channel : image_channels())
    all &= !channel.in_shards || files.count(channel.name + ".png") == 1;
  return all;
}

void verify_run_lengths(const std::string& key, const std::map<std::string, std::string>& files,
                        const std::string& where, Findings& findings) {
  const Json info = Json::parse(files.at("gt_info.json"));
  for (const char* file : {"mask.json", "mask_visib.json"}) {
    if (!files.count(file)) continue;
    const Json masks = Json::parse(files.at(file));
    bool good = masks.size() == info.size();
    for (const auto& [number, mask] : masks.items()) {
      std::size_t sum = 0, inside = 0, i = 0;
      for (const std::size_t run : mask.at("counts")) {
        sum += run;
        if (i++ % 2 == 1) inside += run;
      }
      const Json& entry = info.at(std::stoul(number));
      good &= sum == mask.at("size").at(0).get<std::size_t>() * mask.at("size").at(1).get<std::size_t>();
      good &= std::string(file) == "mask.json" ? inside <= entry.at("px_count_all").get<std::size_t>()
                                               : inside == entry.at("px_count_visib").get<std::size_t>();
    }
    findings.expect(good, "shard_masks", where + ", " + key + "." + file, "run lengths do not add up");
  }
}

/// The visible pixels of a part are those that carry its label.
bool labels_agree(const Json& truth, const Json& masks, const LoadedImage& labels) {
  std::map<std::uint16_t, std::size_t> carried;
  for (const std::uint16_t label : labels.samples) ++carried[label];
  const auto height = static_cast<std::size_t>(labels.height), width = static_cast<std::size_t>(labels.width);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto label = static_cast<std::uint16_t>(truth[i].at("id").get<int>() + 1);
    std::size_t at = 0, inside = 0;
    bool value = false;
    for (const std::size_t run : masks.at(std::to_string(i)).at("counts")) {
      for (const std::size_t end = at + run; at < end; ++at) {  // column by column
        if (!value) continue;
        if (at >= height * width || labels.samples[at % height * width + at / height] != label) return false;
        ++inside;
      }
      value = !value;
    }
    if (inside != carried[label]) return false;
  }
  return true;
}

void verify_shard_images(const std::string& key, const std::map<std::string, std::string>& files, bool by_truth,
                         const std::string& where, Findings& findings) {
  const auto loaded = [&](const std::string& name) {
    return png_from(files.at(name + ".png"), where + ", " + key + "." + name + ".png");
  };
  LoadedImage depth;
  std::map<std::string, LoadedImage> channels;
  std::optional<LoadedImage> picture;
  try {
    depth = loaded("depth");
    for (const ImageChannel& channel : image_channels())
      if (channel.in_shards) channels[channel.name] = loaded(channel.name);
    if (files.count("image.png")) picture = loaded("image");
  } catch (const Error& error) {
    findings.expect(false, "shard_images", error.where(), error.problem());
    return;
  }
  const auto same = [&](const LoadedImage& image) {
    return image.width == depth.width && image.height == depth.height;
  };
  const std::string image = where + ", " + key;
  for (const auto& [name, found] : channels)
    if (!findings.expect(same(found) && found.channels == find_image_channel(name)->samples, "shard_images", image,
                         name + ".png has another size than depth.png"))
      return;
  if (picture)
    findings.expect(same(*picture) && picture->bits == 16, "shard_images", image,
                    "image.png is none of 16 bits of the size of depth.png");
  if (by_truth)
    findings.expect(labels_agree(Json::parse(files.at("gt.json")), Json::parse(files.at("mask_visib.json")),
                                 channels.at("truth_labels")),
                    "shard_labels", image, "mask_visib.json is not where truth_labels.png has the parts");
}

void verify_offsets(const fs::path& tar, const ShardImages& images, Findings& findings) {
  const fs::path path = fs::path(tar).replace_extension(".json");
  const Json offsets = fs::exists(path) ? Json::parse(read_file(path.string()), nullptr, false) : Json();
  bool good = offsets.is_object() && offsets.size() == images.size();
  std::ifstream in(tar, std::ios::binary);
  for (const auto& [key, files] : images) {
    for (const auto& [name, bytes] : files) {
      if (!good || !offsets.contains(key) || !offsets[key].contains(name)) {
        good = false;
        continue;
      }
      std::string there(bytes.size(), '\0');
      in.seekg(static_cast<std::streamoff>(offsets[key][name].at(0).get<std::size_t>()));
      in.read(there.data(), static_cast<std::streamsize>(there.size()));
      good &= static_cast<bool>(in) && there == bytes && offsets[key][name].at(1) == bytes.size();
    }
  }
  findings.expect(good, "shard_offsets", path.string(), "does not state where the files of the shard lie");
}

}  // namespace

void verify_shards(const DataFolder& folder, const DataSetFacts& facts, Findings& findings) {
  const fs::path map_path = folder.shards() / "key_to_shard.json";
  const Json map = fs::exists(map_path) ? Json::parse(read_file(map_path.string()), nullptr, false) : Json();
  findings.expect(map.is_object(), "shard_keys", map_path.string(), "is missing or damaged");
  std::map<std::string, std::size_t> found;
  for (std::size_t shard = 0; shard < shard_count(facts); ++shard) {
    const std::string where = folder.shard(shard).string();
    bool doubled = false;
    const auto images = fs::exists(where) ? read_tar(where, doubled) : std::nullopt;
    if (!findings.expect(images.has_value(), "shard_tar", where, "is missing, cut off or no tar")) continue;
    findings.expect(!doubled, "shard_keys", where, "holds a file twice");
    findings.expect(images->size() <= facts.shard_size, "shard_size", where,
                    "has more than " + std::to_string(facts.shard_size) + " images");
    verify_offsets(where, *images, findings);
    for (const auto& [key, files] : *images) {
      findings.expect(found.emplace(key, shard).second, "shard_keys", where,
                      "holds " + key + ", which another shard holds");
      findings.expect(map.is_object() && map.value(key, Json()) == shard, "shard_keys", where,
                      "holds " + key + ", but key_to_shard.json does not say so");
      if (!findings.expect(holds_all(files), "shard_complete", where + ", " + key, "lacks a file")) continue;
      try {
        verify_run_lengths(key, files, where, findings);
        verify_shard_images(key, files, facts.tolerance == 0.0, where, findings);
      } catch (const std::exception& error) {
        findings.expect(false, "shard_masks", where + ", " + key, error.what());
      }
    }
  }
  for (std::size_t scene = 0; scene < facts.scenes(); ++scene) {
    if (!fs::exists(folder.scene(scene) / "scene.json")) continue;
    for (std::size_t image = 0; image < facts.sensors; ++image) {
      const std::string key = formatted("%06zu_%06zu", scene, image);
      findings.expect(found.count(key) == 1, "shard_complete", folder.shards().string(), key + " is in no shard");
    }
  }
}

}  // namespace bin_scenes
