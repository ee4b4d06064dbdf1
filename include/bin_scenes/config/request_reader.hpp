/// Converts YAML to Request and back. An unknown key is an error that suggests the nearest known one.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// Where model paths may lie. The ROS node sets it.
struct PathRules {
  std::vector<std::string> roots;        ///< empty: anywhere (command line)
  std::string roots_name = "the roots";  ///< what the user calls them, for messages
  /// Folder of a package for package://, "" if there is none; unset: found on ROS_PACKAGE_PATH.
  std::function<std::string(const std::string& name)> find_package;
};

/// "path.to.key=value", as given to --set or by an option that stands for a key.
struct Override {
  std::string assignment;
  std::string origin;  ///< what the user wrote, for messages: "--seconds"; empty: --set

  Override(std::string text, std::string given_by = "") : assignment(std::move(text)), origin(std::move(given_by)) {}
  Override(const char* text) : assignment(text) {}
};

/// Throws an input Error with file, line and key.
Request read_request(const std::string& path, const std::vector<Override>& overrides = {}, const PathRules& rules = {});
Request read_request_text(const std::string& yaml, const std::string& base_directory,
                          const std::vector<Override>& overrides = {}, const PathRules& rules = {});

/// YAML with every key and its value, which read_request_text() reads back.
std::string write_request(const Request& request);

/// SHA-256 of what decides the scenes of a request: every key but `scenes` and `first`, and the bytes of its models
/// and of its lamps' pictures, by the digests that the reader filled in.
/// Two scenes with the same index and hash are the same scene.
std::string request_hash(const Request& request);

/// docs/use/request.md: every key with type, default, unit and consequence.
std::string request_reference();
/// JSON schema (draft 7) of a request file, for editors. Rules that involve several keys are not part of it.
std::string request_json_schema();

}  // namespace bin_scenes
