/// Converts a request message to a request with the reader of request files (config/), so that keys, defaults, checks
/// and error messages are the same for both.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "messages.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// The fields that are set, then `set`, each as "key.path=value" in YAML. Throws an input Error for an optional field
/// with more than one value and for an unknown kind of bin.
std::vector<Override> overrides_from(const bin_scenes_msgs::SceneRequest& message);

/// Reads file or text with the overrides on top. Relative paths, also that of the file, are searched in each of
/// rules.roots; those of a file's models first in its folder. Throws an input Error, also if `file` lies outside of
/// rules.roots (unless that is empty: anywhere).
Request request_from(const bin_scenes_msgs::SceneRequest& message, const PathRules& rules);

/// Part lines alone, as of a request that has no others. Throws an input Error.
std::vector<PartLine> part_lines_from(const std::vector<bin_scenes_msgs::PartLine>& messages, const PathRules& rules);

}  // namespace bin_scenes
