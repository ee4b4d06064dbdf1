/// How the cost of a step grows: with the parts of a world, with the worlds of a batch, with the samples of a part,
/// with the parts of one heap. Heaps at rest on an endless floor, or joined in one box, every part awake.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "framework/statistics.hpp"
#include "heaps.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {
namespace {

constexpr const char* part = "channel_u";

/// Counter of a solver, 0 if it has none of that name.
double counted(const Heaps& heaps, const std::string& name) {
  const auto& counters = heaps.solver().profile().counters;
  const auto found = counters.find(name);
  return found == counters.end() ? 0.0 : static_cast<double>(found->second);
}

/// A few steps to build contacts, then the samples; parts do not fall asleep that soon. `before` steps go ahead of
/// that, for heaps that are not at rest as they are set up.
Row step_row(const Heap& heap, const Request& settings, std::size_t per_world, std::size_t worlds, int before = 0) {
  Heaps heaps(heap, settings, per_world, worlds);
  const int steps = heaps.bodies() > 8192 ? 2 : heaps.bodies() > 512 ? 4 : 8;
  if (before > 0) {
    heaps.steps(before);
    heaps.wake(1.0);
  }
  heaps.steps(steps);
  std::vector<double> wall, cpu, part_us;
  double dispatches = 0;
  const Profile profile = heaps.solver().profile();
  for (int k = 0; k < 3; ++k) {
    dispatches = counted(heaps, "gl_dispatches");
    const Heaps::Cost cost = heaps.steps(steps);
    wall.push_back(cost.wall_ms);
    cpu.push_back(cost.cpu_ms);
    part_us.push_back(1e3 * cost.cpu_ms / static_cast<double>(heaps.bodies()));
  }
  Row row = Row()
                .measure("step_ms", wall)
                .measure("step_cpu_ms", cpu)
                .measure("part_cpu_us", part_us)
                .exact("asleep_share", heaps.asleep())
                .info("stages_us", stages_of(heaps.solver().profile().since(profile),
                                             1e3 / (3.0 * steps * static_cast<double>(heaps.bodies()))))
                .info("device", heaps.solver().device());
  if (heap.request.bin.kind == Bin::Kind::box) row.exact("joined_share", heaps.joined());
  if (settings.solver.sphere.device == SphereSettings::Device::gpu) {
    const double held = counted(heaps, "gl_bytes_held") - counted(heaps, "gl_bytes_shared");
    row.exact("dispatches_a_step", (counted(heaps, "gl_dispatches") - dispatches) / steps)
        .exact("bytes_a_part", held / static_cast<double>(heaps.bodies()));
  }
  return row;
}

/// Emits the rows of one curve and, at the end, the exponents of its cost and memory over x: of all rows of the table,
/// those kept from an earlier run included.
class Curve {
 public:
  Curve(Run& out, const std::string& solver, const std::string& over) : out_(out), solver_(solver), over_(over) {}
  ~Curve() {
    if (!out_.wanted(key("exponent"))) return;
    Samples cost, memory;
    double constant = 0.0;  // MB that the smallest size takes too: parts, fields, what loading took
    for (std::size_t r = 0; r < out_.table().rows.size(); ++r) {
      const Row row = out_.table().row(r);
      const double x = row.number("x"), step_ms = row.number("step_cpu_ms"), added_mb = row.number("added_mb");
      if (row.at("solver") != solver_ || row.at("over") != over_ || std::isnan(x) || std::isnan(step_ms)) continue;
      if (cost.x.empty()) constant = added_mb;
      cost.add(x, step_ms);
      // Less than that is lost in what loading took for a while.
      if (added_mb - constant > std::max(1.0, 0.1 * constant)) memory.add(x, added_mb - constant);
    }
    if (cost.x.size() < 2) return;
    Row row = key("exponent");
    row.measure("exponent_of_step", cost.exponent());
    if (memory.x.size() > 1) row.measure("exponent_of_memory", memory.exponent());
    out_.row(row);
  }
  /// False where the limit was reached: larger ones would not fit either.
  bool point(std::size_t bodies, std::size_t worlds, double x, const std::function<Row()>& work, double limit_cpu_s) {
    if (!out_.wanted(key(Row::text(x)))) return true;
    const Isolated one = isolated(work, limit_cpu_s);
    Row row = key(Row::text(x)).info("bodies", bodies).info("worlds", worlds).append(one.row);
    if (one.good) row.measure("peak_mb", one.peak_mb).measure("added_mb", one.added_mb);
    out_.row(row);
    return one.good;
  }

