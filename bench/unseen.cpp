/// The goals on parts that no solver was tuned to, drawn from seeds: whether what holds for the samples holds for
/// others. Each seed of a part is another; new ones are had by other seeds.
#include "framework/benchmark.hpp"
#include "goals_met.hpp"
#include "judged.hpp"
#include "random_part.hpp"

#include <cstdio>

namespace bin_scenes::bench {
namespace {

constexpr int parts = 20, seeds = 3;  ///< scenes of a part, all of them seen by the referee

void run(Run& out) {
  const std::size_t count = out.quick() ? 8 : 150;
  for (int part = 1; part <= (out.quick() ? 1 : parts); ++part) {
    char name[16];
    std::snprintf(name, sizeof name, "random_%02d", part);
    const Row key = Row().key("part", name).key("bodies", count).key("solver", "sphere");
    if (!out.wanted(key)) continue;
    const std::string folder = out.scratch() + "/" + name;
    const int pieces = write_random_part(folder, static_cast<std::uint64_t>(part));
    Request request = bin_of(name, count);
    request.parts[0].model = "part.obj";
    request.parts[0].path = folder + "/part.obj";
    request.bin.inner_size = Vec3(0.40, 0.30, 0.20);
    choose_solver(request, "sphere");
    warm_up(request);
    std::vector<Row> scenes;
    for (int seed = 1; seed <= (out.quick() ? 1 : seeds); ++seed) {
      request.seed = static_cast<std::uint64_t>(seed);
      const Judged how{out.quick() ? 20.0 : 120.0, true};
      scenes.push_back(judged_scene(out.scratch(), request, folder, std::nullopt, how));
      if (scenes.back().at("scenes").empty()) break;
    }
    out.row(Row(key).exact("pieces", pieces).append(over_all(scenes)));
  }
}

const Registration registration{
    "unseen", "150 parts drawn from a seed against the goals", {"part", "bodies", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
