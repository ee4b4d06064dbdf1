/// Names of all paths of a data set, and dataset.json, which claims the folder before anything else is written. A lock
/// keeps two runs apart.
#include "dataset/data_folder.hpp"

#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/formatted.hpp"
#include "core/read_file.hpp"
#include "dataset/whole_folders.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr const char* format_name = "bin_scenes/dataset/1";

std::string numbered(const char* before, std::size_t number) {
  return formatted("%s%06zu", before, number);
}

nlohmann::ordered_json json_of(const BopLayout& layout) {
  if (layout.kind == BopLayout::Kind::classic) return {{"layout", "classic"}};
  nlohmann::ordered_json json = {{"layout", "industrial"},
                                 {"format", layout.tif ? "tif" : "png"},
                                 {"modalities", nlohmann::ordered_json::object()},
                                 {"evaluate", {{"sensor", layout.sensor}, {"modality", layout.modality}}}};
  for (const auto& [sensor, modalities] : layout.modalities) json["modalities"][sensor] = modalities;
  return json;
}

BopLayout layout_in(const nlohmann::ordered_json& json) {
  BopLayout layout;
  if (json.at("layout") == "classic") return layout;
  layout.kind = BopLayout::Kind::industrial;
  layout.tif = json.at("format") == "tif";
  for (const auto& [sensor, modalities] : json.at("modalities").items())
    layout.modalities.emplace_back(sensor, modalities.get<std::vector<std::string>>());
  layout.sensor = json.at("evaluate").at("sensor");
  layout.modality = json.at("evaluate").at("modality");
  return layout;
}

std::string facts_text(const DataSetFacts& facts) {
  nlohmann::ordered_json json = {{"format", format_name},
                                 {"version", facts.version},
                                 {"plan_sha256", facts.plan_sha256},
                                 {"plan_text_sha256", facts.plan_text_sha256},
                                 {"scenes", facts.scenes()},
                                 {"heaps", facts.heaps},
                                 {"depletion_steps", facts.steps},
                                 {"attempts", facts.attempts},
                                 {"sensors", facts.sensors},
                                 {"outputs", facts.formats},
                                 {"bop_visible", facts.tolerance > 0.0 ? "measured" : "truth"},
                                 {"bop_tolerance_m", facts.tolerance},
                                 {"shard_size", facts.shard_size},
                                 {"split", nlohmann::ordered_json::object()}};
  for (const auto& [name, share] : facts.split) json["split"][name] = share;
  json["bop"] = json_of(facts.bop);
  if (facts.run_lengths) json["bop"]["masks"] = "rle";
  if (facts.most_targets > 0) json["bop"]["most_targets"] = facts.most_targets;
  return json.dump(1) + "\n";
}

bool holds_something(const fs::path& root) {
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(root, not_there))
    if (entry.path().filename().string()[0] != '.') return true;
  return false;
}

}  // namespace

fs::path DataFolder::scene(std::size_t scene) const {
  return root / "scenes" / numbered("scene_", scene);
}
fs::path DataFolder::set_apart(std::size_t scene, std::size_t attempt) const {
  return root / "set_apart" / (numbered("scene_", scene) + "_attempt_" + std::to_string(attempt));
}
fs::path DataFolder::bop(const DataSetFacts& facts, std::size_t scene) const {
  return root / "bop" / facts.split_of_scene(scene) / numbered("", scene);
}
fs::path DataFolder::samples(std::size_t scene) const {
  return root / "samples" / numbered("", scene);
}
fs::path DataFolder::shard(std::size_t shard) const {
  return shards() / (numbered("shard-", shard) + ".tar");
}

BopFolder bop_folder(const DataFolder& folder, const DataSetFacts& facts) {
  BopFolder bop;
  bop.root = folder.root / "bop";
  bop.layout = facts.bop;
  bop.tolerance = facts.tolerance;
  bop.run_lengths = facts.run_lengths;
  bop.most_targets = facts.most_targets;
  bop.version = facts.version;
  for (const auto& [split, share] : facts.split) bop.splits.push_back(split);
  for (const std::string& split : bop.splits) {
    const std::vector<std::size_t> scenes = bop.scenes(split);
    if (scenes.empty()) continue;
    const auto scene = scene_in(folder.scene(scenes.front()));
    if (!scene) continue;
    bop.sensors.assign(scene->sensors.begin(), scene->sensors.end());
    bop.first_split = split;
    break;
  }
  return bop;
}

