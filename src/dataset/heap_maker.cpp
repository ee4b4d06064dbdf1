/// Draws a request, pours its heap, takes parts out step by step, and writes a folder a scene. An attempt that fails is
/// set apart with its reasons and drawn anew.
#include "dataset/heap_maker.hpp"

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bop/samples.hpp"
#include "bop/writer.hpp"
#include "core/formatted.hpp"
#include "core/read_file.hpp"
#include "dataset/shards.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double cpu_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double resident_mb() {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// Wall times differ from run to run: they go into the index, and the scene does without.
void without_times(Report& report) {
  report.wall_s = std::nan("");
  report.profile = {};
}

LoadOptions options_of(const PlanObject& object) {
  LoadOptions options;
  options.unit = object.unit;
  options.scale = object.scale;
  options.thickness = object.thickness;
  options.tessellation = object.tessellation;
  options.solid = object.solid;
  return options;
}

/// The highest parts, the highest first.
std::vector<int> highest(const Scene& scene, std::size_t count) {
  std::vector<const ScenePart*> parts;
  for (const ScenePart& part : scene.parts)
    if (is_there(part.state) && part.state != PartState::fixed && part.pose.finite()) parts.push_back(&part);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const ScenePart* a, const ScenePart* b) { return a->pose.position.z() > b->pose.position.z(); });
  std::vector<int> ids;
  BIN_SCENES_ASSERT(std::is_sorted(parts.begin(), parts.end(), [](const ScenePart* a, const ScenePart* b) {
    return a->pose.position.z() > b->pose.position.z();
  }));
  for (std::size_t i = 0; i < std::min(count, parts.size()); ++i) ids.push_back(parts[i]->id);
  return ids;
}

/// The first part of the order of removal that has a free grasp; else the first of the order, else the highest.
std::vector<int> next_pick(const Scene& scene, const std::optional<SceneGrasps>& grasps) {
  if (!grasps || grasps->removal_order.empty()) return highest(scene, 1);
  for (const int id : grasps->removal_order) {
    const auto free = [&](const SceneGrasp& grasp) { return grasp.part == id && grasp.free(); };
    if (std::any_of(grasps->grasps.begin(), grasps->grasps.end(), free)) return {id};
  }
  return {grasps->removal_order.front()};
}

SceneRecord record_of_scene(const DataFolder& folder, std::size_t scene, const SceneFile& file) {
  const fs::path path = folder.scene(scene);
  return {scene, path.lexically_relative(folder.root).string(), sha256_of_file((path / "files.json").string()),
          summary_of(file)};
}

}  // namespace

HeapRecord HeapMaker::make(std::size_t heap) {
  const auto begin = Clock::now();
  const double cpu_before = cpu_seconds();
  const std::size_t first = heap * (plan_.depletion.steps + 1);
  HeapRecord record;
  record.heap = heap;
  for (std::size_t k = 0; k < plan_.attempts && !record.accepted; ++k) {
    WholeFolders folders;
    const Attempt made = attempt(heap, k, record, folders);
    record.accepted = made.reasons.empty();
    if (!record.accepted) {
      if (heap == first_ && k == 0 && made.fault && attempt(heap, 1, record, folders).fails_like(made))
        throw input_error("two draws fail alike, and no draw seems to cure it: " + made.fault->problem(),
                          made.fault->where(), made.fault->remedy());
      set_apart(made, heap, k);
      record.rejected.push_back(
          {k, folder_.set_apart(first, k).lexically_relative(folder_.root).string(), made.reasons});
      continue;
    }
    const auto before = Clock::now();
    folders.commit();
    record.stages_ms["commit"] += ms_since(before);
    for (std::size_t scene = first; scene < first + made.scenes; ++scene)
      record.scenes.push_back(record_of_scene(folder_, scene, *scene_in(folder_.scene(scene))));
  }
  BIN_SCENES_ASSERT(record.accepted == !record.scenes.empty() && record.rejected.size() <= plan_.attempts);
  BIN_SCENES_ASSERT(
      each_is(record.scenes, [&](const SceneRecord& s) { return s.scene / (plan_.depletion.steps + 1) == heap; }));
  record.wall_s = ms_since(begin) / 1e3;
  record.cpu_s = cpu_seconds() - cpu_before;
  record.memory_mb = resident_mb();
  return record;
}

bool HeapMaker::Attempt::fails_like(const Attempt& other) const {
  if (!fault || !other.fault) return false;
  return crowded == other.crowded && (crowded || std::string(fault->what()) == other.fault->what());
}

