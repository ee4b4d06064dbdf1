/// Packs samples of finished heaps into tar files in the order of scenes, while later ones are made. A shard is written
/// once it is full; the last one is unpacked again when a set grows.
#include "dataset/shards.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"
#include "dataset/whole_folders.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace bin_scenes {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

namespace {

/// Files of a scene's samples in order of name; none if the scene is not there.
std::vector<std::pair<std::string, fs::path>> samples_of(const DataFolder& folder, std::size_t scene) {
  std::vector<std::pair<std::string, fs::path>> files;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.samples(scene), not_there)) {
    const std::string name = entry.path().filename().string();
    if (name != "files.json") files.emplace_back(name, entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string offsets_path(const DataFolder& folder, std::size_t shard) {
  return fs::path(folder.shard(shard)).replace_extension(".json").string();
}

void pack_one(const DataFolder& folder, const DataSetFacts& facts, std::size_t shard) {
  std::vector<std::pair<std::string, fs::path>> files;
  const std::size_t first = shard * scenes_per_shard(facts);
  const std::size_t end = std::min(first + scenes_per_shard(facts), facts.scenes());
  for (std::size_t scene = first; scene < end; ++scene) {
    const auto some = samples_of(folder, scene);
    if (some.empty() && fs::exists(folder.scene(scene) / "scene.json"))
      throw input_error("the samples of scene " + std::to_string(scene) + " are gone", folder.samples(scene).string(),
                        "remove " + folder.scene(scene).string() + ", and the scene is made anew");
    files.insert(files.end(), some.begin(), some.end());
  }
  BIN_SCENES_ASSERT(first < end && shard_of(facts, first) == shard);
  Temporary tar(folder.shard(shard).string());
  const auto places = write_tar(tar.path(), files);
  BIN_SCENES_ASSERT(places.size() == files.size() && ascends(places));
  OrderedJson offsets = OrderedJson::object();
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::size_t dot = files[i].first.find('.');
    offsets[files[i].first.substr(0, dot)][files[i].first.substr(dot + 1)] = {places[i].first, places[i].second};
  }
  // The tar comes last: where it is, its offsets are.
  write_text(offsets_path(folder, shard), offsets.dump() + "\n");
  tar.commit();
}

}  // namespace

std::size_t scenes_per_shard(const DataSetFacts& facts) {
  return std::max<std::size_t>(1, facts.shard_size / std::max<std::size_t>(1, facts.sensors));
}
std::size_t shard_of(const DataSetFacts& facts, std::size_t scene) {
  return scene / scenes_per_shard(facts);
}
std::size_t shard_count(const DataSetFacts& facts) {
  return (facts.scenes() + scenes_per_shard(facts) - 1) / scenes_per_shard(facts);
}

nlohmann::ordered_json offsets_of(const DataFolder& folder, std::size_t shard) {
  const std::string path = offsets_path(folder, shard);
  const OrderedJson offsets = fs::exists(path) ? OrderedJson::parse(read_file(path), nullptr, false) : OrderedJson();
  if (!offsets.is_object())
    throw input_error("is missing or damaged", path,
                      "remove " + folder.shard(shard).string() + ", and a run makes its scenes again");
  return offsets;
}

std::vector<std::pair<std::size_t, std::size_t>> write_tar(const std::string& path,
                                                           const std::vector<std::pair<std::string, fs::path>>& files) {
  const std::unique_ptr<archive, int (*)(archive*)> out(archive_write_new(), archive_write_free);
  const auto check = [&](int status) {
    if (status == ARCHIVE_OK) return;
    throw environment_error(std::string("cannot be written: ") + archive_error_string(out.get()), path,
                            "check permissions and free space");
  };
  check(archive_write_set_format_ustar(out.get()));
  check(archive_write_set_bytes_per_block(out.get(), 10240));
  check(archive_write_open_filename(out.get(), path.c_str()));
  std::vector<std::pair<std::size_t, std::size_t>> places;
  constexpr std::size_t block = 512;
  std::size_t at = 0;
  const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(), archive_entry_free);
  for (const auto& [name, file] : files) {
    stop_if_cancelled();
    const std::string bytes = read_file(file.string());
    archive_entry_clear(entry.get());
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);  // no owner and no time: they would differ between machines
    archive_entry_set_mtime(entry.get(), 0, 0);
    check(archive_write_header(out.get(), entry.get()));
    if (archive_write_data(out.get(), bytes.data(), bytes.size()) != static_cast<la_ssize_t>(bytes.size()))
      check(ARCHIVE_FATAL);
    places.emplace_back(at + block, bytes.size());
    at += block + (bytes.size() + block - 1) / block * block;
  }
  check(archive_write_close(out.get()));
  return places;
}

