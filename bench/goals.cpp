/// The goals of the default solver: on every sample part, on parts that no solver was tuned to, drawn from seeds, and
/// on thin parts in a deep bin, of which every solver that knows surfaces by points knows too little. Where the exact
/// convex pieces of a part are known, the referee has its say. Few parts in a small bin are the harder test: p95 is
/// that of the second worst.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "goals_met.hpp"
#include "judged.hpp"
#include "made_part.hpp"

#include "bin_scenes/gl/device.hpp"

#include <cstdio>

namespace bin_scenes::bench {
namespace {

void heap_row(Run& out, const Row& key, const Request& request, const std::string& pieces, int seeds,
              const Judged& how) {
  const Judged quick{20.0, how.judged};
  out.row(Row(key).append(
      over_all(judged_scenes(out.scratch(), request, pieces, {}, out.quick() ? quick : how, out.quick() ? 1 : seeds))));
}

struct Pile {
  const char* part;
  int judged;  ///< seeds that the referee sees: it takes minutes for parts of many pieces; 0: no exact pieces
  std::size_t count = 150;
  Vec3 size = Vec3(0.40, 0.30, 0.20);  ///< m, of the bin

  bool usual() const { return count == 150; }
};
// Deep bins, six to twelve layers: the referee, which begins without forces, lets such heaps sag, and its word on them
// depends on its sweeps.
const Pile piles[] = {{"channel_u", 10},
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
                      {"channel_u", 10, 40, {0.20, 0.15, 0.20}},
                      {"gear_spur", 10, 40, {0.20, 0.15, 0.20}},
                      {"clip_spring", 10, 40, {0.20, 0.15, 0.20}},
                      {"channel_u", 0, 200, {0.15, 0.15, 0.80}},
                      {"nut_hex", 0, 200, {0.08, 0.08, 0.60}},
                      {"bolt_hex", 0, 300, {0.15, 0.15, 0.60}},
                      {"gear_spur", 0, 120, {0.15, 0.15, 0.60}},
                      {"pipe_tee", 0, 120, {0.20, 0.20, 0.60}},
                      {"washer", 0, 250, {0.12, 0.12, 0.50}}};

/// Whether there is a GPU; asked in a process of its own, which alone makes a GL context.
bool has_gpu() {
  const Isolated one = isolated([] { return Row().exact("software", gl::Device::current().software()); });
  return one.good && one.row.at("software") == "no";
}

void pile_row(Run& out, const Pile& pile, const std::string& solver, int seeds, int judged) {
  const std::size_t count = out.quick() ? 8 : pile.count;
  const Row key = Row().key("part", pile.part).key("bodies", count).key("solver", solver).key("sleeping", "yes");
  if (!out.wanted(key)) return;
  Request request = bin_of(pile.part, count);
  request.bin.inner_size = pile.size;
  choose_solver(request, "sphere");
  warm_up(request);
  choose_solver(request, solver);
  heap_row(out, key, request, Run::pieces(pile.part), seeds, {120.0, judged});
}

void samples(Run& out) {
  const bool gpu = out.quick() || has_gpu();
  for (const Pile& pile : piles) {
    if (out.quick() && (pile.judged == 0 || !pile.usual())) continue;
    pile_row(out, pile, "sphere", 10, pile.judged);
    // By the report's own figures: where a GPU is, the referee need not be. Without one a scene would take minutes.
    if (gpu && pile.usual()) pile_row(out, pile, "sphere/gpu", 3, 0);
  }
}

/// 150 of a part that `write` makes in a folder; all of its scenes are seen by the referee.
template <class Write>
void made_part_row(Run& out, const std::string& name, const Write& write, const Vec3& size, int seeds,
                   double limit_cpu_s) {
  const std::size_t count = out.quick() ? 8 : 150;
  const Row key = Row().key("part", name).key("bodies", count).key("solver", "sphere");
  if (!out.wanted(key)) return;
  const std::string folder = out.scratch() + "/" + name;
  const int pieces = write(folder);
  Request request = bin_of(name, count);
  request.parts[0].model = "part.obj";
  request.parts[0].path = folder + "/part.obj";
  request.bin.inner_size = size;
  choose_solver(request, "sphere");
  warm_up(request);
  heap_row(out, Row(key).exact("pieces", pieces), request, folder + "/pieces.obj", seeds, {limit_cpu_s, seeds});
}

void unseen(Run& out) {
  for (int part = 1; part <= (out.quick() ? 1 : 20); ++part) {
    char name[32];
    std::snprintf(name, sizeof name, "random_%02d", part);
    const auto write = [&](const std::string& folder) {
      return write_random_part(folder, static_cast<std::uint64_t>(part));
    };
    made_part_row(out, name, write, Vec3(0.40, 0.30, 0.20), 3, 120.0);
  }
}

void thin(Run& out) {
  for (const std::string& name : thin_parts()) {
    if (out.quick() && name != "frame") continue;
    const auto write = [&](const std::string& folder) { return write_thin_part(folder, name); };
    made_part_row(out, name, write, Vec3(0.25, 0.20, 0.30), 2, 240.0);
  }
}

const Registration of_samples{"goals",
                              "150 parts of every shape, 40 of some, and deep bins, against the goals and the referee",
                              {"part", "bodies", "solver", "sleeping"},
                              samples};
const Registration of_unseen{
    "unseen", "150 parts drawn from a seed against the goals", {"part", "bodies", "solver"}, unseen};
const Registration of_thin{
    "thin", "150 thin parts in a deep bin against the goals", {"part", "bodies", "solver"}, thin};

}  // namespace
}  // namespace bin_scenes::bench
