/// Compares the results of an audit (AuditFigures) with its limits. The result states which measures exceed their
/// limits and names the parts and images that are worst; text, page and JSON of an audit all show it. The ids of parts
/// are checked here as well; all other measures come from the auditor.
#pragma once

#include "audit/auditor.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace bin_scenes {

double share_above(const AuditMeasure& measure);  ///< returns the share of the values above the limit
/// Whether the data set fails by a measure: one value above the limit if strict, otherwise more than the share `share`.
bool exceeds(const AuditMeasure& measure, double share);

/// Sets the limits of measures from texts "key=value". Throws an input Error that lists the keys.
void set_limits(AuditFigures& figures, const std::vector<std::string>& limits);

/// Finds instance ids that occur twice in an image, that differ between views of the same heap, or that are not written
/// where this project writes them, and adds these faults to their parts. Data sets without ids have no such faults.
void check_ids(const BopSet& set, const std::vector<AuditHeap>& heaps, AuditFigures& figures);

/// Returns what text, page and `--json` show: measures, faults of the data set, and the worst parts and images.
nlohmann::ordered_json audit_json(const BopSet& set, AuditFigures& figures, double share);

}  // namespace bin_scenes
