/// Work-precision diagram: error of the final scene over scene time, each solver over its settings. Where the exact
/// convex pieces of a part are known, stock Bullet gets the exact shape and the referee judges all alike.
#include "framework/benchmark.hpp"
#include "judged.hpp"
#include "peers/stock_bullet.hpp"

#include <cmath>
#include <filesystem>

namespace bin_scenes::bench {
namespace {

/// One point of a curve: what it changes in a request of that solver, or stock Bullet's settings.
struct Setting {
  std::string solver, varied, value;
  void (*change)(Request&) = [](Request&) {};
  double step = 0.0;  ///< s, of stock Bullet, as are the iterations
  int iterations = 10;
};

constexpr std::size_t of_quick = 4;  ///< so many, the first ones, in a quick run
const Setting settings[] = {
    {"sphere", "default", "0"},
    {"sphere/quick", "default", "0"},
    {"bullet", "time_step", "0.004166667"},
    {"bullet_stock", "time_step", "0.004166667", {}, 1.0 / 240.0},
    {"bullet_stock", "time_step", "0.01", {}, 0.01},
    {"bullet_stock", "iterations", "50", {}, 0.01, 50},
    {"bullet", "time_step", "0.002083333", [](Request& r) { r.solver.bullet.time_step *= 0.5; }},
    {"sphere", "finish", "settled", [](Request& r) { r.pour.finish = Pour::Finish::settled; }},
    {"sphere", "finish", "pressed", [](Request& r) { r.pour.finish = Pour::Finish::pressed; }},
    {"sphere", "time_step", "0.005", [](Request& r) { r.solver.sphere.time_step *= 2.0; }},
    {"sphere", "time_step", "0.00125", [](Request& r) { r.solver.sphere.time_step *= 0.5; }},
    {"sphere", "sub_steps", "1", [](Request& r) { r.solver.sphere.sub_steps = 1; }},
    {"sphere", "sub_steps", "8", [](Request& r) { r.solver.sphere.sub_steps = 8; }},
    {"sphere", "fine_samples", "250", [](Request& r) { r.solver.sphere.fine_samples = 250; }},
    {"sphere", "fine_samples", "3000", [](Request& r) { r.solver.sphere.fine_samples = 3000; }},
    {"sphere", "field_cell", "0.008", [](Request& r) { r.solver.sphere.field_cell *= 2.0; }},
    {"sphere", "field_cell", "0.002", [](Request& r) { r.solver.sphere.field_cell *= 0.5; }},
    {"sphere/thesis", "default", "0"}};

bool dominates(const Row& a, const Row& b, const std::string& error) {
  const double time_a = a.number("cpu_s"), time_b = b.number("cpu_s");
  const double error_a = a.number(error), error_b = b.number(error);
  return time_a <= time_b && error_a <= error_b && (time_a < time_b || error_a < error_b);
}

/// Marks the rows that no other row beats in both time and error. Scenes that did not come to rest, or lost parts,
/// have no place on it.
void mark_front(std::vector<Row>& rows, const std::string& error, const std::string& column) {
  const auto stands = [&](const Row& row) {
    return row.at("at_rest") == row.at("scenes") && row.at("escaped") == "0" && !std::isnan(row.number(error));
  };
  for (Row& row : rows) {
    if (row.at("scenes").empty()) continue;
    bool front = stands(row);
    for (const Row& other : rows) front = front && !(stands(other) && dominates(other, row, error));
    row.info(column, front);
  }
}

constexpr const char* parts[] = {"channel_u", "ring_24", "bolt_hex",   "nut_hex",  "clip_spring", "washer", "bracket_l",
                                 "gear_spur", "conrod",  "pipe_elbow", "pipe_tee", "mug",         "teapot"};

/// On the part's exact convex pieces.
MakeSolver stock_bullet(const Setting& setting, const std::string& pieces) {
  return [&setting, pieces] {
    StockBullet stock;
    stock.time_step = setting.step;
    stock.iterations = setting.iterations;
    stock.pieces = {read_pieces(pieces, 1e-3)};
    return make_stock_bullet(stock);
  };
}

void curves(Run& out, const std::string& part) {
  const std::size_t count = out.quick() ? 8 : 32;
  const std::string pieces = Run::pieces(part);
  const bool exact = std::filesystem::exists(pieces);
  for (std::size_t s = 0; s < (out.quick() ? of_quick : std::size(settings)); ++s) {
    const Setting& setting = settings[s];
    const bool stock = setting.step > 0.0;
    const Row key =
        Row::keys("part", part, "bodies", count, "solver", setting.solver, "sleeping",
                  setting.solver == "sphere/thesis" ? "no" : "yes", "varied", setting.varied, "value", setting.value);
    if ((stock && !exact) || !out.wanted(key)) continue;
    Request request = bin_of(part, count);
    if (!stock) {
      choose_solver(request, setting.solver);
      setting.change(request);
      warm_up(request);
    }
    const int seeds = out.quick() ? 1 : s == 0 ? 10 : 2;
    const Judged how{out.quick() ? 20.0 : 30.0, exact ? seeds : 0};
    const MakeSolver make = stock ? stock_bullet(setting, pieces) : MakeSolver();
    out.row(Row(key).append(joined(judged_scenes(out.scratch(), request, pieces, make, how, seeds))));
  }
  std::vector<Row> rows;
  for (std::size_t r = 0; r < out.table().rows.size(); ++r)
    if (const Row row = out.table().row(r); row.at("part") == part && row.at("bodies") == Row::text(count))
      rows.push_back(row);
  mark_front(rows, "penetration_p95_rel", "front_penetration");
  if (exact) mark_front(rows, "drift_p95_rel", "front_drift");
  for (const Row& row : rows) out.amend(row);
}

void run(Run& out) {
  if (out.quick()) return curves(out, parts[0]);
  for (const char* part : parts) curves(out, part);
}

const Registration registration{
    "work_precision", "error over scene time", {"part", "bodies", "solver", "sleeping", "varied", "value"}, run};

}  // namespace
}  // namespace bin_scenes::bench
