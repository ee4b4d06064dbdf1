/// Scene time against stock Bullet's in the same run: Bullet until its own sleeping has nothing left to move, and
/// Bullet for as many simulated seconds as the default solver needed until rest.
#include "bin_scenes/core/error.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "peers/stock_bullet.hpp"
#include "runs.hpp"

#include <algorithm>
#include <atomic>
#include <optional>

namespace bin_scenes::bench {
namespace {

constexpr double given_up = 6.0;   ///< s, simulated: most piles rattle on and never sleep as a whole
constexpr double slow_for = 0.25;  ///< s: what has just come in is slow for a moment as well
constexpr int least_seeds = 2, most_seeds = 10;
constexpr double enough = 120.0;  ///< s of CPU: no more seeds after that. Bullet's scenes take 4 to 250 s each
constexpr const char* exact[] = {"channel_u",   "bolt_hex", "ring_24",   "nut_hex",
                                 "clip_spring", "washer",   "gear_spur", "bracket_l"};
constexpr const char* decomposed[] = {"conrod", "pipe_tee"};  ///< on the hulls that solver `bullet` uses

/// The convex shapes that Bullet gets for a part.
Pieces shapes_of(const PartModel& part, const Request& request, const std::string& pieces) {
  if (!pieces.empty()) return read_pieces(pieces, 1e-3);
  HullOptions options;
  options.max_error = request.solver.bullet.hull_error;
  options.max_hulls = request.solver.bullet.max_hulls;
  Pieces shapes;
  for (const Mesh& hull : part.hulls(options).hulls) shapes.push_back(hull.vertices);
  return shapes;
}

/// What a request had cost by a mark, and how much was simulated by then.
struct Mark {
  double cpu_s = 0.0, wall_s = 0.0, simulated_s = 0.0;
};

/// Stock Bullet until all parts are slow together, until all are asleep, and for `as_long` (s, simulated); it is
/// stopped when all is known, or after `given_up` simulated seconds.
Row bullet_row(const Request& request, const std::string& pieces, double as_long) {
  const Clock clock;
  const LoadedRequest all = loaded(request);
  StockBullet settings;
  settings.pieces = {shapes_of(*all.parts.front(), request, pieces)};
  const std::size_t shapes = settings.pieces.front().size();
  std::optional<Mark> slow, asleep, same;
  Mark now;
  std::atomic<bool> known{false};
  double moved = 0.0;
  settings.watch = [&](double simulated, BulletRest rest) {
    now = {clock.cpu_s(), clock.wall_s(), simulated};
    const auto reach = [&](std::optional<Mark>& mark, bool reached) {
      if (!mark && reached) mark = now;
    };
    if (rest == BulletRest::moves) moved = simulated;
    reach(same, simulated >= as_long);
    reach(slow, simulated - moved >= slow_for);
    reach(asleep, rest == BulletRest::asleep);
    known = (same && asleep) || simulated >= std::max(as_long, given_up);
  };
  RunHooks hooks;
  hooks.cancel = &known;
  try {
    pour(all, *make_stock_bullet(settings), {request.first}, hooks);
  } catch (const Error& stopped) {
    if (stopped.kind() != ErrorKind::cancelled) throw;
  }
  Row row = Row().info("shapes", shapes);
  const auto add = [&](const std::string& name, const std::optional<Mark>& mark) {
    const Mark reached = mark.value_or(now);  // never, or not after: a pour that rests takes no more time
    row.exact("bullet_" + name, static_cast<int>(mark.has_value()))
        .measure("bullet_" + name + "_cpu_s", reached.cpu_s)
        .measure("bullet_" + name + "_scene_s", reached.wall_s)
        .measure("bullet_" + name + "_simulated_s", reached.simulated_s);
  };
  add("slow", slow);
  add("asleep", asleep);
  add("as_long", same);
  return row;
}

/// CPU and wall seconds of a scene by that preset.
Row own_row(Request request, const std::string& solver, const std::string& prefix) {
  warm_up(request, solver);
  const Row figures = isolated([&] { return figures_of(pour_timed(request)); }).row;
  Row row = Row().status(figures.at("status"));
  for (const char* figure : {"cpu_s", "scene_s", "simulated_s"}) row.measure(prefix + figure, figures.number(figure));
  return row;
}

void part_row(Run& out, const std::string& part, bool has_pieces) {
  const std::size_t count = out.quick() ? 8 : 150;
  const Row key = Row::keys("part", part, "bodies", count);
  if (!out.wanted(key)) return;
  Request request = bin_of(part, count);
  request.bin.inner_size = Vec3(0.40, 0.30, 0.20);
  const std::string pieces = has_pieces ? Run::pieces(part) : std::string();
  std::vector<Row> scenes;
  double spent = 0.0;
  for (int seed = 1; seed <= (out.quick() ? 1 : spent < enough ? most_seeds : least_seeds); ++seed) {
    request.seed = static_cast<std::uint64_t>(seed);
    const Row quick = own_row(request, "sphere/quick", "quick_"), ours = own_row(request, "sphere", "");
    if (!ours.at("status").empty()) return out.row(Row(key).append(ours));
    const Isolated bullet = isolated([&] { return bullet_row(request, pieces, ours.number("simulated_s")); }, 300.0);
    if (!bullet.good) return out.row(Row(key).append(bullet.row));
    Row scene = Row().exact("scenes", 1).append(ours).append(quick).append(bullet.row);
    scene.info("pieces", has_pieces ? "exact" : "hulls");
    for (const std::string until : {"slow", "asleep", "as_long"})
      for (const std::string own : {"", "quick_"})
        scene.measure(own + "share_of_" + until,
                      scene.number(own + "cpu_s") / scene.number("bullet_" + until + "_cpu_s"));
    spent += std::max(scene.number("bullet_asleep_cpu_s"), scene.number("bullet_as_long_cpu_s"));
    scenes.push_back(scene);
  }
  out.row(Row(key).append(joined(scenes)));
}

void run(Run& out) {
  if (out.quick()) return part_row(out, exact[0], true);
  for (const char* part : exact) part_row(out, part, true);
  for (const char* part : decomposed) part_row(out, part, false);
}

const Registration registration{
    "times", "scene time of the default solver against stock Bullet's", {"part", "bodies"}, run};

}  // namespace
}  // namespace bin_scenes::bench