HeapMaker::Attempt HeapMaker::attempt(std::size_t heap, std::size_t attempt, HeapRecord& record,
                                      WholeFolders& folders) {
  Attempt made;
  try {
    make_scenes(heap, attempt, made, record, folders);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    made.reasons = {std::string("the values drawn do not go together: ") + error.what()};
    made.fault = error;
    made.result.reset();
  }
  return made;
}

void HeapMaker::make_scenes(std::size_t heap, std::size_t attempt, Attempt& out, HeapRecord& record,
                            WholeFolders& folders) {
  out.request = plan_.request(heap, attempt, [&](const PartLine& line) { return volume_of(line); });
  // What is the faster device differs between machines, and with it the scenes would.
  SphereSettings::Device& device = out.request->solver.sphere.device;
  if (device == SphereSettings::Device::automatic) device = SphereSettings::Device::cpu;
  auto before = Clock::now();
  Heap pile = generator_.heap(*out.request);
  record.stages_ms["load"] += ms_since(before);
  for (std::size_t step = 0; step <= plan_.depletion.steps; ++step) {
    before = Clock::now();
    if (step > 0) {
      const std::vector<int> taken = plan_.depletion.by_grasp ? next_pick(out.result->scene, out.result->grasps)
                                                              : highest(pile.scene(), plan_.take(heap, attempt, step));
      if (taken.empty()) return;  // the bin is empty since the step before
      pile.remove(taken);
    }
    pile.settle();
    record.stages_ms["pour"] += ms_since(before);
    before = Clock::now();
    Generator::Options options;
    options.render = plan_.formats != std::vector<std::string>{"json"};
    options.gray = plan_.wants_gray();
    options.grasps = plan_.wants("grasps") || plan_.depletion.by_grasp;
    options.index = out.request->first + step;
    out.result = generator_.result(pile, options);
    const Scene& scene = out.result->scene;
    for (const char* stage : {"quality", "render"})
      if (scene.report.profile.stages_ms.count(stage))
        record.stages_ms[stage] += scene.report.profile.stages_ms.at(stage);
    without_times(out.result->scene.report);
    out.reasons = scene.report.reasons;
    if (const std::optional<Error> crowded = crowd(scene)) {
      out.reasons.insert(out.reasons.begin(), crowded->problem());
      out.fault = crowded;
      out.crowded = true;
    }
    if (!out.reasons.empty()) return;
    before = Clock::now();
    std::vector<BopImage> bop;
    if (plan_.wants("bop") || plan_.wants("shards"))
      bop = bop_images(scene, pile.parts(), out.result->images, {plan_.tolerance, object_ids(pile.request())});
    record.stages_ms["masks"] += ms_since(before);
    before = Clock::now();
    write_scene(*out.result, pile.loaded(), bop, out.request->first + step, folders);
    record.stages_ms["write"] += ms_since(before);
    ++out.scenes;
  }
}

std::optional<Error> HeapMaker::crowd(const Scene& scene) const {
  const auto poured = std::count_if(scene.parts.begin(), scene.parts.end(),
                                    [](const ScenePart& part) { return part.state != PartState::fixed; });
  const std::size_t outside = scene.report.not_poured.size();
  if (!(static_cast<double>(outside) > plan_.most_not_poured * static_cast<double>(poured))) return std::nullopt;
  return input_error(formatted("%zu of %zu parts found no room, more than %.3g %%", outside,
                               static_cast<std::size_t>(poured), 100.0 * plan_.most_not_poured),
                     "amount", "ask for fewer parts, enlarge the bin, or raise the plan's not_poured");
}

void HeapMaker::write_scene(const Generator::Result& result, const LoadedRequest& loaded,
                            const std::vector<BopImage>& bop, std::size_t scene, WholeFolders& folders) {
  // The folder with scene.json gets its name last: where it is, everything is.
  if (plan_.wants("bop"))
    folders.write(folder_.bop(facts_, scene), [&](const std::string& hidden) {
      write_bop(hidden, bop, plan_.bop, facts_.split_of_scene(scene), plan_.objects.size(), plan_.run_lengths);
    });
  if (plan_.wants("shards"))
    folders.write(folder_.samples(scene), [&](const std::string& hidden) {
      write_bop_samples(hidden, scene, bop);
      if (plan_.wants("grasps")) write_grasp_samples(hidden, result.scene, scene, *result.grasps, loaded.request);
    });
  const std::set<std::string> formats(plan_.formats.begin(), plan_.formats.end());
  folders.write(folder_.scene(scene), [&](const std::string& hidden) {
    write_scene_files(hidden, formats, result, loaded, plan_.mcap);
    write_text((fs::path(hidden) / "request.yaml").string(), write_request(loaded.request));
  });
}