bool DataSetFacts::wants(const std::string& format) const {
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

std::string DataSetFacts::split_of(std::size_t heap) const {
  // Multiples of the golden ratio fill 0 to 1 evenly, however many there are. python/bin_scenes_data does the same.
  constexpr double golden = 0.6180339887498949;
  const double place = std::fmod(static_cast<double>(heap) * golden, 1.0);
  double sum = 0.0;
  for (const auto& [name, share] : split) {
    sum += share;
    if (place < sum) return name;
  }
  return split.back().first;
}

bool DataSetFacts::operator==(const DataSetFacts& other) const {
  return facts_text(*this) == facts_text(other);
}

DataSetFacts facts_of(const Plan& plan) {
  DataSetFacts facts;
  facts.plan_sha256 = plan.sha256;
  facts.plan_text_sha256 = sha256_hex(plan.text);
  facts.version = BIN_SCENES_VERSION;
  facts.heaps = plan.heaps;
  facts.steps = plan.depletion.steps;
  facts.attempts = plan.attempts;
  facts.sensors = plan.reference.sensors.size();
  facts.formats = plan.formats;
  facts.tolerance = plan.tolerance;
  facts.bop = plan.bop;
  facts.run_lengths = plan.run_lengths;
  facts.most_targets = plan.most_targets;
  facts.shard_size = plan.shard_size;
  facts.split = plan.split;
  if (facts.split.empty()) facts.split = {{"train", 1.0}};
  return facts;
}

DataSetFacts read_facts(const fs::path& root) {
  const fs::path path = root / "dataset.json";
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored))
    throw input_error("is no data set: it has no dataset.json", root.string(),
                      "name the folder that was given as --out");
  const auto json = nlohmann::ordered_json::parse(read_file(path.string()), nullptr, false);
  if (!json.is_object() || json.value("format", nlohmann::ordered_json()) != format_name)
    throw input_error(std::string("is damaged, or not of format ") + format_name, path.string(),
                      "use the version of bin_scenes that made it");
  try {
    DataSetFacts facts{json.at("plan_sha256"),
                       json.at("plan_text_sha256"),
                       json.at("version"),
                       json.at("heaps"),
                       json.at("depletion_steps"),
                       json.at("attempts"),
                       json.at("sensors"),
                       json.at("outputs"),
                       json.at("bop_tolerance_m"),
                       layout_in(json.at("bop")),
                       false,
                       0,
                       json.at("shard_size"),
                       {}};
    facts.run_lengths = json.at("bop").value("masks", "") == "rle";
    facts.most_targets = json.at("bop").value("most_targets", std::size_t{0});
    for (const auto& [name, share] : json.at("split").items()) facts.split.emplace_back(name, share);
    if (!facts.split.empty()) return facts;
  } catch (const nlohmann::json::exception&) {
  }
  throw input_error("lacks a key", path.string(), "use the version of bin_scenes that made it");
}

DataSetFacts claim(const DataFolder& folder, const DataSetFacts& facts, const std::string& plan_text) {
  std::error_code ignored;
  DataSetFacts there = facts;
  if (fs::exists(folder.root / "dataset.json", ignored)) {
    there = read_facts(folder.root);
    if (there.version != facts.version)
      throw input_error("was begun by version " + there.version + ", this is " + facts.version, folder.root.string(),
                        "go on with that version, or name another --out");
    DataSetFacts grown = there;
    grown.heaps = facts.heaps;
    grown.plan_text_sha256 = facts.plan_text_sha256;
    if (!(grown == facts))
      throw input_error("is the data set of another plan (see its plan.yaml)", folder.root.string(),
                        "name another --out, or go on with that plan");
    if (facts.heaps < there.heaps)
      throw input_error("has more heaps than the plan asks for, " + std::to_string(facts.heaps) + " of " +
                            std::to_string(there.heaps),
                        folder.root.string(), "ask for as many or more, or name another --out");
  } else {
    if (holds_something(folder.root))
      throw input_error("holds something that is no data set", folder.root.string(),
                        "name a new or empty folder for --out");
    make_directory(folder.root);
    put_plan(folder, facts, plan_text);
  }
  for (const char* below : {"scenes", "set_apart"}) make_directory(folder.root / below);
  return there;
}

void put_plan(const DataFolder& folder, const DataSetFacts& facts, const std::string& plan_text) {
  write_text((folder.root / "plan.yaml").string(), plan_text);
  write_text((folder.root / "dataset.json").string(), facts_text(facts));
}

FolderLock::FolderLock(const fs::path& root) : descriptor_(::open(root.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // Workers hold it too, and a parent that was killed may be gone before the last of them.
  constexpr int tries = 100;
  constexpr useconds_t pause_us = 50'000;
  for (int i = 0; descriptor_ >= 0 && i < tries; ++i) {
    if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    usleep(pause_us);
  }
  if (descriptor_ >= 0) ::close(descriptor_);
  throw environment_error("another process works there", root.string(), "wait for it, or stop it");
}
FolderLock::~FolderLock() {
  ::close(descriptor_);
}

bool is_worked_in(const fs::path& root) {
  const int folder = ::open(root.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return false;
  const bool locked = flock(folder, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(folder);
  return locked;
}

std::set<std::size_t> heaps_in(const DataFolder& folder, const DataSetFacts& facts) {
  std::set<std::size_t> heaps;
  for (const char* below : {"scenes", "set_apart"}) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.root / below)) {
      std::size_t scene = 0;
      if (std::sscanf(entry.path().filename().c_str(), "scene_%zu", &scene) == 1)
        heaps.insert(scene / (facts.steps + 1));
    }
  }
  return heaps;
}

std::vector<fs::path> folders_of(const DataFolder& folder) {
  std::vector<fs::path> all = {folder.root};
  for (const char* below : {"scenes", "set_apart", "bop", "samples", "shards"}) all.push_back(folder.root / below);
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.root / "bop", not_there))
    if (entry.is_directory()) all.push_back(entry.path());
  return all;
}

void remove_leftovers(const DataFolder& folder) {
  for (const fs::path& path : folders_of(folder)) remove_leftovers(path.string());
}

}  // namespace bin_scenes
