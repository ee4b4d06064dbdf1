#include "dataset/merge.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "core/read_file.hpp"
#include "dataset/heap_maker.hpp"
#include "dataset/scene_index.hpp"
#include "dataset/shards.hpp"

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code no_link, error;
  fs::create_hard_link(from, to, no_link);
  if (no_link) fs::copy_file(from, to, error);
  if (error)
    throw environment_error("cannot be copied: " + error.message(), from.string(), "check permissions and free space");
}

/// The files of a folder under a hidden name; the name comes with commit().
void take_over(const fs::path& from, const fs::path& to) {
  if (!fs::exists(from) || whole(to, false)) return;
  make_directory(to.parent_path());
  Temporary hidden(to.string());
  make_directory(hidden.path());
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from)) {
    stop_if_cancelled();
    const fs::path target = hidden.path() / entry.path().lexically_relative(from);
    if (entry.is_directory()) {
      make_directory(target);
    } else {
      link_or_copy(entry.path(), target);
    }
  }
  hidden.commit();
}

/// Shards of a share that is the whole set: its samples are nowhere else.
void take_shards(const DataFolder& from, const DataFolder& to, const DataSetFacts& facts) {
  for (std::size_t shard = 0; shard < shard_count(facts); ++shard) {
    if (!fs::exists(from.shard(shard)) || fs::exists(to.shard(shard))) continue;
    offsets_of(from, shard);  // throws if the shard is of no use
    make_directory(to.shards());
    const fs::path tar = from.shard(shard);
    for (const fs::path& file : {fs::path(tar).replace_extension(".json"), tar}) {  // where the tar is, its offsets are
      Temporary hidden((to.shards() / file.filename()).string());
      link_or_copy(file, hidden.path());
      hidden.commit();
    }
  }
}

void take_heap(const DataFolder& from, const DataFolder& to, const DataSetFacts& facts, const HeapRecord& record) {
  for (const RejectedRecord& rejected : record.rejected) take_over(from.root / rejected.path, to.root / rejected.path);
  for (const SceneRecord& scene : record.scenes) {
    if (facts.wants("bop")) take_over(from.bop(facts, scene.scene), to.bop(facts, scene.scene));
    if (facts.wants("shards")) take_over(from.samples(scene.scene), to.samples(scene.scene));
    take_over(from.scene(scene.scene), to.scene(scene.scene));
  }
}

}  // namespace

Merged merge_datasets(const std::vector<std::string>& shares, const std::string& out, const std::atomic<bool>* stop) {
  const CancelScope scope(stop);
  std::vector<DataFolder> folders;
  for (const std::string& share : shares) folders.push_back({share});
  const DataSetFacts facts = read_facts(shares.at(0));
  for (const DataFolder& folder : folders) {
    if (!(read_facts(folder.root) == facts))
      throw input_error("is of another plan or version than " + shares[0], folder.root.string(),
                        "merge shares of one plan, made by one version");
    std::error_code ignored;
    if (fs::equivalent(folder.root, out, ignored))
      throw input_error("is one of the folders to merge", out, "name a new folder for --out");
  }
  const DataFolder to{out};
  check_writable(out);
  claim(to, facts, read_file((folders[0].root / "plan.yaml").string()));
  const FolderLock lock(to.root);
  remove_leftovers(to);
  SceneIndex index(to.index());
  index.add_share(0, 1);
  std::set<std::size_t> known = index.heaps();
  for (const DataFolder& from : folders) {
    const SceneIndex share(from.index(), true);
    for (const std::size_t heap : share.heaps()) {
      stop_if_cancelled();
      const HeapRecord record = share.record(heap);
      // Two shares may both have a heap, after a task was given to two machines: they are the same, byte for byte.
      if (!known.insert(heap).second && found_on_disk(to, facts, heap)) continue;
      take_heap(from, to, facts, record);
      index.put(record);
    }
    take_shards(from, to, facts);
  }
  Merged merged;
  const IndexCounts counts = index.counts();
  merged.scenes = counts.scenes;
  merged.rejected = counts.rejected;
  BIN_SCENES_ASSERT(known.size() <= facts.heaps);
  merged.missing = facts.heaps - known.size();
  for (const char* models : {"models", "models_eval"})
    take_over(folders[0].root / "bop" / models, to.root / "bop" / models);
  if (facts.wants("bop")) write_bop_root(bop_folder(to, facts));
  if (facts.wants("shards")) {
    ShardPacker packer(to, facts, {});
    if (merged.missing == 0) packer.pack_all();
  }
  return merged;
}

}  // namespace bin_scenes
