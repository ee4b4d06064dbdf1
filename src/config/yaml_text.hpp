/// Parses YAML text to a document. Time and memory are bounded by the length of the text, whatever it contains, because
/// the ROS node accepts requests from others.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>

namespace bin_scenes::config {

constexpr std::size_t longest_text = std::size_t{256} << 20;  ///< bytes; a million given poses have half as many

/// The one document of a text; a null node if it holds none. Throws an input Error with file and line: no YAML, several
/// documents or something behind the first, longer than longest_text, aliases that stand for far more values than the
/// text has. Throws Error(cancelled) while it reads.
YAML::Node load_yaml(const std::string& text, const std::string& file);

}  // namespace bin_scenes::config
