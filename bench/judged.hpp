/// A scene poured by any solver or peer, and what the referee says of it.
#pragma once

#include "peers/peer.hpp"
#include "runs.hpp"

#include <optional>
#include <string>

namespace bin_scenes::bench {

struct Judged {
  double limit_cpu_s = 60.0;  ///< for the pour; the referee may take ten minutes
  bool referee = true;        ///< the part has exact pieces, and the referee is wanted
};

/// Pours `request`, of one part line, in one process and has the referee judge it in another: both set globals of
/// Bullet. Figures of figures_of(), then the referee's: drift_median_rel, drift_p95_rel, drift_max_rel, turn_p95_deg,
/// its own referee_penetration_p95_rel, .._penetration_max_rel and .._bin_penetration_max_rel, and the largest difference
/// between these and the report's, report_to_referee_rel.
/// @param pieces folder of the part's exact convex pieces, in millimetres
/// @param peer pours instead of the request's solver, on the part's exact pieces
Row judged_scene(const std::string& scratch, const Request& request, const std::string& pieces,
                 const std::optional<PeerSettings>& peer, const Judged& how);

}  // namespace bin_scenes::bench
