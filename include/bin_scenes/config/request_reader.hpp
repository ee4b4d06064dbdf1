/// Converts the YAML text of a request to the struct Request and back, and generates the pages that describe its keys.
/// An unknown key is an error that suggests the nearest known key. Model files are located and hashed but not loaded;
/// mesh/mesh_loader.hpp loads them.
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

/// Where model files may be located. The ROS node sets these rules for requests from its clients.
struct PathRules {
  /// Folders that must contain the files; empty: files may be anywhere, as for the command line.
  std::vector<std::string> roots;
  std::string roots_name = "the roots";  ///< name of these folders in error messages, as the user knows them
  /// Returns the folder of a ROS package for package:// paths, or "" if it does not exist. If this function is not set,
  /// packages are found on ROS_PACKAGE_PATH.
  std::function<std::string(const std::string& name)> find_package;
};

/// One assignment "path.to.key=value" that overrides the request file, as given to --set or by an option that stands
/// for a key.
struct Override {
  std::string assignment;
  std::string origin;  ///< what the user wrote, for error messages, for example "--seconds"; empty means --set

  Override(std::string text, std::string given_by = "") : assignment(std::move(text)), origin(std::move(given_by)) {}
  Override(const char* text) : assignment(text) {}
};

/// Read a request from a file, or from a text with the folder to which its paths are relative. Throw an input Error
/// that names file, line and key.
Request read_request(const std::string& path, const std::vector<Override>& overrides = {}, const PathRules& rules = {});
Request read_request_text(const std::string& yaml, const std::string& base_directory,
                          const std::vector<Override>& overrides = {}, const PathRules& rules = {});

/// Returns YAML text with every key and its value. read_request_text() reads it back to the same request.
std::string write_request(const Request& request);

/// Returns the SHA-256 digest of everything that determines the scenes of a request: every key except `scenes` and
/// `first`, and the bytes of the models and of the lamps' pictures, by the digests that the reader filled in. Two
/// scenes with the same index and digest are the same scene.
std::string request_hash(const Request& request);

/// Returns the text of docs/use/request.md, which lists every key with its type, default, unit and consequence.
std::string request_reference();
/// Returns a JSON schema (draft 7) of request files, for editors. The schema does not contain rules that involve
/// several keys.
std::string request_json_schema();

}  // namespace bin_scenes
