/// Writes the results of an audit as one HTML page: tables of the measures and of the worst parts, and a histogram of
/// each measure. The page contains all of its data and needs no network. It shows what audit_json() has judged, and
/// judges nothing itself.
#pragma once

#include "audit/auditor.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace bin_scenes {

/// Returns the page with tables of `json` (from audit_json()), and a histogram of each measure from `figures`.
std::string audit_page(const std::string& name, const nlohmann::ordered_json& json, AuditFigures& figures);

}  // namespace bin_scenes
