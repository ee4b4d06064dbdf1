/// Converts a request message to a request with the reader of request files (config/), so that keys, defaults, checks
/// and error messages are the same for both.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "messages.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// Returns the fields that are set, then those of `set`, each as "key.path=value" in YAML. Throws an input Error for an
/// optional field with more than one value, and for an unknown kind of bin.
std::vector<Override> overrides_from(const bin_scenes_msgs::SceneRequest& message);

/// Reads the file or the text of a message, and applies its other fields as overrides. Relative paths are searched in
/// each of rules.roots; paths in a file are first searched in the folder of the file. Throws an input Error, also if
/// `file` is outside of rules.roots; if rules.roots is empty, every file is permitted.
Request request_from(const bin_scenes_msgs::SceneRequest& message, const PathRules& rules);

/// Reads the part lines of a message that contains nothing else of a request. Throws an input Error.
std::vector<PartLine> part_lines_from(const std::vector<bin_scenes_msgs::PartLine>& messages, const PathRules& rules);

}  // namespace bin_scenes