 private:
  struct Samples {
    std::vector<double> x, y;
    void add(double at, double value) {
      x.push_back(at);
      y.push_back(value);
    }
    /// Of the four largest: small ones are dominated by what every step costs.
    double exponent() const {
      const std::size_t skip = x.size() > 4 ? x.size() - 4 : 0;
      return fitted_exponent({x.begin() + skip, x.end()}, {y.begin() + skip, y.end()});
    }
  };
  Row key(const std::string& x) const { return Row().key("solver", solver_).key("over", over_).key("x", x); }

  Run& out_;
  std::string solver_, over_;
};

void run(Run& out) {
  const double limit_cpu_s = out.quick() ? 10.0 : 150.0;
  const std::string path = out.scratch() + "/heap_";
  const auto heap_of = [&](std::size_t count) {
    const std::string file = path + std::to_string(count) + ".json";
    isolated([&] { return heap_at_rest(part, count, file), Row(); });
    return heap_at_rest(part, count, file);
  };
  const std::vector<std::string> solvers =
      out.quick() ? std::vector<std::string>{"sphere", "sphere/gpu"}
                  : std::vector<std::string>{"sphere", "sphere/gpu", "bullet", "sphere/thesis"};

  const Heap large = heap_of(out.quick() ? 16 : 64), small = heap_of(16);
  for (const std::string& solver : solvers) {
    Request settings = large.request;
    choose_solver(settings, solver);
    {
      Curve curve(out, solver, "parts of one world");
      for (std::size_t heaps = 1; heaps <= (out.quick() ? 4u : 1024u); heaps *= heaps < 64 ? 2 : 4) {
        const std::size_t bodies = heaps * large.rest.size();
        if (!curve.point(
                bodies, 1, static_cast<double>(bodies), [&] { return step_row(large, settings, heaps, 1); },
                limit_cpu_s))
          break;
      }
    }
    {
      Curve curve(out, solver, "worlds of 16 parts");
      for (std::size_t worlds = 1; worlds <= (out.quick() ? 4u : 1024u); worlds *= 4) {
        const std::size_t bodies = worlds * small.rest.size();
        if (!curve.point(
                bodies, worlds, static_cast<double>(worlds), [&] { return step_row(small, settings, 1, worlds); },
                limit_cpu_s))
          break;
      }
    }
  }
  {
    // Five layers; a second after the walls between them are gone, what they held leans on its neighbours.
    const std::size_t count = out.quick() ? 16 : 64;
    const double width = out.quick() ? 0.08 : 0.12;
    const std::string file = path + "boxed.json";
    isolated([&] { return boxed_heap(part, count, width, file), Row(); });
    const Heap boxed = boxed_heap(part, count, width, file);
    Curve curve(out, "sphere", "one heap");
    for (std::size_t heaps = 4; heaps <= (out.quick() ? 4u : 64u); heaps *= 4) {
      const std::size_t bodies = heaps * boxed.rest.size();
      if (!curve.point(
              bodies, 1, static_cast<double>(bodies), [&] { return step_row(boxed, boxed.request, heaps, 1, 400); },
              limit_cpu_s))
        break;
    }
  }
  {
    Curve curve(out, "sphere", "samples of a part");
    for (const int samples :
         out.quick() ? std::vector<int>{250, 1000} : std::vector<int>{250, 500, 1000, 2000, 4000, 8000}) {
      Request settings = large.request;
      settings.solver.sphere.fine_samples = samples;
      settings.solver.sphere.coarse_samples = std::min(settings.solver.sphere.coarse_samples, samples);
      if (!curve.point(
              large.rest.size(), 1, samples, [&] { return step_row(large, settings, 1, 1); }, limit_cpu_s))
        break;
    }
  }
  if (out.quick()) return;
  Curve voxels(out, "sphere/thesis", "voxels along a part");
  for (const int along : {5, 7, 10, 14, 20}) {
    Request settings = large.request;
    choose_solver(settings, "sphere/thesis");
    settings.solver.thesis.voxels = along;
    if (!voxels.point(
            large.rest.size(), 1, along, [&] { return step_row(large, settings, 1, 1); }, limit_cpu_s))
      break;
  }
}

const Registration registration{"growth",
                                "cost of a step and memory over parts, worlds and samples, with fitted exponents",
                                {"solver", "over", "x"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
