/// The goals of the default solver, on every sample part: errors of ten seeds. Where the exact convex pieces of a part
/// are known, the referee has its say. Few parts in a small bin are the harder test: p95 is that of the second worst.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "goals_met.hpp"
#include "judged.hpp"

#include "bin_scenes/gl/device.hpp"

namespace bin_scenes::bench {
namespace {

struct Pile {
  const char* part;
  int judged;  ///< seeds that the referee sees: it takes minutes for parts of many pieces; 0: no exact pieces
  std::size_t count = 150;
  double width = 0.40, length = 0.30, height = 0.20;  ///< m, of the bin

  bool usual() const { return count == 150; }
};
// Deep bins, six to twelve layers: the referee, which begins without forces, lets such heaps sag, and its word on them
// depends on its sweeps.
constexpr Pile piles[] = {{"channel_u", 10},
                          {"ring_24", 10},
                          {"bolt_hex", 10},
                          {"bracket_l", 3},
                          {"clip_spring", 3},
                          {"conrod", 0},
                          {"gear_spur", 10},
                          {"mug", 0},
                          {"nut_hex", 3},
                          {"pipe_elbow", 0},
                          {"pipe_tee", 0},
                          {"teapot", 0},
                          {"washer", 1},
                          {"channel_u", 10, 40, 0.20, 0.15},
                          {"gear_spur", 10, 40, 0.20, 0.15},
                          {"clip_spring", 10, 40, 0.20, 0.15},
                          {"channel_u", 0, 200, 0.15, 0.15, 0.80},
                          {"nut_hex", 0, 200, 0.08, 0.08, 0.60},
                          {"bolt_hex", 0, 300, 0.15, 0.15, 0.60},
                          {"gear_spur", 0, 120, 0.15, 0.15, 0.60},
                          {"pipe_tee", 0, 120, 0.20, 0.20, 0.60},
                          {"washer", 0, 250, 0.12, 0.12, 0.50}};

/// Whether there is a GPU; asked in a process of its own, which alone makes a GL context.
bool has_gpu() {
  const Isolated one = isolated([] { return Row().exact("software", gl::Device::current().software()); });
  return one.good && one.row.number("software") == 0.0;
}

void pile_row(Run& out, const Pile& pile, const std::string& solver, int seeds, int judged) {
  const std::size_t count = out.quick() ? 8 : pile.count;
  const Row key = Row().key("part", pile.part).key("bodies", count).key("solver", solver).key("sleeping", "yes");
  if (!out.wanted(key)) return;
  Request request = bin_of(pile.part, count);
  request.bin.inner_size = Vec3(pile.width, pile.length, pile.height);
  choose_solver(request, "sphere");
  warm_up(request);
  choose_solver(request, solver);
  std::vector<Row> scenes;
  for (int seed = 1; seed <= seeds; ++seed) {
    request.seed = static_cast<std::uint64_t>(seed);
    const Judged how{out.quick() ? 20.0 : 120.0, seed <= judged};
    scenes.push_back(judged_scene(out.scratch(), request, Run::pieces(pile.part), std::nullopt, how));
    if (scenes.back().at("scenes").empty()) break;
  }
  out.row(Row(key).append(over_all(scenes)));
}

void run(Run& out) {
  const bool gpu = out.quick() || has_gpu();
  for (const Pile& pile : piles) {
    if (out.quick() && (pile.judged == 0 || !pile.usual())) continue;
    pile_row(out, pile, "sphere", out.quick() ? 1 : 10, pile.judged);
    // By the report's own figures: where a GPU is, the referee need not be. Without one a scene would take minutes.
    if (gpu && pile.usual()) pile_row(out, pile, "sphere/gpu", out.quick() ? 1 : 3, 0);
  }
}

const Registration registration{
    "goals",
    "150 parts of every shape, 40 of some, and deep bins, against the goals, the referee's word beside",
    {"part", "bodies", "solver", "sleeping"},
    run};

}  // namespace
}  // namespace bin_scenes::bench
