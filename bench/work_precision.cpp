/// Work-precision diagram: error of the final scene over scene time, each solver over its settings. Where the exact
/// convex pieces of a part are known, stock Bullet gets the exact shape and the referee judges all alike.
#include "framework/benchmark.hpp"
#include "judged.hpp"

#include <cmath>
#include <filesystem>

namespace bin_scenes::bench {
namespace {

/// One point of a curve.
struct Setting {
  std::string solver, varied, value;
  std::function<void(Request&)> change;  ///< on a request of that solver
  MakeSolver make;                       ///< stock Bullet, or none
};

std::vector<Setting> settings_of_sphere(bool quick) {
  const SphereSettings sphere;
  std::vector<Setting> all = {{"sphere", "default", "0", [](Request&) {}, {}},
                              {"sphere/quick", "default", "0", [](Request&) {}, {}}};
  const auto add = [&](const std::string& varied, const std::string& value, const std::function<void(Request&)>& to) {
    all.push_back({"sphere", varied, value, to, {}});
  };
  for (const Pour::Finish finish : {Pour::Finish::settled, Pour::Finish::pressed})
    add("finish", name_of(finish), [=](Request& r) { r.pour.finish = finish; });
  for (const double factor : {2.0, 0.5})
    add("time_step", Row::text(factor * sphere.time_step),
        [=](Request& r) { r.solver.sphere.time_step = factor * sphere.time_step; });
  if (quick) return all;
  for (const int steps : {1, 4 * sphere.sub_steps})
    add("sub_steps", Row::text(steps), [=](Request& r) { r.solver.sphere.sub_steps = steps; });
  for (const double factor : {0.25, 3.0}) {
    const int samples = static_cast<int>(std::lround(factor * sphere.fine_samples));
    add("fine_samples", Row::text(samples), [=](Request& r) {
      r.solver.sphere.fine_samples = samples;
      r.solver.sphere.coarse_samples = std::min(r.solver.sphere.coarse_samples, samples);
    });
  }
  for (const double factor : {2.0, 0.5})
    add("field_cell", Row::text(factor * sphere.field_cell),
        [=](Request& r) { r.solver.sphere.field_cell = factor * sphere.field_cell; });
  all.push_back({"sphere/thesis", "default", "0", [](Request&) {}, {}});
  return all;
}

std::vector<Setting> settings_of_bullet(bool quick) {
  std::vector<Setting> all;
  for (const double factor : {1.0, 0.5}) {
    const double dt = factor * BulletSettings().time_step;
    all.push_back({"bullet", "time_step", Row::text(dt), [=](Request& r) { r.solver.bullet.time_step = dt; }, {}});
    if (quick) break;
  }
  return all;
}

/// Stock Bullet on the exact pieces of a file.
std::vector<Setting> settings_of_stock_bullet(const std::string& pieces, bool quick) {
  std::vector<Setting> all;
  const auto add = [&](const std::string& varied, double rate, int iterations) {
    StockBullet stock;
    stock.time_step = 1.0 / rate;
    stock.iterations = iterations;
    const std::string value = varied == "time_step" ? Row::text(stock.time_step) : Row::text(iterations);
    all.push_back({"bullet_stock", varied, value, {}, stock_bullet_on(pieces, stock)});
  };
  add("time_step", 240, 10);
  if (quick) return all;
  add("time_step", 100, 10);
  add("iterations", 100, 50);
  return all;
}

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

void curves(Run& out, const std::string& part) {
  const std::size_t count = out.quick() ? 8 : 32;
  const bool exact = std::filesystem::exists(Run::pieces(part));
  std::vector<Setting> settings = settings_of_sphere(out.quick());
  for (const Setting& one : settings_of_bullet(out.quick())) settings.push_back(one);
  if (exact)
    for (const Setting& one : settings_of_stock_bullet(Run::pieces(part), out.quick())) settings.push_back(one);
  for (const Setting& setting : settings) {
    Request request = bin_of(part, count);
    Row row;
    row.key("part", part)
        .key("bodies", count)
        .key("solver", setting.solver)
        .key("sleeping", setting.solver == "sphere/thesis" ? "no" : "yes")
        .key("varied", setting.varied)
        .key("value", setting.value);
    if (setting.change) {
      choose_solver(request, setting.solver);
      setting.change(request);
    }
    if (!out.wanted(row)) continue;
    if (setting.change) warm_up(request);
    const int seeds = out.quick() ? 1 : setting.solver == "sphere" && setting.varied == "default" ? 10 : 2;
    const std::vector<Row> scenes = judged_scenes(out.scratch(), request, Run::pieces(part), setting.make,
                                                  {out.quick() ? 20.0 : 30.0, exact ? seeds : 0}, seeds);
    out.row(row.append(scenes.back().at("scenes").empty() ? scenes.back() : joined(scenes)));
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
  for (const char* part : parts) {
    curves(out, part);
    if (out.quick()) return;
  }
}

const Registration registration{"work_precision",
                                "error over scene time: all solvers over their settings, stock Bullet beside",
                                {"part", "bodies", "solver", "sleeping", "varied", "value"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
