/// Writes the page of an audit as one file that needs no network.
#pragma once

#include "audit/auditor.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace bin_scenes {

/// Tables of `json` (audit_json()), and a histogram of each measure.
std::string audit_page(const std::string& name, const nlohmann::ordered_json& json, AuditFigures& figures);

}  // namespace bin_scenes
