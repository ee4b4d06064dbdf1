/// The list of invariants, and the checks of files and index. Scenes and shards have files of their own
/// (verify_scene.cpp, verify_shards.cpp), BOP's files bop/verify.cpp.
#include "dataset/verify.hpp"

#include "bin_scenes/core/sha256.hpp"
#include "bop/verify.hpp"
#include "core/in_parallel.hpp"
#include "core/read_file.hpp"
#include "dataset/scene_index.hpp"
#include "dataset/whole_folders.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr std::pair<const char*, const char*> known_invariants[] = {
    {"plan_unchanged", "plan.yaml has the digest that dataset.json states"},
    {"no_leftovers", "no file or folder is half-written"},
    {"heap_known", "the index knows what became of every heap, or of every one of the shares made here"},
    {"scene_there", "every scene of the index has its folder"},
    {"scene_known", "every folder of a scene is in the index"},
    {"index_digest", "the digest of files.json is that of the index"},
    {"rejected_kept", "every rejected attempt has its folder, with reasons"},
    {"scenes_differ", "no two scenes have the same poses"},
    {"manifest", "each folder lists its files in files.json"},
    {"file_there", "every listed file is there"},
    {"file_size", "every file has its size"},
    {"file_digest", "every file has its SHA-256"},
    {"file_listed", "no file is there that is not listed"},
    {"scene_json", "scene.json is JSON of its format, with the keys that it needs"},
    {"scene_number", "scene.json has the number of its folder"},
    {"request_there", "the request of a scene lies beside it"},
    {"scene_accepted", "a scene was accepted, and nothing speaks against it"},
    {"part_ids", "ids of parts count from 0, each once"},
    {"part_turn", "orientations are unit quaternions"},
    {"part_place", "parts lie in the bin, up to their size"},
    {"fraction_range", "visible fractions are 0 to 1"},
    {"truth_counts", "visible pixels are no more than all pixels, and their ratio is the fraction"},
    {"truth_boxes", "boxes lie in the image, and are -1 where nothing is seen"},
    {"image_size", "images have the size of their sensor"},
    {"label_measured", "what was measured carries its true label, and nothing else a label"},
    {"label_range", "labels are those of parts"},
    {"label_counts", "as many pixels carry a label as the truth has"},
    {"label_boxes", "pixels of a label fill their box"},
    {"depth_range", "depths lie between near and far"},
    {"validity_codes", "validity is a code, and says where there is depth"},
    {"bop_json", "BOP's three JSON files are there and speak of the same images"},
    {"bop_parts", "BOP lists the parts of the scene, each once"},
    {"bop_rotation", "rotations are orthonormal and right-handed"},
    {"bop_pose", "BOP's poses are those of scene.json in the camera"},
    {"bop_camera", "scene_camera has the intrinsics, the pose and the depth scale of the sensor"},
    {"bop_object", "objects have a model"},
    {"bop_image", "images of every modality are there, with the size of the sensor"},
    {"bop_coco", "scene_gt_coco annotates every visible part, with its object and its mask"},
    {"bop_root", "cameras, targets and description beside the scenes are those that the scenes imply"},
    {"bop_pinhole", "sensors that BOP shows have no distortion, which its files cannot express"},
    {"bop_disjoint", "no pixel shows two parts, unless measured depth decides what is visible"},
    {"bop_labels", "visible masks are where the true labels have their part, with output png"},
    {"bop_mask_there", "each part has its masks, with the size of the image"},
    {"bop_mask_count", "masks have as many pixels as scene_gt_info states"},
    {"bop_mask_box", "masks fill the boxes that scene_gt_info states"},
    {"bop_mask_inside", "what is visible lies in the whole silhouette"},
    {"bop_fraction", "visible fraction is the ratio of the counts"},
    {"bop_unseen", "boxes are -1 exactly where nothing is seen"},
    {"bop_reprojection", "the model, projected with its pose, fills its box"},
    {"model_info", "models_info states box, diameter and symmetries of the model file"},
    {"model_eval", "models_eval holds every model, as large as it is"},
    {"shard_tar", "shards are whole tar files"},
    {"shard_keys", "each image is in one shard, that which key_to_shard names"},
    {"shard_complete", "each image of a scene is in a shard with all its files"},
    {"shard_offsets", "offset indices state where the files lie"},
    {"shard_size", "a shard has no more images than the plan says"},
    {"shard_images", "depth, true labels and true normals of a shard unpack to one size"},
    {"shard_labels", "visible masks of a shard are where its true labels have their part"},
    {"shard_masks", "run lengths add up to the image, and to the counts stated"}};

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code not_there;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, not_there)) all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

/// Two scenes with the same poses are one scene twice: drawn with one seed, or copied. Empty bins are all alike.
void verify_differences(const DataFolder& folder, Findings& findings) {
  std::map<std::uint64_t, std::string> first;
  for (const fs::path& path : entries(folder.root / "scenes")) {
    const auto scene = scene_in(path);
    if (!scene || scene->report.state_hash == 0 || is_empty(*scene)) continue;
    const auto [known, is_new] = first.emplace(scene->report.state_hash, path.filename().string());
    findings.expect(is_new, "scenes_differ", path.string(), "has the poses of " + known->second);
  }
}

}  // namespace