void HeapMaker::set_apart(const Attempt& failed, std::size_t heap, std::size_t attempt) {
  WholeFolders folders;
  const std::set<std::string> formats = {"json", plan_.wants("png") ? "png" : "json"};
  folders.write(folder_.set_apart(heap * (plan_.depletion.steps + 1), attempt), [&](const std::string& hidden) {
    if (failed.result) write_scene_files(hidden, formats, *failed.result, generator_.loaded());
    if (failed.request) write_text((fs::path(hidden) / "request.yaml").string(), write_request(*failed.request));
    std::string text;
    for (const std::string& reason : failed.reasons) text += reason + "\n";
    write_text((fs::path(hidden) / "reasons.txt").string(), text);
  });
  folders.commit();
}

std::vector<int> HeapMaker::object_ids(const Request& request) const {
  std::vector<int> ids;
  for (const PartLine& line : request.parts) {
    if (line.distractor) {
      ids.push_back(0);  // of no entry
      continue;
    }
    const auto object = std::find_if(plan_.objects.begin(), plan_.objects.end(),
                                     [&](const PlanObject& one) { return is_of(one, line); });
    if (object == plan_.objects.end())
      throw input_error("the model of a part line is in no list of the plan", line.model,
                        "draw model, unit, scale and thickness of a line together, by one choice");
    ids.push_back(static_cast<int>(object - plan_.objects.begin()) + 1);
  }
  return ids;
}

double HeapMaker::volume_of(const PartLine& line) {
  const LoadOptions options = load_options(line);
  double& volume = volumes_[{line.sha256, options.unit, options.scale, options.thickness, options.tessellation.chord,
                             options.tessellation.angle, options.solid}];
  if (volume == 0.0) {
    volume = PartModel::load(line.path, options)->mass().volume;
  }
  return volume;
}

std::optional<HeapRecord> found_on_disk(const DataFolder& folder, const DataSetFacts& facts, std::size_t heap) {
  HeapRecord record;
  record.heap = heap;
  record.wall_s = -1.0;
  const std::size_t first = heap * (facts.steps + 1);
  for (std::size_t attempt = 0; attempt < facts.attempts; ++attempt) {
    const fs::path path = folder.set_apart(first, attempt);
    std::ifstream file(path / "reasons.txt");
    if (!file || !whole(path, false)) break;
    RejectedRecord rejected{attempt, path.lexically_relative(folder.root).string(), {}};
    for (std::string line; std::getline(file, line);) rejected.reasons.push_back(line);
    record.rejected.push_back(rejected);
  }
  for (std::size_t scene = first; scene <= first + facts.steps; ++scene) {
    const auto file = scene_in(folder.scene(scene));
    if (!file || !whole(folder.scene(scene), false)) break;
    if (facts.wants("bop") && !whole(folder.bop(facts, scene), false)) break;
    const bool packed = std::filesystem::exists(folder.shard(shard_of(facts, scene)));
    if (facts.wants("shards") && !packed && !whole(folder.samples(scene), false)) break;
    record.scenes.push_back(record_of_scene(folder, scene, *file));
    record.accepted = scene == first + facts.steps || is_empty(*file);
    if (record.accepted) break;
  }
  if (record.accepted) return record;
  record.scenes.clear();
  if (record.rejected.size() == facts.attempts) return record;
  return std::nullopt;
}

void write_models(const Plan& plan, const DataFolder& folder) {
  std::vector<PartModelPtr> parts;
  std::vector<Symmetries> symmetries;
  for (const PlanObject& object : plan.objects) {
    parts.push_back(PartModel::load(object.path, options_of(object)));
    if (!object.continuous) {
      symmetries.push_back(find_symmetries(*parts.back()));
      continue;
    }
    Symmetries given;
    for (const Vec3& axis : *object.continuous) given.continuous.push_back({axis, parts.back()->mass().center});
    for (const Quat& turn : *object.discrete)
      given.discrete.push_back({parts.back()->mass().center - turn * parts.back()->mass().center, turn});
    symmetries.push_back(given);
  }
  const BopFolder bop{folder.root / "bop"};
  WholeFolders folders;
  folders.write(bop.models(), [&](const std::string& hidden) { write_bop_models(hidden, parts, symmetries); });
  folders.write(bop.models_eval(),
                [&](const std::string& hidden) { write_bop_models(hidden, parts, symmetries, true); });
  folders.commit();
}

}  // namespace bin_scenes
