/// Compares the results of an audit with its limits, and names the parts and images that exceed them.
#pragma once

#include "audit/auditor.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

double share_above(const AuditMeasure& measure);
/// Whether the data set fails by this measure: strict ones by any value, others by more than `share` of the values.
bool exceeds(const AuditMeasure& measure, double share);

/// Sets limits as "key=value". Throws an input Error that lists the keys.
void set_limits(AuditFigures& figures, const std::vector<std::string>& limits);

/// Instance ids that occur twice in an image, that other views of the heap give to other parts, or that do not stand
/// where this project puts them; added to the faults of their parts. Sets without ids have no faults.
void check_ids(const BopSet& set, const std::vector<AuditHeap>& heaps, AuditFigures& figures);

/// All that text, page and `--json` show: measures, the faults of the set, and the worst parts and images.
nlohmann::ordered_json audit_json(const BopSet& set, AuditFigures& figures, double share);

}  // namespace bin_scenes
