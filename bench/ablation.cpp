/// What each mechanism of the default solver gives: the same scenes with all of them, and with each one taken away.
/// Time is CPU time from request to poses. Errors are those of the scene's report; drift is that of its parts under the
/// solver with all of its mechanisms, from rest and without remembered forces.
#include "framework/benchmark.hpp"
#include "judged.hpp"
#include "mechanisms.hpp"
#include "solver/sphere/sphere_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes::bench {
namespace {

using sphere::Variant;

constexpr int seeds = 3, seeds_of_all = 6;  ///< scenes of a row; more with all mechanisms, to know their noise

constexpr std::size_t parts = 60;
constexpr const char* heaps[] = {"channel_u", "bolt_hex", "ring_24"};

Row key(const Mechanism& mechanism, const std::string& part) {
  return Row().key("without", mechanism.name).key("part", part).info("instead", mechanism.instead);
}

Row scenes_row(Run& out, const Mechanism& mechanism, const std::string& part) {
  Request request = bin_of(part, out.quick() ? 8 : parts);
  choose_solver(request, "sphere");
  request.drift_check = true;
  warm_up(request);
  Variant variant;
  mechanism.take_away(variant);
  const MakeSolver make = [&](const std::vector<PartModelPtr>&) {
    return make_sphere_solver(request.solver.sphere, variant);
  };
  const int count = out.quick() ? 1 : &mechanism == mechanisms ? seeds_of_all : seeds;
  const std::vector<Row> scenes = judged_scenes(out.scratch(), request, Run::pieces(part), make, {120.0, 0}, count);
  if (scenes.back().at("scenes").empty()) return scenes.back();
  Row row = joined(scenes);
  for (const char* figure : {"drift_p95_rel", "drift_max_rel", "turn_p95_deg"})
    row.measure(figure, row.number(std::string("own_") + figure));
  return row;
}

/// The row of that name and part, as it was measured here or earlier.
Row measured(const Run& out, const Mechanism& mechanism, const std::string& part) {
  for (std::size_t r = 0; r < out.table().rows.size(); ++r)
    if (const Row row = out.table().row(r); row.at("without") == mechanism.name && row.at("part") == part) return row;
  return {};
}

/// All parts in one row: the mean of the times' ratios, and of each error the worst part's.
Row all_parts(const Run& out, const Mechanism& mechanism) {
  Row all;
  double log_ratio = 0.0, scenes = 0.0, at_rest = 0.0;
  for (const char* part : heaps) {
    const Row row = measured(out, mechanism, part);
    log_ratio += std::log(row.number("cpu_ratio")) / std::size(heaps);
    scenes += row.number("scenes");
    at_rest += row.number("at_rest");
    for (const char* error :
         {"penetration_p95_rel", "penetration_max_rel", "drift_p95_rel", "drift_max_rel", "turn_p95_deg"})
      if (const double value = row.number(error); !std::isnan(value) && !(value <= all.number(error)))
        all.measure(error, value);
  }
  return Row().measure("cpu_ratio", std::exp(log_ratio)).exact("scenes", scenes).exact("at_rest", at_rest).append(all);
}

void run(Run& out) {
  for (const Mechanism& mechanism : mechanisms) {
    bool any = false;
    for (const char* part : heaps) {
      if (!out.wanted(key(mechanism, part))) continue;
      any = true;
      Row row = key(mechanism, part).append(scenes_row(out, mechanism, part));
      const double with_all = (&mechanism == mechanisms ? row : measured(out, *mechanisms, part)).number("cpu_s");
      out.row(row.measure("cpu_ratio", row.number("cpu_s") / with_all));
    }
    if (any && out.wanted(key(mechanism, "all"))) out.row(key(mechanism, "all").append(all_parts(out, mechanism)));
  }
}

const Registration registration{
    "ablation", "what each mechanism of the default solver gives: scenes without it", {"without", "part"}, run};

}  // namespace
}  // namespace bin_scenes::bench
