/// The goals on thin parts in a deep bin: plates, bars and wires, of which every solver that knows surfaces by points
/// knows too little.
#include "framework/benchmark.hpp"
#include "goals_met.hpp"
#include "judged.hpp"
#include "thin_part.hpp"

namespace bin_scenes::bench {
namespace {

constexpr int seeds = 2;  ///< scenes of a part; those at rest are seen by the referee

void run(Run& out) {
  const std::size_t count = out.quick() ? 8 : 150;
  for (const std::string& name : thin_parts()) {
    if (out.quick() && name != "frame") continue;
    const Row key = Row().key("part", name).key("bodies", count).key("solver", "sphere");
    if (!out.wanted(key)) continue;
    const std::string folder = out.scratch() + "/" + name;
    const int pieces = write_thin_part(folder, name);
    Request request = bin_of(name, count);
    request.parts[0].model = "part.obj";
    request.parts[0].path = folder + "/part.obj";
    request.bin.inner_size = Vec3(0.25, 0.20, 0.30);
    choose_solver(request, "sphere");
    warm_up(request);
    std::vector<Row> scenes;
    for (int seed = 1; seed <= (out.quick() ? 1 : seeds); ++seed) {
      request.seed = static_cast<std::uint64_t>(seed);
      const Judged how{out.quick() ? 20.0 : 240.0, true};
      scenes.push_back(judged_scene(out.scratch(), request, folder, std::nullopt, how));
      if (scenes.back().at("scenes").empty()) break;
    }
    out.row(Row(key).exact("pieces", pieces).append(over_all(scenes)));
  }
}

const Registration registration{
    "thin", "150 thin parts in a deep bin against the goals", {"part", "bodies", "solver"}, run};

}  // namespace
}  // namespace bin_scenes::bench
