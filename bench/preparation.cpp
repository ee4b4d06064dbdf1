/// What a part costs before the first step: loading, mass, and the shapes that a solver asks for; from nothing (cold)
/// and from the disk cache (warm). Each run is a process of its own, as a user's is.
#include "bin_scenes/part/cache.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace bin_scenes::bench {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> samples_to_measure(bool quick) {
  std::vector<std::string> samples;
  for (const auto& entry : fs::directory_iterator(fs::path(Run::part("x")).parent_path())) {
    const fs::path path = entry.path();
    const bool wanted = !quick || path.stem() == "channel_u" || path.stem() == "conrod";
    if (path.extension() == ".stl" && wanted) samples.push_back(path.stem());
  }
  std::sort(samples.begin(), samples.end());
  return samples;
}

Row prepare(const std::string& part, const std::string& solver_name) {
  Request request = bin_of(part, 1);
  choose_solver(request, solver_name);
  const Clock clock;
  const std::vector<PartModelPtr> parts = load_parts(request);
  std::string reason;
  const std::unique_ptr<Solver> solver = make_solver(request, parts, reason);
  solver->add_world(world_of({request, parts}));
  return Row()
      .info("seconds", clock.wall_s())
      .info("cpu_s", clock.cpu_s())
      .info("triangles", parts[0]->mesh().triangles.size())
      .info("built", PartModel::work().built);
}

double megabytes_in(const std::string& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return 1e-6 * bytes;
}

void measure(Run& out, const std::string& part, const std::string& solver, int repeats) {
  Row row;
  row.key("part", part).key("solver", solver);
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
        return prepare(part, solver);
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
  for (const std::string& part : samples_to_measure(out.quick()))
    for (const char* solver : {"sphere", "bullet", "sphere/thesis"}) measure(out, part, solver, out.quick() ? 1 : 3);
}

const Registration registration{
    "preparation", "seconds and memory to make each sample part ready, cold and warm", {"part", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
