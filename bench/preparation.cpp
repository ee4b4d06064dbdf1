/// What a part costs before the first step: loading, mass, and the shapes that a solver asks for; from nothing (cold)
/// and from the disk cache (warm). Each run is a process of its own, as a user's is. Besides the sample parts those of
/// the folder in BIN_SCENES_REAL_PARTS, whose names end in their unit (nut_mm.stl), unless the file says it (DAE).
#include "bin_scenes/part/cache.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>

namespace bin_scenes::bench {
namespace {

namespace fs = std::filesystem;

struct Sample {
  std::string name, path;
  std::optional<Unit> unit;
};

std::optional<Unit> unit_in_name(const fs::path& path) {
  if (path.extension() == ".dae") return std::nullopt;
  const std::string stem = path.stem().string();
  for (const Unit unit : {Unit::metre, Unit::centimetre, Unit::millimetre, Unit::inch})
    if (stem.substr(stem.rfind('_') + 1) == name_of(unit)) return unit;
  return std::nullopt;
}

std::vector<Sample> samples_to_measure(bool quick) {
  std::vector<Sample> samples;
  for (const auto& entry : fs::directory_iterator(fs::path(Run::part("x")).parent_path())) {
    const fs::path path = entry.path();
    if (path.extension() == ".stl") samples.push_back({path.stem(), path, Unit::millimetre});
  }
  if (quick) {
    const auto unwanted = [](const Sample& s) { return s.name != "channel_u" && s.name != "conrod"; };
    samples.erase(std::remove_if(samples.begin(), samples.end(), unwanted), samples.end());
  } else if (const char* folder = std::getenv("BIN_SCENES_REAL_PARTS")) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const fs::path path = entry.path();
      for (const char* extension : {".stl", ".obj", ".ply", ".dae", ".off"})
        if (path.extension() == extension) samples.push_back({path.stem(), path, unit_in_name(path)});
    }
  }
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.name < b.name; });
  return samples;
}

Row prepare(const Sample& sample, const std::string& solver_name) {
  Request request = bin_of("conrod", 1);
  request.parts[0].model = fs::path(sample.path).filename();
  request.parts[0].path = sample.path;
  request.parts[0].unit = sample.unit;
  choose_solver(request, solver_name);
  LoadOptions load;
  load.unit = request.parts[0].unit;
  const double cpu_before = cpu_seconds();
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<PartModelPtr> parts = {PartModel::load(request.parts[0].path, load)};
  std::string reason;
  const std::unique_ptr<Solver> solver = make_solver(request, parts, reason);
  solver->add_world(world_of(request, parts));
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
  return Row()
      .info("seconds", spent.count())
      .info("cpu_s", cpu_seconds() - cpu_before)
      .info("triangles", parts[0]->mesh().triangles.size())
      .info("built", PartModel::work().built);
}

double megabytes_in(const std::string& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return 1e-6 * bytes;
}

void measure(Run& out, const Sample& sample, const std::string& solver, int repeats) {
  Row row;
  row.key("part", sample.name).key("solver", solver);
  if (!out.wanted(row)) return;
  std::vector<double> cold, cold_cpu, warm, warm_cpu, peak;
  double cache_mb = 0.0;
  std::size_t triangles = 0, built_warm = 0;
  for (int k = 0; k < repeats; ++k) {
    const std::string cache = out.scratch() + "/" + std::to_string(k);
    fs::create_directories(cache);
    for (std::vector<double>* times : {&cold, &warm}) {
      const Isolated one = isolated([&] {
        ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
        return prepare(sample, solver);
      });
      if (!one.good) return out.row(row.append(one.row));
      times->push_back(one.row.number("seconds"));
      triangles = static_cast<std::size_t>(one.row.number("triangles"));
      if (times == &cold) {
        cold_cpu.push_back(one.row.number("cpu_s"));
        peak.push_back(one.peak_mb);
      }
      if (times == &warm) {
        warm_cpu.push_back(one.row.number("cpu_s"));
        built_warm = static_cast<std::size_t>(one.row.number("built"));
      }
    }
    cache_mb = megabytes_in(cache + "/bin_scenes");
    fs::remove_all(cache);
  }
  out.row(row.exact("triangles", triangles)
              .measure("cold_s", cold)
              .measure("cold_cpu_s", cold_cpu)
              .measure("warm_s", warm)
              .measure("warm_cpu_s", warm_cpu)
              .exact("built_warm", built_warm)
              .measure("peak_mb", peak)
              .measure("cache_mb", {cache_mb, cache_mb}));
}

void run(Run& out) {
  for (const Sample& sample : samples_to_measure(out.quick()))
    for (const char* solver : {"sphere", "bullet", "sphere/thesis"}) measure(out, sample, solver, out.quick() ? 1 : 3);
}

const Registration registration{
    "preparation", "seconds and memory to make each sample part ready, cold and warm", {"part", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
