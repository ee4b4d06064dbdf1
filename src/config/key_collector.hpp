/// A visitor that lists a table of keys as rows: path, type, default, unit and text of each key. The generated pages,
/// suggestions and completion are made of these rows.
#pragma once

#include "config/reference.hpp"
#include "scene/keys.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes::config {

/// @tparam Columns  has the functions kind(key, value) and value(key, value), which return the texts of two columns
template <class Columns>
class KeyCollector {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    add(key, Columns::kind(key, value), Columns::value(key, value));
  }
  template <class Value>
  void field(const Key& key, std::optional<Value>&) {
    Value value{};
    add(key, Columns::kind(key, value), "");
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    nested(key, "section", ".", value);
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>&) {
    Struct item;
    nested(key, "list", "[].", item);
  }
  template <class Struct>
  void list(const Key& key, std::optional<std::vector<Struct>>&) {
    Struct item;
    nested(key, "list", "[].", item);
  }
  void bin_kind(Bin&, const BinKeys&) {}

  std::vector<Entry> entries;

 private:
  void add(const Key& key, const std::string& kind, const std::string& value) {
    entries.push_back({prefix_ + key.name, kind, value, key.unit, key.text});
  }
  template <class Struct>
  void nested(const Key& key, const char* kind, const char* separator, Struct& value) {
    add(key, kind, "");
    const std::string outer = prefix_;
    prefix_ += key.name + std::string(separator);
    visit(*this, value);
    prefix_ = outer;
  }

  std::string prefix_;
};

}  // namespace bin_scenes::config
