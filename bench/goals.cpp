/// The goals of the default solver: on every sample part, on parts that no solver was tuned to, drawn from seeds, and
/// on thin parts in a deep bin, of which every solver that knows surfaces by points knows too little; and what each
/// finish of a pour costs and leaves; and the main job as a user asks for it, both solvers over counts and shapes.
/// Where the exact convex pieces of a part are known, the referee has its say. Few parts in a small bin are the harder
/// test: p95 is that of the second worst.
#include "framework/benchmark.hpp"
#include "framework/host.hpp"
#include "judged.hpp"
#include "made_part.hpp"

#include <algorithm>
#include <cstdio>

namespace bin_scenes::bench {
namespace {

struct Goal {
  const char* column;
  double limit;
};
constexpr Goal own[] = {
    {"penetration_p95_rel", 0.003}, {"penetration_max_rel", 0.01}, {"bin_penetration_max_rel", 0.003}};
constexpr Goal referees[] = {
    {"drift_median_rel", 0.001}, {"drift_p95_rel", 0.01}, {"turn_p95_deg", 0.5}, {"report_to_referee_rel", 0.0005}};

template <class Goals>
bool within(const Row& scene, const Goals& goals) {
  return std::all_of(std::begin(goals), std::end(goals),
                     [&](const Goal& goal) { return scene.number(goal.column) <= goal.limit; });  // false for NaN
}

/// The largest value of a column over the scenes that have it.
void add_worst(Row& out, const std::vector<Row>& scenes, const std::string& column) {
  std::vector<double> values;
  for (const Row& scene : scenes)
    if (!scene.at(column).empty()) values.push_back(scene.number(column));
  if (!values.empty()) out.measure("worst_" + column, *std::max_element(values.begin(), values.end()));
}

/// Scenes of several seeds as one row, with the worst seed of each goal beside the median, and counted: meets_own,
/// scenes at rest, whole and within the goals of overlap by their own report; judged, those that the referee saw;
/// meets_all, those of the judged that meet every goal. The first that failed instead, if one did.
Row over_all(std::vector<Row> scenes) {
  if (scenes.back().at("scenes").empty()) return scenes.back();
  for (Row& scene : scenes) {
    const bool whole = scene.at("at_rest") == "1" && scene.at("escaped") == "0" && within(scene, own);
    const bool judged = !scene.at("report_to_referee_rel").empty();
    scene.exact("meets_own", static_cast<int>(whole))
        .exact("judged", static_cast<int>(judged))
        .exact("meets_all", static_cast<int>(whole && judged && within(scene, referees)));
  }
  Row out = joined(scenes);
  for (const Goal& goal : own) add_worst(out, scenes, goal.column);
  for (const Goal& goal : referees) add_worst(out, scenes, goal.column);
  return out;
}

void heap_row(Run& out, const Row& key, const Request& request, const std::string& pieces, int seeds, Judged how) {
  if (out.quick()) how.limit_cpu_s = 20.0, seeds = 1;
  out.row(Row(key).append(over_all(judged_scenes(out.scratch(), request, pieces, {}, how, seeds))));
}

const Vec3 usual_bin(0.40, 0.30, 0.20), small_bin(0.20, 0.15, 0.20);  // m

struct Pile {
  const char* part;
  int judged;  ///< seeds that the referee sees: it takes minutes for parts of many pieces; 0: no exact pieces
  std::size_t count = 150;
  Vec3 size = usual_bin;  ///< of the bin

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
                      {"channel_u", 10, 40, small_bin},
                      {"gear_spur", 10, 40, small_bin},
                      {"clip_spring", 10, 40, small_bin},
                      {"channel_u", 0, 200, {0.15, 0.15, 0.80}},
                      {"nut_hex", 0, 200, {0.08, 0.08, 0.60}},
                      {"bolt_hex", 0, 300, {0.15, 0.15, 0.60}},
                      {"gear_spur", 0, 120, {0.15, 0.15, 0.60}},
                      {"pipe_tee", 0, 120, {0.20, 0.20, 0.60}},
                      {"washer", 0, 250, {0.12, 0.12, 0.50}}};

Request request_of(const Run& out, const Pile& pile) {
  Request request = bin_of(pile.part, out.quick() ? 8 : pile.count);
  request.bin.inner_size = pile.size;
  return request;
}

void pile_row(Run& out, const Pile& pile, const std::string& solver, int seeds, int judged) {
  Request request = request_of(out, pile);
  const Row key = Row::keys("part", pile.part, "bodies", request.parts[0].count, "solver", solver, "sleeping", "yes");
  if (!out.wanted(key)) return;
  warm_up(request, "sphere");
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
  Request request = bin_of(name, out.quick() ? 8 : 150);
  const Row key = Row::keys("part", name, "bodies", request.parts[0].count, "solver", "sphere");
  if (!out.wanted(key)) return;
  const std::string folder = out.scratch() + "/" + name;
  const int pieces = write(folder);
  request.parts[0].model = "part.obj";
  request.parts[0].path = folder + "/part.obj";
  request.bin.inner_size = size;
  warm_up(request, "sphere");
  heap_row(out, Row(key).exact("pieces", pieces), request, folder + "/pieces.obj", seeds, {limit_cpu_s, seeds});
}

void unseen(Run& out) {
  for (int seed = 1; seed <= (out.quick() ? 1 : 20); ++seed) {
    char name[32];
    std::snprintf(name, sizeof name, "random_%02d", seed);
    const auto write = [&](const std::string& folder) {
      return write_random_part(folder, static_cast<std::uint64_t>(seed));
    };
    made_part_row(out, name, write, usual_bin, 3, 120.0);
  }
}

void thin(Run& out) {
  for (const std::string& name : thin_parts()) {
    if (out.quick() && name != "frame") continue;
    const auto write = [&](const std::string& folder) { return write_thin_part(folder, name); };
    made_part_row(out, name, write, Vec3(0.25, 0.20, 0.30), 2, 240.0);
  }
}

/// A part in a bin under each finish, and under solvers that know one finish only.
void finish_rows(Run& out, const Pile& bin) {
  const std::pair<const char*, Pour::Finish> rows[] = {{"sphere", Pour::Finish::settled},
                                                       {"sphere", Pour::Finish::pressed},
                                                       {"sphere", Pour::Finish::probed},
                                                       {"sphere/quick", Pour::Finish::settled},
                                                       {"bullet", Pour::Finish::settled}};
  for (const auto& [solver, finish] : rows) {
    Request request = request_of(out, bin);
    const Row key =
        Row::keys("part", bin.part, "bodies", request.parts[0].count, "solver", solver, "finish", name_of(finish));
    if (!out.wanted(key)) continue;
    request.pour.finish = finish;
    warm_up(request, solver);
    heap_row(out, key, request, Run::pieces(bin.part), bin.judged, {120.0, bin.judged});
  }
}

void finish(Run& out) {
  const Pile bins[] = {{"channel_u", 3},
                       {"channel_u", 3, 40, small_bin},
                       {"gear_spur", 3, 40, small_bin},
                       {"clip_spring", 3, 40, small_bin},
                       {"bolt_hex", 3, 40, small_bin}};
  if (out.quick()) return finish_rows(out, bins[0]);
  for (const Pile& bin : bins) finish_rows(out, bin);
}

/// Scene time, memory and the errors of the final scene.
void scenes(Run& out) {
  const std::vector<std::size_t> counts = {64, 256, 512};
  for (const std::size_t count : out.quick() ? std::vector<std::size_t>{16} : counts)
    for (const char* part : {"bolt_hex", "conrod", "pipe_tee"})
      for (const std::string solver : {"sphere", "bullet"}) {
        const Row key = Row::keys("part", part, "bodies", count, "solver", solver, "sleeping", "yes");
        if (!out.wanted(key)) continue;
        const bool bullet = solver == "bullet", many = count > 256 || (count > 64 && bullet);
        Request request = bin_of(part, count);
        warm_up(request, solver);
        const Judged how{out.quick() ? 20.0 : bullet ? 600.0 : 150.0, 0};
        const int seeds = out.quick() || many ? 1 : 3;
        out.row(Row(key).append(joined(judged_scenes(out.scratch(), request, {}, {}, how, seeds))));
      }
}

const Registration of_samples{
    "goals", "every part, in deep bins too: goals and referee", {"part", "bodies", "solver", "sleeping"}, samples};
const Registration of_unseen{
    "unseen", "150 parts drawn from a seed against the goals", {"part", "bodies", "solver"}, unseen};
const Registration of_thin{
    "thin", "150 thin parts in a deep bin against the goals", {"part", "bodies", "solver"}, thin};
const Registration of_finish{
    "finish", "what each finish of a pour costs and leaves", {"part", "bodies", "solver", "finish"}, finish};
const Registration of_scenes{
    "scenes", "time, memory and errors of scenes of 64 to 512 parts", {"part", "bodies", "solver", "sleeping"}, scenes};

}  // namespace
}  // namespace bin_scenes::bench
