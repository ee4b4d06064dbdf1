/// Finds out what is missing, has workers make it, and packs the rest. Everything that can be refused is refused before
/// the first worker starts.
#include "dataset/run.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "core/formatted.hpp"
#include "dataset/heap_maker.hpp"
#include "dataset/scene_index.hpp"
#include "dataset/shards.hpp"
#include "dataset/whole_folders.hpp"
#include "dataset/workers.hpp"

#include <chrono>
#include <memory>
#include <thread>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

std::string size_text(double bytes) {
  return bytes < 1e9 ? formatted("%.1f MB", bytes / 1e6) : formatted("%.2f GB", bytes / 1e9);
}

/// Heaps of this share that are done; the index is put right where it and the disk differ.
std::set<std::size_t> reconcile(const DataFolder& folder, const DataSetFacts& facts, SceneIndex& index,
                                const RunOptions& options) {
  const std::set<std::size_t> known = index.heaps();
  std::set<std::size_t> seen = heaps_in(folder, facts), done;
  seen.insert(known.begin(), known.end());
  for (const std::size_t heap : seen) {
    if (heap >= facts.heaps || heap % options.shards != options.shard) continue;
    stop_if_cancelled();
    const auto record = found_on_disk(folder, facts, heap);
    if (record) done.insert(heap);
    if (record && !known.count(heap)) index.put(*record);
    if (!record && known.count(heap)) index.forget(heap);
  }
  return done;
}

/// Refuses what cannot fit, and warns of what hardly does.
void check_disk(const Plan& plan, const DataFolder& folder, std::size_t heaps_left, const RunOptions& options) {
  std::error_code unknown;
  const fs::space_info space = fs::space(folder.root, unknown);
  if (unknown) return;
  BIN_SCENES_ASSERT(heaps_left <= plan.heaps);
  const double scenes = static_cast<double>(heaps_left * (plan.depletion.steps + 1));
  const double needed = scenes * estimate_scene_bytes(plan), free = static_cast<double>(space.available);
  const std::string figures = "the scenes need about " + size_text(needed) + ", " + size_text(free) + " are free";
  if (needed > free)
    throw environment_error(figures, folder.root.string(),
                            "free space, ask for fewer scenes or outputs, or use --shard");
  if (needed > 0.8 * free && options.warn) options.warn(figures);
}

}  // namespace

double estimate_scene_bytes(const Plan& plan) {
  constexpr double block = 4096.0;  // of a file system: a small file takes one
  double pixels = 0.0;
  for (const Sensor& sensor : plan.reference.sensors) pixels += static_cast<double>(sensor.width) * sensor.height;
  const double sensors = static_cast<double>(plan.reference.sensors.size());
  const double parts = static_cast<double>(plan.reference.part_count());
  double bytes = 4 * block + parts * (700.0 + 300.0 * sensors);
  if (plan.wants("png")) bytes += 4.0 * pixels + 7 * block * sensors;
  for (const char* cloud : {"pcd", "ply"})
    if (plan.wants(cloud)) bytes += 45.0 * pixels;
  for (const char* recording : {"bag", "mcap"})
    if (plan.wants(recording)) bytes += 45.0 * pixels;
  if (plan.wants("bop")) bytes += 2.2 * pixels + parts * sensors * 2 * block + 6 * block;
  if (plan.wants("shards")) bytes += 2.2 * pixels + parts * sensors * 2500.0;
  return bytes;
}

