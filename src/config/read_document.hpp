/// Reads a request from a parsed YAML document, for readers of files in which a request is one part among others, such
/// as plans. Files that are a request only are read by config/request_reader.hpp.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

namespace bin_scenes::config {

/// @param root  the parsed document, to which the overrides are applied
/// @param file, base  name of the file for error messages, and the folder to which relative paths refer
/// @param all  if given, the errors of all keys are added to it with their lines, and the result is not usable then.
///             Otherwise the first error of a key is thrown. Errors of other kinds are always thrown.
Request read_document(YAML::Node root, const std::string& file, const std::string& base,
                      const std::vector<Override>& overrides, const PathRules& rules,
                      std::vector<Error>* all = nullptr);

/// Returns the request without the paths of the files of bins and lamps, for digests that must not depend on them.
Request without_places(Request request);
/// Returns the digests of the image files of lamps.
std::string digests_of_pictures(const Request& request);

}  // namespace bin_scenes::config
