/// Parses YAML text to a document. Time and memory are bounded by the length of the text, whatever it contains, because
/// the ROS node accepts requests from others.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <string>

namespace bin_scenes::config {

constexpr std::size_t longest_text = std::size_t{256} << 20;  ///< bytes; twice the text of a million given poses

/// Parses a text that contains one document; an empty text gives a null node. Throws an input Error with file and line
/// if the text is not YAML, has several documents, is longer than longest_text, or if its aliases expand to far more
/// values than the text contains. Throws Error(cancelled) if the work of this thread is cancelled.
YAML::Node load_yaml(const std::string& text, const std::string& file);

}  // namespace bin_scenes::config