const std::vector<std::pair<const char*, const char*>>& invariants() {
  static const std::vector<std::pair<const char*, const char*>> all(std::begin(known_invariants),
                                                                    std::end(known_invariants));
  return all;
}

void verify_files(const fs::path& folder, Findings& findings) {
  std::ifstream file(folder / "files.json");
  const nlohmann::json list = nlohmann::json::parse(file, nullptr, false);
  const bool good = list.is_object() && list.contains("files") && list["files"].is_object();
  if (!findings.expect(good, "manifest", folder.string(), "files.json is missing or damaged")) return;
  std::set<std::string> listed = {"files.json", "view.html"};  // the page of `view`, which anybody may make
  for (const auto& [name, entry] : list["files"].items()) {
    const fs::path path = folder / name;
    listed.insert(name);
    if (!findings.expect(fs::is_regular_file(path), "file_there", path.string(), "is missing")) continue;
    const bool size = entry.is_object() && entry.value("bytes", std::uintmax_t{0}) == fs::file_size(path);
    if (findings.expect(size, "file_size", path.string(), "has another size than files.json states"))
      findings.expect(entry.value("sha256", "") == sha256_of_file(path.string()), "file_digest", path.string(),
                      "has changed since it was written");
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      findings.expect(listed.count(entry.path().lexically_relative(folder).string()) == 1, "file_listed",
                      entry.path().string(), "is in no list");
  }
}

void verify_index(const DataFolder& folder, const DataSetFacts& facts, Findings& findings) {
  const SceneIndex index(folder.index(), true);
  const std::set<std::size_t> heaps = index.heaps();
  const auto shares = index.shares();
  const auto belongs_here = [&](std::size_t heap) {
    return std::any_of(shares.begin(), shares.end(),
                       [&](const auto& share) { return heap % share.second == share.first; });
  };
  for (std::size_t heap = 0; heap < facts.heaps; ++heap)
    if (belongs_here(heap))
      findings.expect(heaps.count(heap) == 1, "heap_known", folder.index().string(),
                      "nothing is known of heap " + std::to_string(heap));
  std::set<std::string> known;
  index.each_scene([&](const SceneIndex::Row& row) {
    const fs::path path = folder.root / row.path;
    known.insert(path.filename().string());
    if (findings.expect(fs::is_regular_file(path / "files.json"), "scene_there", path.string(), "is missing"))
      findings.expect(sha256_of_file((path / "files.json").string()) == row.sha256, "index_digest", path.string(),
                      "files.json has changed since it was written");
  });
  for (const fs::path& path : entries(folder.root / "scenes")) {
    if (path.filename().string()[0] != '.')
      findings.expect(known.count(path.filename().string()) == 1, "scene_known", path.string(), "is not in the index");
  }
  for (const SceneIndex::Rejected& rejected : index.rejected()) {
    const fs::path path = folder.root / rejected.path;
    std::error_code gone;
    if (findings.expect(fs::file_size(path / "reasons.txt", gone) > 0 && !gone, "rejected_kept", path.string(),
                        "is missing, or has no reasons"))
      verify_files(path, findings);
  }
}

void verify_dataset(const DataFolder& folder, Findings& findings) {
  const DataSetFacts facts = read_facts(folder.root);
  const auto plan = fs::exists(folder.root / "plan.yaml") ? read_file((folder.root / "plan.yaml").string()) : "";
  findings.expect(sha256_hex(plan) == facts.plan_text_sha256, "plan_unchanged", (folder.root / "plan.yaml").string(),
                  "is not the plan that the data set was made from");
  for (const fs::path& below : folders_of(folder)) {
    for (const fs::path& path : entries(below))
      findings.expect(path.filename().string().find(".tmp-") == std::string::npos, "no_leftovers", path.string(),
                      "was left half-written");
  }
  verify_index(folder, facts, findings);
  verify_differences(folder, findings);
  const BopFolder bop = bop_folder(folder, facts);
  std::map<int, BopModel> models;
  if (facts.wants("bop") || facts.wants("shards")) {
    models = verify_models(bop, findings);
    for (const fs::path& path : {bop.models(), bop.models_eval()}) verify_files(path, findings);
  }
  if (facts.wants("bop")) verify_bop_root(bop, findings);
  // Only the whole data set is packed into shards: a share has its samples instead.
  const bool is_whole = SceneIndex(folder.index(), true).shares().count({0, 1}) == 1;
  std::vector<std::size_t> there;
  for (std::size_t scene = 0; scene < facts.scenes(); ++scene)
    if (fs::exists(folder.scene(scene))) there.push_back(scene);
  in_parallel(there.size(), [&](std::size_t i) {
    verify_files(folder.scene(there[i]), findings);
    verify_scene(folder, facts, there[i], findings);
    if (facts.wants("shards") && !is_whole) verify_files(folder.samples(there[i]), findings);
    if (!facts.wants("bop")) return;
    const fs::path own = folder.scene(there[i]), path = folder.bop(facts, there[i]);
    if (!findings.expect(fs::exists(path), "bop_json", path.string(), "is missing")) return;
    verify_files(path, findings);
    if (const auto scene = scene_in(own))
      verify_bop(bop, {path, own, facts.split_of_scene(there[i]), *scene, facts.wants("png")}, models, findings);
  });
  if (facts.wants("shards") && is_whole) verify_shards(folder, facts, findings);
}

}  // namespace bin_scenes
