/// Finds the file that a request names: beside the request, absolute, or in a ROS package. Links are resolved before
/// the roots are compared, and a missing file is answered with similar names.
#include "config/paths.hpp"

#include "bin_scenes/core/error.hpp"
#include "config/suggest.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace bin_scenes::config {

namespace fs = std::filesystem;

namespace {

/// Name a package.xml gives its package; "" if the directory holds none.
std::string package_name(const fs::path& directory) {
  std::ifstream file(directory / "package.xml");
  if (!file) return "";
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  static const std::regex name("<name>\\s*([^<\\s]+)\\s*</name>");
  std::smatch match;
  return std::regex_search(text, match, name) ? match[1].str() : "";
}

/// Depth-first search as rospack does it: not below a package, not into hidden or ignored directories.
fs::path find_below(const fs::path& directory, const std::string& package, int depth) {
  std::error_code ignored;
  if (fs::exists(directory / "CATKIN_IGNORE", ignored)) return {};
  const std::string name = package_name(directory);
  if (!name.empty()) return name == package ? directory : fs::path();
  if (depth == 0) return {};
  std::vector<fs::path> children;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(directory, fs::directory_options::skip_permission_denied, ignored)) {
    if (entry.is_directory(ignored) && entry.path().filename().string()[0] != '.') children.push_back(entry.path());
  }
  std::sort(children.begin(), children.end());  // the order of a directory is no order
  for (const fs::path& child : children) {
    const fs::path found = find_below(child, package, depth - 1);
    if (!found.empty()) return found;
  }
  return {};
}

fs::path find_package(const std::string& package, const PathRules& rules, const std::string& where) {
  if (rules.find_package) {
    const std::string folder = rules.find_package(package);
    if (folder.empty()) {
      throw input_error("rospack does not find the package '" + package + "'", where,
                        "source the workspace that has it before the node starts, or write a path");
    }
    return folder;
  }
  const char* variable = std::getenv("ROS_PACKAGE_PATH");
  std::vector<fs::path> roots;
  std::istringstream list(variable ? variable : "");
  for (std::string root; std::getline(list, root, ':');) {
    if (!root.empty()) roots.push_back(root);
  }
  for (const fs::path& root : roots) {  // the usual place first: a search of a whole installation takes its time
    if (package_name(root / package) == package) return root / package;
  }
  for (const fs::path& root : roots) {
    const fs::path found = find_below(root, package, 5);
    if (!found.empty()) return found;
  }
  throw input_error(
      "there is no package '" + package + "' on ROS_PACKAGE_PATH (" + (variable ? variable : "not set") + ")", where,
      "source the workspace that has it, or write a path");
}

bool lies_in(const fs::path& path, const fs::path& root) {
  const auto [mismatch, ignored] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return mismatch == root.end() || (std::next(mismatch) == root.end() && mismatch->empty());  // a trailing slash
}

/// Whether `real`, without symbolic links, lies in one of the roots.
bool allowed(const fs::path& real, const PathRules& rules) {
  return rules.roots.empty() || std::any_of(rules.roots.begin(), rules.roots.end(), [&](const std::string& root) {
           std::error_code ignored;
           return lies_in(real, fs::weakly_canonical(root, ignored));
         });
}

/// A relative path is of the file that it is written in; if nothing is there, of the first root that has it.
fs::path located(const fs::path& relative, const std::string& base, const PathRules& rules) {
  const auto usable = [&](const fs::path& path) {
    std::error_code ignored;  // outside the roots not even the existence of a file decides anything
    return allowed(fs::weakly_canonical(path, ignored), rules) && fs::exists(path, ignored);
  };
  const fs::path beside = fs::path(base) / relative;
  if (usable(beside)) return beside;
  for (const std::string& root : rules.roots)
    if (usable(fs::path(root) / relative)) return fs::path(root) / relative;
  return beside;
}

std::string listed(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + text;
  return all;
}

std::string similar_file(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(path.parent_path(), ignored)) {
    if (entry.is_regular_file(ignored)) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return nearest(path.filename().string(), names);
}

}  // namespace

std::string resolve_file(const std::string& written, const std::string& base, const PathRules& rules,
                         const std::string& where) {
  const std::string scheme = "package://";
  fs::path path = written;
  if (written.compare(0, scheme.size(), scheme) == 0) {
    const std::string rest = written.substr(scheme.size());
    const std::size_t slash = rest.find('/');
    if (slash == 0 || slash == std::string::npos || slash + 1 == rest.size()) {
      throw input_error("'" + written + "' does not name a file", where, "write package://name/path/to/file");
    }
    path = find_package(rest.substr(0, slash), rules, where) / rest.substr(slash + 1);
  } else if (path.is_relative()) {
    path = located(path, base, rules);
  }
  path = fs::absolute(path).lexically_normal();

  // Outside the roots not even the existence of a file is revealed.
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  if (error) throw input_error("cannot follow '" + path.string() + "': " + error.message(), where, "check the path");
  if (!allowed(real, rules)) {
    throw input_error("'" + written + "' is outside of " + rules.roots_name + " (" + listed(rules.roots) + ")", where,
                      "move it there, or add its folder to " + rules.roots_name);
  }
  if (!fs::exists(real, error)) {
    const std::string similar = similar_file(path);
    throw input_error("there is no file '" + path.string() + "'", where,
                      !similar.empty()      ? "did you mean '" + similar + "'?"
                      : rules.roots.empty() ? "relative paths start at the request's directory"
                                            : "relative paths start at the request file's folder or at one of " +
                                                  rules.roots_name + " (" + listed(rules.roots) + ")");
  }
  if (!fs::is_regular_file(real, error)) {
    throw input_error("'" + path.string() + "' is not a file", where, "name a file");
  }
  if (::access(path.c_str(), R_OK) != 0) {
    throw input_error("'" + path.string() + "' is not readable", where, "correct its permissions");
  }
  return path.string();
}

}  // namespace bin_scenes::config
