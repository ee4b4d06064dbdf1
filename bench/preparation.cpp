/// What a part costs before the first step: loading, mass, and the shapes that a solver asks for; from nothing (cold)
/// and from the disk cache (warm). Each run is a process of its own, as a user's is.
#include "bin_scenes/core/cache.hpp"
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

/// With the cache in that folder.
Isolated prepare(const std::string& part, const std::string& solver_name, const std::string& cache) {
  return isolated([&] {
    ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    Request request = bin_of(part, 1);
    choose_solver(request, solver_name);
    const Clock clock;
    const LoadedRequest all = loaded(request);
    solver_of(all)->add_world(world_of(all));
    return Row()
        .info("triangles", all.parts[0]->mesh().triangles.size())
        .info("built_warm", PartModel::work().built)
        .measure("s", clock.wall_s())
        .measure("cpu_s", clock.cpu_s());
  });
}

double megabytes_in(const std::string& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  return 1e-6 * bytes;
}

void measure(Run& out, const std::string& part, const std::string& solver, int repeats) {
  const Row key = Row::keys("part", part, "solver", solver);
  if (!out.wanted(key)) return;
  std::vector<Row> rows;
  for (int k = 0; k < repeats; ++k) {
    const std::string cache = out.scratch() + "/" + std::to_string(k);
    fs::create_directories(cache);
    const Isolated cold = prepare(part, solver, cache), warm = prepare(part, solver, cache);
    if (!cold.good || !warm.good) return out.row(Row(key).append((cold.good ? warm : cold).row));
    rows.push_back(Row()
                       .info("triangles", cold.row.at("triangles"))
                       .measure("cold_s", cold.row.number("s"))
                       .measure("cold_cpu_s", cold.row.number("cpu_s"))
                       .measure("warm_s", warm.row.number("s"))
                       .measure("warm_cpu_s", warm.row.number("cpu_s"))
                       .info("built_warm", warm.row.at("built_warm"))
                       .measure("peak_mb", cold.peak_mb)
                       .measure("cache_mb", megabytes_in(cache + "/bin_scenes")));
    fs::remove_all(cache);
  }
  out.row(Row(key).append(joined(rows)));
}

void run(Run& out) {
  for (const std::string& part : samples_to_measure(out.quick()))
    for (const char* solver : {"sphere", "bullet", "sphere/thesis"}) measure(out, part, solver, out.quick() ? 1 : 3);
}

const Registration registration{"preparation",
                                "seconds and memory to make each sample part ready, cold and warm",
                                {"part", "solver"},
                                run,
                                "src/core src/mesh src/part"};

}  // namespace
}  // namespace bin_scenes::bench
