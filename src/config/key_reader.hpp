/// A visitor that fills a struct from a YAML map and refuses unknown keys with a suggestion. It tests types only;
/// ranges are tested by RangeCheck (scene/range_check.hpp).
#pragma once

#include "bin_scenes/core/error.hpp"
#include "config/values.hpp"

#include <yaml-cpp/yaml.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace bin_scenes::config {

/// The origin of the values of a request, for error messages: a line of the file, or the option that overrides it.
class Source {
 public:
  /// @param overrides  maps the path of a key to the option that sets it, such as "--set path" or "--seconds"
  Source(std::string file, std::map<std::string, std::string> overrides)
      : file_(std::move(file)), overrides_(std::move(overrides)) {}

  void remember(const std::string& path, const YAML::Node& node);
  /// Returns where the value of a key comes from, such as "file:12" or "--set path". If the file does not contain
  /// `path`, the place of the nearest enclosing key is returned.
  std::string where(std::string path) const;
  bool knows(const std::string& path) const { return lines_.count(path) != 0 || overrides_.count(path) != 0; }

  /// From now on, errors of keys are added to `all` instead of being thrown, and reading continues after them.
  void collect(std::vector<Error>* all) { all_ = all; }
  /// Throws the error, or adds it to the list of collect().
  void complain(const Error& error) {
    if (!all_) throw error;
    all_->push_back(error);
  }

 private:
  std::vector<Error>* all_ = nullptr;
  std::string file_;
  std::map<std::string, std::string> overrides_;
  std::map<std::string, int> lines_;
};

/// Fills a struct with the values of the preset that its map names. Only sensors, surfaces and grippers have presets.
template <class Struct>
void start_from_preset(const YAML::Node&, const std::string&, const Source&, Struct&) {}
void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Sensor& sensor);
void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Surface& surface);
void start_from_preset(const YAML::Node& map, const std::string& path, const Source& source, Gripper& gripper);

/// Returns the map for an item of a list. For grippers, the item may be the name of a preset.
template <class Struct>
YAML::Node map_of(const YAML::Node& item, const Struct&) {
  return item;
}
inline YAML::Node map_of(const YAML::Node& item, const Gripper&) {
  if (!item.IsScalar()) return item;
  YAML::Node map;
  map["preset"] = item;
  return map;
}

class KeyReader {
 public:
  /// @param path  path of the map within the request, such as "", "solver.bullet" or "parts[2]"
  KeyReader(YAML::Node map, std::string path, Source& source);

  template <class Value>
  void field(const Key& key, Value& value) {
    if (const YAML::Node node = take(key)) {
      try {
        read_value(node, value);
      } catch (const Mismatch& mismatch) {
        const YAML::Node item = mismatch.item < node.size() && node.IsSequence() ? node[mismatch.item] : node;
        source_.complain(wrong_type(path_of(key.name) + mismatch.index(), mismatch.expected, item, mismatch.meant));
      }
    }
  }

  template <class Value>
  void field(const Key& key, std::optional<Value>& value) {
    Value read{};
    field(key, read);
    if (has(key.name)) value = read;
  }

  template <class Struct>
  void section(const Key& key, Struct& value) {
    const YAML::Node node = take(key);
    if (node && !node.IsNull()) read_map(node, path_of(key.name), value);
  }

  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    const YAML::Node node = take(key);
    if (!node || node.IsNull()) return;
    if (!node.IsSequence()) {
      source_.complain(wrong_type(path_of(key.name), "a list, in which each entry starts with '-'", node));
      return;
    }
    values.clear();
    for (std::size_t i = 0; i < node.size(); ++i) {
      values.emplace_back();
      const std::string path = path_of(key.name) + "[" + std::to_string(i) + "]";
      source_.remember(path, node[i]);
      read_map(map_of(node[i], values.back()), path, values.back());
    }
  }

  void bin_kind(Bin& bin, const BinKeys& keys);
  /// Returns the YAML node of a key, for values that no C++ type represents; undefined if the key is missing.
  YAML::Node node(const Key& key) { return take(key); }

  bool has(const std::string& name) const { return found_.count(name) != 0; }
  /// Reports each key of the map that no call has read, and suggests the nearest known key.
  void finish() const;

 private:
  YAML::Node take(const Key& key);
  std::string path_of(const std::string& name) const { return path_.empty() ? name : path_ + "." + name; }
  Error wrong_type(const std::string& path, const std::string& expected, const YAML::Node& node,
                   const std::string& meant = "") const;

  template <class Struct>
  void read_map(const YAML::Node& node, const std::string& path, Struct& value) {
    source_.remember(path, node);
    if (!node.IsMap()) {
      source_.complain(wrong_type(path, "a map of keys", node));
      return;
    }
    start_from_preset(node, path, source_, value);
    KeyReader reader(node, path, source_);
    visit(reader, value);
    reader.finish();
  }

  YAML::Node map_;
  std::string path_;
  Source& source_;
  std::vector<std::string> known_;
  std::set<std::string> found_;
};

}  // namespace bin_scenes::config
