/// Two visitors of a table of keys: one writes a struct as JSON, and the other reads it back. They serve scene.json and
/// its report; requests are YAML (key_reader.hpp).
#pragma once

#include "scene/keys.hpp"
#include "scene/report_keys.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace bin_scenes::config {

using Json = nlohmann::ordered_json;

/// An error in a file: what is wrong, and at which key.
struct JsonFault {
  std::string path, problem;
};

Json json_of(const Vec3& v);
Json json_of(const Pose& pose);    ///< {position, orientation_xyzw}; null if it is not finite
Json json_of(const Twist& twist);  ///< {linear, angular}
Json json_of(const Hexadecimal& number);
template <class Value>
Json json_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>)
    return name_in_table(value);
  else if constexpr (std::is_same_v<Value, Word>)
    return value.value;
  else
    return value;
}
template <class Item>
Json json_of(const std::vector<Item>& items) {
  Json list = Json::array();
  for (const Item& item : items) list.push_back(json_of(item));
  return list;
}

class JsonWriter {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    if (key.written) json[key.name] = json_of(value);
  }
  template <class Value>
  void field(const Key& key, std::optional<Value>& value) {
    if (value) field(key, *value);
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    if (key.written) json[key.name] = object(value);
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    if (!key.written) return;
    Json& items = json[key.name] = Json::array();
    for (Struct& value : values) items.push_back(object(value));
  }
  template <class Struct>
  void list(const Key& key, std::optional<std::vector<Struct>>& values) {
    if (values) list(key, *values);
  }
  void bin_kind(Bin&, const BinKeys&) {}

  template <class Struct>
  static Json object(Struct& value) {
    JsonWriter writer;
    visit(writer, value);
    return std::move(writer.json);
  }

  Json json = Json::object();
};

// Each function throws a JsonFault at `path` if the value has another type.
void read_json(const Json& json, const std::string& path, bool& value);
void read_json(const Json& json, const std::string& path, int& value);
void read_json(const Json& json, const std::string& path, std::uint64_t& value);
void read_json(const Json& json, const std::string& path, double& value);  ///< null is read as NaN
void read_json(const Json& json, const std::string& path, std::string& value);
void read_json(const Json& json, const std::string& path, Vec3& value);
void read_json(const Json& json, const std::string& path, Pose& value);  ///< null is read as Pose::none()
void read_json(const Json& json, const std::string& path, Twist& value);
void read_json(const Json& json, const std::string& path, Word& value);  ///< accepts any word, also an unknown one
void read_json(const Json& json, const std::string& path, Hexadecimal& value);
/// Throws a JsonFault unless `json` is a list. If `size` is given, the list must have this number of items.
void expect_list(const Json& json, const std::string& path, std::optional<std::size_t> size = {});
void expect_map(const Json& json, const std::string& path);

inline std::string item_of(const std::string& path, std::size_t i) {
  return path + "[" + std::to_string(i) + "]";
}
template <class Item>
void read_json(const Json& json, const std::string& path, std::vector<Item>& values) {
  expect_list(json, path);
  values.resize(json.size());
  for (std::size_t i = 0; i < values.size(); ++i) read_json(json[i], item_of(path, i), values[i]);
}
template <class Item, std::size_t size>
void read_json(const Json& json, const std::string& path, std::array<Item, size>& values) {
  expect_list(json, path, size);
  for (std::size_t i = 0; i < size; ++i) read_json(json[i], item_of(path, i), values[i]);
}
template <class Item>
void read_json(const Json& json, const std::string& path, std::map<std::string, Item>& values) {
  expect_map(json, path);
  values.clear();
  for (const auto& [name, value] : json.items()) read_json(value, path + "." + name, values[name]);
}
template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
void read_json(const Json& json, const std::string& path, Enum& value) {
  std::string text, known;
  read_json(json, path, text);
  for (const auto& [name, meaning] : names(Enum{})) {
    if (text == name) return void(value = meaning);
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw JsonFault{path, "'" + text + "' is none of " + known};
}

/// Sets the members that say that a section is present in the file; for example, a section `drift` was measured.
template <class Struct>
void was_there(Struct&) {}
inline void was_there(DriftReport& drift) {
  drift.measured = true;
}

class JsonReader {
 public:
  /// @param strict  true: every key that the writer writes must exist; false: only keys without a default must exist
  JsonReader(const Json& json, std::string path, bool strict) : json_(json), path_(std::move(path)), strict_(strict) {
    expect_map(json, path_);
  }

  template <class Value>
  void field(const Key& key, Value& value) {
    if (const Json* item = find(key, strict_ && key.written)) read_json(*item, path_of(key), value);
  }
  template <class Value>
  void field(const Key& key, std::optional<Value>& value) {
    if (const Json* item = find(key, false)) read_json(*item, path_of(key), value.emplace());
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    const Json* item = find(key, strict_ && key.written);
    if (!item) return;
    read(*item, path_of(key), value);
    was_there(value);
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    const Json* items = find(key, strict_ && key.written);
    if (!items) return;
    expect_list(*items, path_of(key));
    values.assign(items->size(), Struct());
    for (std::size_t i = 0; i < values.size(); ++i) read((*items)[i], item_of(path_of(key), i), values[i]);
  }
  template <class Struct>
  void list(const Key& key, std::optional<std::vector<Struct>>& values) {
    if (find(key, false)) list(key, values.emplace());
  }
  void bin_kind(Bin& bin, const BinKeys&);

 private:
  template <class Struct>
  void read(const Json& json, const std::string& path, Struct& value) const {
    JsonReader reader(json, path, strict_ && !std::is_same_v<Struct, Report>);
    visit(reader, value);
  }
  std::string path_of(const Key& key) const { return path_.empty() ? key.name : path_ + "." + key.name; }
  const Json* find(const Key& key, bool needed) const;

  const Json& json_;
  std::string path_;
  bool strict_;
};

}  // namespace bin_scenes::config
