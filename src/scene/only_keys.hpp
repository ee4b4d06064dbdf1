/// A visitor that forwards only some keys of a table. scene.json describes bin, models and sensors with entries of the
/// request's tables in this way, so that each key is described once.
#pragma once

#include "bin_scenes/scene/key.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

namespace bin_scenes {

template <class Visitor>
class OnlyKeys {
 public:
  /// @param written  false: the keys are not written, even if the table marks them as written
  OnlyKeys(Visitor& visitor, std::initializer_list<std::string> names, bool written = true)
      : visitor_(visitor), names_(names), written_(written) {}

  template <class Value>
  void field(Key key, Value& value) {
    if (has(key)) visitor_.field(key, value);
  }
  template <class Struct>
  void section(Key key, Struct& value) {
    if (has(key)) visitor_.section(key, value);
  }
  template <class Struct>
  void list(Key key, std::vector<Struct>& values) {
    if (has(key)) visitor_.list(key, values);
  }
  template <class Bin, class Keys>
  void bin_kind(Bin&, const Keys&) {}

 private:
  bool has(Key& key) const {
    key.written = key.written && written_;
    return std::find(names_.begin(), names_.end(), key.name) != names_.end();
  }

  Visitor& visitor_;
  std::vector<std::string> names_;
  bool written_;
};

/// Visits the keys of `names` in the table of `value`.
template <class Visitor, class Struct>
void visit_only(Visitor& v, std::initializer_list<std::string> names, Struct& value, bool written = true) {
  OnlyKeys<Visitor> keys(v, names, written);
  visit(keys, value);
}

}  // namespace bin_scenes
