/// A scene poured by any solver, and what the referee says of it.
#pragma once

#include "runs.hpp"

#include <string>

namespace bin_scenes::bench {

struct Judged {
  double limit_cpu_s = 60.0;  ///< for the pour; the referee may take ten minutes
  int judged = 1;             ///< scenes, the first ones, that the referee sees; 0 where the part has no exact pieces
};

/// Pours `request`, of one part line, for seeds 1 to `seeds`, each in a process of its own, and has the referee judge
/// the scenes in others: both set globals of Bullet. A row a scene; ends at the first that failed. Figures of
/// figures_of(), then the referee's: drift_median_rel, drift_p95_rel, drift_max_rel, turn_p95_deg, its own
/// referee_penetration_p95_rel, .._penetration_max_rel and .._bin_penetration_max_rel, and the largest difference
/// between these and the report's, report_to_referee_rel.
/// @param pieces  folder of the part's exact convex pieces, in millimetres
/// @param make  the solver that pours instead of the request's, or none
std::vector<Row> judged_scenes(const std::string& scratch, Request request, const std::string& pieces,
                               const MakeSolver& make, Judged how, int seeds);

}  // namespace bin_scenes::bench
