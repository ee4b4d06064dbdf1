/// Rows of two results that moved beyond their noise. What a column says, its role decides (table.hpp).
#include "framework/compare.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

namespace bin_scenes::bench {

namespace {

namespace fs = std::filesystem;

constexpr double noise_of_one_sample = 0.25;  ///< range / value that is assumed where nothing was repeated

using Cells = std::map<std::string, std::string>;

std::string cell(const Cells& row, const std::string& name) {
  const auto found = row.find(name);
  return found == row.end() ? "" : found->second;
}

struct Measured {
  bool there = false, repeated = false;
  double value = 0.0, range = 0.0;
  std::string text;
};

Measured measured(const Cells& row, const std::string& name) {
  Measured m;
  const std::string value = cell(row, name), spread = cell(row, name + "_spread");
  m.there = !value.empty();
  m.repeated = !spread.empty();
  m.value = std::atof(value.c_str());
  m.range = m.repeated ? std::atof(spread.c_str()) : noise_of_one_sample * std::abs(m.value);
  m.text = value + (m.repeated ? " (range " + spread + ")" : "");
  return m;
}

void compare_rows(const Table& before, const Cells& a, const Cells& b, const std::string& key, double floor,
                  Comparison& out) {
  const std::string benchmark = before.header_value("benchmark");
  for (const Column& column : before.columns) {
    Move move{benchmark, key, column.name, "", "", std::numeric_limits<double>::quiet_NaN()};
    bool moved = false;
    if (column.role == Role::exact) {
      move.before = cell(a, column.name);
      move.after = cell(b, column.name);
      moved = move.before != move.after;
    } else if (column.role == Role::measure) {
      const Measured x = measured(a, column.name), y = measured(b, column.name);
      if (!x.there && !y.there) continue;
      const double difference = std::abs(y.value - x.value), largest = std::max(std::abs(x.value), std::abs(y.value));
      moved = x.there != y.there || (difference > 0.5 * (x.range + y.range) && difference > floor * largest);
      move.before = x.there ? x.text : "not measured";
      move.after = y.there ? y.text : "not measured";
      if (x.there && y.there && x.value != 0.0) move.change = (y.value - x.value) / std::abs(x.value);
    } else {
      continue;
    }
    ++out.values;
    if (moved) out.moved.push_back(move);
  }
}

void merge(Comparison& all, const Comparison& one) {
  all.rows += one.rows;
  all.values += one.values;
  all.moved.insert(all.moved.end(), one.moved.begin(), one.moved.end());
  all.only_before.insert(all.only_before.end(), one.only_before.begin(), one.only_before.end());
  all.only_after.insert(all.only_after.end(), one.only_after.begin(), one.only_after.end());
  for (const std::string& note : one.notes)  // the same machine stands in every file of a folder
    if (std::find(all.notes.begin(), all.notes.end(), note) == all.notes.end()) all.notes.push_back(note);
}

/// CSV files by name; the path itself if it is a file, under an empty name.
std::map<std::string, std::string> tables_at(const std::string& path) {
  if (fs::is_regular_file(path)) return {{"", path}};
  if (!fs::is_directory(path))
    throw input_error("neither a file nor a folder", path, "give two CSV files or two folders of them");
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.path().extension() == ".csv") files[entry.path().filename()] = entry.path();
  return files;
}

}  // namespace

Comparison compare(const Table& before, const Table& after, double floor) {
  Comparison out;
  for (const char* what : {"cpu", "gl", "driver", "quick"}) {
    const std::string a = before.header_value(what), b = after.header_value(what);
    if (a != b) out.notes.push_back(std::string(what) + " differs: '" + a + "' and '" + b + "'");
  }
  const std::string benchmark = before.header_value("benchmark") + ": ";
  std::map<std::string, std::size_t> rows_after;
  for (std::size_t r = 0; r < after.rows.size(); ++r) rows_after[after.key_of(r)] = r;
  for (std::size_t r = 0; r < before.rows.size(); ++r) {
    const std::string key = before.key_of(r);
    const auto match = rows_after.find(key);
    if (match == rows_after.end()) {
      out.only_before.push_back(benchmark + key);
      continue;
    }
    ++out.rows;
    compare_rows(before, before.rows[r], after.rows[match->second], key, floor, out);
    rows_after.erase(match);
  }
  for (const auto& [key, row] : rows_after) out.only_after.push_back(benchmark + key);
  return out;
}

Comparison compare_paths(const std::string& before, const std::string& after, double floor) {
  const auto a = tables_at(before), b = tables_at(after);
  Comparison all;
  bool any = false;
  for (const auto& [name, path] : a) {
    const auto other = b.find(name);
    if (other == b.end()) {
      all.notes.push_back(name + " is in " + before + " only");
      continue;
    }
    any = true;
    merge(all, compare(read_csv(path), read_csv(other->second), floor));
  }
  for (const auto& [name, path] : b)
    if (a.count(name) == 0) all.notes.push_back(name + " is in " + after + " only");
  if (!any)
    throw input_error("no CSV file is in both", before + " and " + after,
                      "give two folders that bin_scenes_bench wrote");
  return all;
}

std::string to_text(const Comparison& comparison) {
  std::ostringstream out;
  for (const std::string& note : comparison.notes) out << "note: " << note << "\n";
  for (const std::string& row : comparison.only_before) out << "gone: " << row << "\n";
  for (const std::string& row : comparison.only_after) out << "new:  " << row << "\n";
  for (const Move& move : comparison.moved) {
    out << "moved: " << move.benchmark << ": " << move.key << ": " << move.column << " " << move.before << " -> "
        << move.after;
    char change[32];
    std::snprintf(change, sizeof change, " (%+.1f %%)", 100.0 * move.change);
    if (!std::isnan(move.change)) out << change;
    out << "\n";
  }
  out << comparison.moved.size() << " of " << comparison.values << " values in " << comparison.rows
      << " rows moved beyond noise\n";
  return out.str();
}

}  // namespace bin_scenes::bench
