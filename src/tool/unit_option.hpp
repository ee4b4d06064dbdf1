/// The option --unit, which several commands share. It converts the text of the option to a Unit and refuses other
/// texts.
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/scene/request.hpp"
#include "scene/keys.hpp"

#include <optional>
#include <string>

namespace bin_scenes {

/// Returns the unit that the option states; empty if the option was not given.
inline std::optional<Unit> unit_given(const std::string& text) {
  if (text.empty()) return std::nullopt;
  for (const auto& [name, unit] : names(Unit{}))
    if (text == name) return unit;
  throw input_error("unknown unit '" + text + "'", "--unit", "m, cm, mm or inch");
}

}  // namespace bin_scenes
