/// What the host costs beside a GPU, for each world and slice of 1/60 s: a pour is recorded from one world, and run
/// again for many worlds on a device that answers and takes no time (test/meter/null_device.hpp). CPU time of all
/// threads is counted, less that of answering; it holds all that the host does for a pour: placing parts that enter,
/// decisions, uploads, and the driver's work for dispatches, as far as llvmpipe's driver is like a card's.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include "bin_scenes/pour/heap.hpp"
#include "meter/null_device.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <cmath>
#include <functional>
#include <memory>

namespace bin_scenes::bench {
namespace {

using meter::NullDevice;
using meter::Tape;

/// A solver for so many worlds whose lists need not grow: growth is work of the device.
std::shared_ptr<Solver> solver_for(const LoadedRequest& all, std::size_t worlds) {
  sphere_gl::Capacity capacity;
  capacity.bodies = all.request.part_count();
  capacity.memory = 1e7 * static_cast<double>(worlds + 1);
  capacity.as_on_card = true;
  capacity.pairs = 8;
  capacity.rows = 24;
  capacity.candidates = 16;
  return make_gl_sphere_solver(all.request.solver.sphere, capacity);
}

/// Settles the first scene of a request so many times side by side. `over` is called when one has ended.
/// @return CPU seconds, without what is made once for a solver: programs, shapes, room for the worlds
double settle(const LoadedRequest& all, std::size_t worlds, const std::function<void(Heap&&)>& over) {
  const SceneList scenes{worlds, [](std::size_t) { return std::size_t{0}; }};
  const std::shared_ptr<Solver> solver = solver_for(all, worlds);
  std::vector<WorldId> room;
  for (std::size_t w = 0; w < worlds; ++w) room.push_back(solver->add_world(world_of(all)));
  for (const WorldId id : room) solver->remove_world(id);
  const Clock clock;
  settle_scenes(all, solver, "", scenes, {}, [&](std::size_t, Heap&& heap) { over(std::move(heap)); });
  return clock.cpu_s();
}

Row measured(const Request& request, std::size_t worlds) {
  const LoadedRequest all = loaded(request);
  Tape tape;
  double slices = 0.0;
  std::uint64_t recorded = 0;
  {
    const NullDevice recorder;
    settle(all, 1, [&](Heap&& heap) {
      recorded = recorder.reads().bytes;
      slices = std::round(60.0 * heap.scene().report.simulated_s);
    });
    tape = recorder.tape();
  }
  const NullDevice device(std::move(tape));
  const double cpu_s = settle(all, worlds, [](Heap&&) {});
  const double world_slices = slices * static_cast<double>(worlds);
  return Row()
      .measure("host_cpu_ms", 1e3 * (cpu_s - device.cpu_s()) / world_slices)
      .measure("answers_cpu_ms", 1e3 * device.cpu_s() / world_slices)
      .measure("slices", slices)
      .measure("copies", static_cast<double>(device.reads().copies) / world_slices)
      .measure("bytes_read", static_cast<double>(device.reads().bytes) / world_slices)
      .exact("bytes_left", recorded * worlds - device.reads().bytes)  // 0: each world took the recorded course
      .exact("unanswered", device.unanswered());
}

void run(Run& out) {
  using Sizes = std::vector<std::size_t>;
  const std::size_t worlds = out.quick() ? 4 : 64;
  for (const std::size_t parts : out.quick() ? Sizes{12} : Sizes{64, 256}) {
    const Row key = Row::keys("bodies", parts, "worlds", worlds);
    if (!out.wanted(key)) continue;
    Request request = bin_of("conrod", parts);
    if (parts == 256) request.bin.inner_size = Vec3(0.40, 0.30, 0.20);  // m, as in config/conrods.yaml
    choose_solver(request, "sphere/gpu");
    out.row(Row(key).append(isolated([&] { return measured(request, worlds); }, 7200.0).row));
  }
}

const Registration registration{
    "host", "CPU time of the host beside a GPU that takes none, and what it reads", {"bodies", "worlds"}, run};

}  // namespace
}  // namespace bin_scenes::bench
