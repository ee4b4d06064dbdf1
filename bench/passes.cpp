/// What each pass of the GPU form takes, of one world and of many at once: copies of one heap of conrods in each phase
/// of a pour, every part awake. To pour, the heap is stretched upwards, so that all of it falls. Worlds differ a
/// little, and so do the pairs that they find anew.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "pour/settling.hpp"

#include <memory>

namespace bin_scenes::bench {
namespace {

struct Case {
  const char* name;
  Phase phase;
  double stretch;
};
const Case cases[] = {{"pour", phases::pour, 1.15},
                      {"settle", phases::settle, 1.0},
                      {"press", phases::press, 1.0},
                      {"probe", phases::probe, 1.0}};

/// Device time of each pass a step, all worlds together.
Row measured(const Request& request, const std::vector<ScenePart>& heap, const Case& of, std::size_t worlds) {
  const LoadedRequest all = loaded(request);
  const std::unique_ptr<Solver> solver = solver_of(all);
  std::vector<WorldId> ids;
  for (std::size_t w = 0; w < worlds; ++w) {
    ids.push_back(solver->add_world(world_of(all)));
    solver->set_phase(ids.back(), of.phase);
    for (std::size_t i = 0; i < heap.size(); ++i) {
      BodyState state{heap[i].pose, {}};
      state.pose.position.z() *= of.stretch * (1.0 + 1e-4 * static_cast<double>(w));
      solver->insert(ids.back(), i, state);
    }
  }
  constexpr int before = 4, timed = 14;  // contacts are found and lists grow; parts do not fall asleep that soon
  solver->advance(ids, before * solver->step_size());
  const Profile start = solver->profile();
  const Clock clock;
  solver->advance(ids, timed * solver->step_size());
  const double wall_us = 1e6 * clock.wall_s();
  const Profile spent = solver->profile().since(start);
  const auto world_steps = static_cast<double>(spent.counters.at("steps"));
  const double steps = world_steps / static_cast<double>(worlds);
  Row row;
  row.measure("step_us", wall_us / steps).measure("world_us", wall_us / world_steps);
  for (const char* pass : {"find_pairs", "find_contacts", "color_manifolds", "solve", "update_sleep"}) {
    const auto stage = spent.stages_ms.find(pass);
    if (stage != spent.stages_ms.end()) row.measure(std::string(pass) + "_us", 1e3 * stage->second / steps);
  }
  return row.info("device", solver->device());
}

void run(Run& out) {
  const std::size_t parts = out.quick() ? 12 : 256;
  Request request = bin_of("conrod", parts);
  request.bin.inner_size = Vec3(0.40, 0.30, 0.20);  // m, as in config/conrods.yaml
  choose_solver(request, "sphere");
  const std::string path = out.scratch() + "/heap.json";
  pour_into(path, request);
  const std::vector<ScenePart> heap = read_scene_json(path).parts;
  choose_solver(request, "sphere/gpu");
  const std::vector<std::size_t> few = {1, 2}, many = {1, 66, 264, 1056};
  for (const Case& of : cases)
    for (const std::size_t worlds : out.quick() ? few : many) {
      const Row key = Row::keys("phase", of.name, "worlds", worlds);
      if (out.wanted(key)) out.row(Row(key).append(isolated([&] { return measured(request, heap, of, worlds); }).row));
    }
}

const Registration registration{
    "passes", "time of each pass of the GPU form, of one world and of many, by phase", {"phase", "worlds"}, run};

}  // namespace
}  // namespace bin_scenes::bench