namespace {

/// Those that are not `done`. `report` is called from time to time.
void make_heaps(const Plan& plan, const DataFolder& folder, const RunOptions& options,
                const std::set<std::size_t>& done, const std::function<void(const HeapRecord&)>& made,
                const std::function<void()>& report) {
  static const std::atomic<bool> never{false};
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  std::unique_ptr<HeapMaker> maker;  // of each worker, made in it
  Workers workers(
      options.workers > 0 ? options.workers : cores,
      [&](std::size_t heap) {
        if (!maker) maker = std::make_unique<HeapMaker>(plan, folder, options.shard);
        return json_of(maker->make(heap));
      },
      options.warn);
  std::size_t next = options.shard;
  workers.run(
      [&]() -> std::optional<std::size_t> {
        while (next < plan.heaps && done.count(next)) next += options.shards;
        if (next >= plan.heaps) return std::nullopt;
        const std::size_t heap = next;
        next += options.shards;
        return heap;
      },
      [&](const nlohmann::json& answer) {
        if (answer.contains("error"))
          throw Error(static_cast<ErrorKind>(answer["kind"].get<int>()), answer["error"], answer["where"],
                      answer["remedy"]);
        made(record_of(answer));
      },
      options.stop ? *options.stop : never, report);
}

RunProgress progress_so_far(const DataSetFacts& facts, const RunOptions& options, std::size_t done,
                            const IndexCounts& counts) {
  RunProgress progress;
  progress.phase = "scenes";
  progress.heaps = options.shard < facts.heaps ? (facts.heaps - options.shard - 1) / options.shards + 1 : 0;
  progress.heaps_done = done;
  progress.accepted = counts.scenes;
  progress.rejected = counts.rejected;
  progress.failed = counts.failed;
  return progress;
}

}  // namespace

RunProgress run_dataset(const Plan& plan, const std::string& directory, const RunOptions& options) {
  const CancelScope scope(options.stop);
  std::set<std::string> formats(plan.formats.begin(), plan.formats.end());
  formats.erase("shards");
  check_formats(formats, "outputs");
  check_writable(directory);
  const DataFolder folder{directory};
  const DataSetFacts facts = facts_of(plan);
  const DataSetFacts before = claim(folder, facts, plan.text);
  const FolderLock lock(folder.root);
  remove_leftovers(folder);
  if (!(before == facts)) {
    if (facts.heaps > before.heaps) unpack_last_shard(folder, before);
    put_plan(folder, facts, plan.text);
  }
  SceneIndex index(folder.index());
  index.add_share(options.shard, options.shards);
  const std::set<std::size_t> done = reconcile(folder, facts, index, options);

  RunProgress progress = progress_so_far(facts, options, done.size(), index.counts());
  check_disk(plan, folder, progress.heaps - done.size(), options);
  const auto begin = Clock::now();
  const auto report = [&] {
    const double spent = std::chrono::duration<double>(Clock::now() - begin).count();
    const double made = static_cast<double>(progress.heaps_done - done.size());
    progress.scenes_per_hour = made * static_cast<double>(facts.steps + 1) / spent * 3600.0;
    progress.remaining_s = made > 0.0 ? spent / made * static_cast<double>(progress.heaps - progress.heaps_done) : 0.0;
    if (options.progress) options.progress(progress);
  };
  report();
  std::optional<ShardPacker> packer;
  if (plan.wants("shards") && options.shards == 1) packer.emplace(folder, facts, done);
  const auto made = [&](const HeapRecord& record) {
    index.put(record);
    ++progress.heaps_done;
    progress.accepted += record.scenes.size();
    progress.rejected += record.rejected.size();
    progress.failed += !record.accepted;
    if (packer) packer->add(record.heap);
    report();
  };
  try {
    if (progress.heaps_done < progress.heaps) make_heaps(plan, folder, options, done, made, report);
    stop_if_cancelled();
  } catch (...) {
    remove_leftovers(folder);  // of the workers that have just been stopped
    throw;
  }
  progress.phase = "pack";
  report();
  if (plan.wants("bop") || plan.wants("shards")) write_models(plan, folder);
  if (plan.wants("bop")) write_bop_root(bop_folder(folder, facts));
  if (packer) packer->pack_all();
  const IndexCounts all = index.counts();
  progress.not_poured = all.not_poured;
  progress.asked_for = all.asked_for;
  report();
  return progress;
}

}  // namespace bin_scenes
