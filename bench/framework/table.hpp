/// Results as rows of named columns, and the CSV file they are kept in. Each column says what it is good for, so that
/// two files can be compared without knowing their benchmark.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace bin_scenes::bench {

enum class Role {
  key,      ///< names the row: part, solver, setting; equal keys are the same row of another run
  exact,    ///< the same on every run of the same code on the same class of device: counts, flags, hashes
  measure,  ///< median of several samples (runs, or seeds); its spread is the column `<name>_spread`
  spread,   ///< range (largest - smallest) of the samples of the measure before it; empty if there was one sample
  info      ///< for readers only, never compared
};
const char* name_of(Role role);

struct Column {
  std::string name;
  Role role;
};

/// One row under construction. Column names are snake_case with the unit at the end (scene_s, penetration_p95_rel);
/// an empty value is "not measured".
class Row {
 public:
  /// Name, value, name, value, ...: the keys of a row.
  template <class Value, class... More>
  static Row keys(const std::string& name, const Value& value, const More&... more) {
    if constexpr (sizeof...(more) == 0)
      return Row().key(name, value);
    else
      return Row().key(name, value).append(keys(more...));
  }
  template <class Value>
  Row& key(const std::string& name, const Value& value) {
    return add({name, Role::key}, text(value));
  }
  template <class Value>
  Row& exact(const std::string& name, const Value& value) {
    return add({name, Role::exact}, text(value));
  }
  template <class Value>
  Row& info(const std::string& name, const Value& value) {
    return add({name, Role::info}, text(value));
  }
  /// Median and range of the samples; none: both empty.
  Row& measure(const std::string& name, const std::vector<double>& samples);
  Row& measure(const std::string& name, double sample) { return measure(name, std::vector<double>{sample}); }
  /// Why the row has no figures: "not built", "time budget spent", an error's text. Empty (the default) is a good row.
  Row& status(const std::string& why) { return info("status", why); }
  /// Appends the other row's cells.
  Row& append(const Row& other);

  Row& add(const Column& column, const std::string& value);  ///< sets the value of a column that is there already
  const std::vector<std::pair<Column, std::string>>& cells() const { return cells_; }
  std::string at(const std::string& name) const;  ///< "" if there is no such column
  double number(const std::string& name) const;   ///< NaN if it is not a number

  static std::string text(double value);  ///< seven digits; NaN is empty
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  static std::string text(Integer value) {
    return std::to_string(value);
  }
  static std::string text(bool value) { return value ? "yes" : "no"; }
  static std::string text(const std::string& value) { return value; }
  static std::string text(const char* value) { return value; }

 private:
  std::vector<std::pair<Column, std::string>> cells_;
};

/// Rows with the union of their columns, in order of first appearance, below a block of `# key: value` lines.
struct Table {
  std::vector<std::pair<std::string, std::string>> header;  ///< benchmark, command, device, driver, commit, ...
  std::vector<Column> columns;
  std::vector<std::map<std::string, std::string>> rows;

  /// A row with the keys of an earlier one takes its place.
  void add(const Row& row);
  Row row(std::size_t index) const;
  /// "part=ring_24 solver=sphere": what names a row.
  std::string key_of(std::size_t row) const;
};

/// RFC 4180 below the header block; column roles are one of the `#` lines.
std::string to_csv(const Table& table);
Table from_csv(const std::string& text, const std::string& where);  ///< throws an input Error naming `where` and line

Table read_csv(const std::string& path);

}  // namespace bin_scenes::bench
