/// Reads a request from a parsed YAML document, for readers of files in which a request is one part among others, such
/// as plans. Files that are a request only are read by config/request_reader.hpp.
#pragma once

#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

namespace bin_scenes::config {

/// @param root  is changed by the overrides
/// @param file, base  for messages, and what relative paths start at
/// @param all  takes the errors of all keys, with their lines; the request is then not usable. Without it, the first
///             error of a key is thrown; errors of other kinds are always thrown.
Request read_document(YAML::Node root, const std::string& file, const std::string& base,
                      const std::vector<Override>& overrides, const PathRules& rules,
                      std::vector<Error>* all = nullptr);

/// For digests, which depend on the contents of the files of bins and lamps, but not on their paths.
Request without_places(Request request);
/// Returns the digests of the pictures of lamps.
std::string digests_of_pictures(const Request& request);

}  // namespace bin_scenes::config
