/// Reads JSON files of a data set that may be damaged. A file that is missing or is no JSON map gives an empty result
/// instead of an exception, so that the checks of a data set can report it and continue.
#pragma once

#include "core/read_file.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>

namespace bin_scenes {

/// Returns the JSON map in a file; none if it is missing or damaged. @tparam Json  nlohmann::json or ordered_json
template <class Json>
std::optional<Json> json_map_in(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  Json json = Json::parse(read_file(path.string()), nullptr, false);
  return json.is_object() ? std::optional<Json>(std::move(json)) : std::nullopt;
}

}  // namespace bin_scenes