std::optional<ShardImages> read_tar(const std::string& path, bool& doubled) {
  const std::unique_ptr<archive, int (*)(archive*)> in(archive_read_new(), archive_read_free);
  archive_read_support_format_tar(in.get());
  if (archive_read_open_filename(in.get(), path.c_str(), 1 << 16) != ARCHIVE_OK) return std::nullopt;
  ShardImages images;
  archive_entry* entry = nullptr;
  int status;
  while ((status = archive_read_next_header(in.get(), &entry)) == ARCHIVE_OK) {
    const std::string name = archive_entry_pathname(entry);
    std::string bytes(static_cast<std::size_t>(archive_entry_size(entry)), '\0');
    if (archive_read_data(in.get(), bytes.data(), bytes.size()) != static_cast<la_ssize_t>(bytes.size()))
      return std::nullopt;
    const std::size_t dot = name.find('.');
    doubled |= !images[name.substr(0, dot)].emplace(name.substr(dot + 1), std::move(bytes)).second;
  }
  return status == ARCHIVE_EOF ? std::optional<ShardImages>(std::move(images)) : std::nullopt;
}

ShardPacker::ShardPacker(const DataFolder& folder, const DataSetFacts& facts, std::set<std::size_t> done)
    : folder_(folder), facts_(facts), done_(std::move(done)) {
  make_directory(folder_.shards());
  // All of them: workers finish heaps in any order, so that a shard may be there and an earlier one not yet.
  for (std::size_t shard = 0; shard < shard_count(facts_); ++shard)
    if (fs::exists(folder_.shard(shard))) note(shard);
  if (!shard_of_key_.empty()) write_map();
}

void ShardPacker::add(std::size_t heap) {
  done_.insert(heap);
  const std::size_t first = heap * (facts_.steps + 1);
  for (std::size_t shard = shard_of(facts_, first); shard <= shard_of(facts_, first + facts_.steps); ++shard)
    if (all_done(shard) && !fs::exists(folder_.shard(shard))) pack(shard);
}

void ShardPacker::pack_all() {
  for (std::size_t shard = 0; shard < shard_count(facts_); ++shard)
    if (!fs::exists(folder_.shard(shard))) pack(shard);
  write_map();  // also where there is nothing to pack
  std::error_code ignored;
  fs::remove_all(folder_.root / "samples", ignored);
}

bool ShardPacker::all_done(std::size_t shard) const {
  const std::size_t first = shard * scenes_per_shard(facts_);
  const std::size_t last = std::min(first + scenes_per_shard(facts_), facts_.scenes()) - 1;
  for (std::size_t heap = first / (facts_.steps + 1); heap <= last / (facts_.steps + 1); ++heap)
    if (!done_.count(heap)) return false;
  return true;
}

void ShardPacker::pack(std::size_t shard) {
  stop_if_cancelled();
  pack_one(folder_, facts_, shard);
  note(shard);
  write_map();
  const std::size_t first = shard * scenes_per_shard(facts_);
  std::error_code ignored;
  for (std::size_t scene = first; scene < first + scenes_per_shard(facts_); ++scene)
    fs::remove_all(folder_.samples(scene), ignored);
}

void ShardPacker::note(std::size_t shard) {
  const OrderedJson offsets = offsets_of(folder_, shard);
  for (const auto& [key, files] : offsets.items()) shard_of_key_[key] = shard;
}

void ShardPacker::write_map() const {
  write_text((folder_.shards() / "key_to_shard.json").string(), shard_of_key_.dump() + "\n");
}

void unpack_last_shard(const DataFolder& folder, const DataSetFacts& facts) {
  const std::size_t last = shard_count(facts) - 1;
  const std::string path = folder.shard(last).string();
  if (facts.scenes() % scenes_per_shard(facts) == 0 || !fs::exists(path)) return;
  bool doubled = false;
  const std::optional<ShardImages> images = read_tar(path, doubled);
  if (!images) throw input_error("is cut off or no tar", path, "remove it with its scenes, and these are made anew");
  std::map<std::size_t, std::vector<std::string>> keys_of;
  for (const auto& [key, files] : *images) keys_of[std::stoul(key)].push_back(key);
  for (const auto& [scene, keys] : keys_of) {
    WholeFolders folders;
    folders.write(folder.samples(scene), [&, &keys = keys](const std::string& hidden) {
      for (const std::string& key : keys)
        for (const auto& [name, bytes] : images->at(key)) write_text(hidden + "/" + key + "." + name, bytes);
    });
    folders.commit();
  }
  fs::remove(path);
  fs::remove(offsets_path(folder, last));
}

}  // namespace bin_scenes
