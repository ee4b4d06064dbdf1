#include "judged.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "referee.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {

namespace {

constexpr double millimetre = 1e-3;            ///< unit of pieces
constexpr double referee_limit_cpu_s = 600.0;  ///< 2000 steps of a heap of parts of a hundred pieces

/// The referee's figures of a scene. Its quantile is the sample that the share falls on: of 40 parts the second worst.
Row referee_row(const std::string& path, const Request& request, const std::string& pieces) {
  const LoadedRequest all = loaded(request);
  const Scene scene = read_scene_json(path);
  const std::vector<Pieces> exact = {read_pieces(pieces, millimetre)};
  const Overlap overlap = referee_overlap(scene, all, exact);
  const Drift drift = referee_drift(scene, all, exact);
  const auto of = [](std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size()));
    return values.empty() ? 0.0 : values[std::min(values.size() - 1, index)];
  };
  return Row()
      .measure("drift_median_rel", of(drift.moved, 0.5))
      .measure("drift_p95_rel", of(drift.moved, 0.95))
      .measure("drift_max_rel", of(drift.moved, 1.0))
      .measure("turn_p95_deg", of(drift.turned, 0.95))
      .measure("referee_penetration_p95_rel", of(overlap.pairs, 0.95))
      .measure("referee_penetration_max_rel", of(overlap.pairs, 1.0))
      .measure("referee_bin_penetration_max_rel", of(overlap.bin, 1.0));
}

/// The largest difference between the report's and the referee's three figures of overlap.
double disagreement(const Row& scene) {
  double worst = 0.0;
  for (const char* figure : {"penetration_p95_rel", "penetration_max_rel", "bin_penetration_max_rel"})
    worst = std::max(worst, std::abs(scene.number(figure) - scene.number(std::string("referee_") + figure)));
  return worst;
}

Row judged_scene(const std::string& scratch, const Request& request, const std::string& pieces, const MakeSolver& make,
                 const Judged& how) {
  const std::string path = scratch + "/scene.json";
  Isolated poured = isolated(
      [&] {
        const Poured result = pour_timed(request, make);
        write_text(path, scene_json(result.scene, result.loaded));
        return figures_of(result);
      },
      how.limit_cpu_s);
  if (poured.good) poured.row.measure("peak_mb", poured.peak_mb);
  if (!poured.good || how.judged == 0) return poured.row;
  const Isolated said = isolated([&] { return referee_row(path, request, pieces); }, referee_limit_cpu_s);
  poured.row.append(said.row);
  if (said.good) poured.row.measure("report_to_referee_rel", disagreement(poured.row));
  return poured.row;
}

}  // namespace

std::vector<Row> judged_scenes(const std::string& scratch, Request request, const std::string& pieces,
                               const MakeSolver& make, Judged how, int seeds) {
  std::vector<Row> scenes;
  for (int seed = 1; seed <= seeds; ++seed, how.judged = std::max(0, how.judged - 1)) {
    request.seed = static_cast<std::uint64_t>(seed);
    scenes.push_back(judged_scene(scratch, request, pieces, make, how));
    if (scenes.back().at("scenes").empty()) break;
  }
  return scenes;
}

}  // namespace bin_scenes::bench
