/// Rows, tables and their CSV files. A file begins with comments: facts of the machine, and the role of each column.
#include "framework/table.hpp"

#include "bin_scenes/core/error.hpp"
#include "framework/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

namespace bin_scenes::bench {

namespace {

constexpr std::pair<Role, const char*> role_names[] = {{Role::key, "key"},
                                                       {Role::exact, "exact"},
                                                       {Role::measure, "measure"},
                                                       {Role::spread, "spread"},
                                                       {Role::info, "info"}};

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\n") == std::string::npos) return field;
  std::string out = "\"";
  for (const char c : field) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\t' ? ' ' : c;  // one row, one line: gnuplot and awk read these files too
  }
  return out + '"';
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (inside && i + 1 < line.size() && line[i + 1] == '"')
        fields.back() += line[++i];
      else
        inside = !inside;
    } else if (line[i] == ',' && !inside) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

double number_of(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return text.empty() || *end != '\0' ? std::numeric_limits<double>::quiet_NaN() : value;
}

}  // namespace

const char* name_of(Role role) {
  for (const auto& [r, name] : role_names)
    if (r == role) return name;
  return "";
}

std::string Row::text(double value) {
  if (std::isnan(value)) return "";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.7g", value);
  return buffer;
}

Row& Row::add(const Column& column, const std::string& value) {
  for (auto& [known, old] : cells_) {
    if (known.name == column.name) {
      old = value;
      return *this;
    }
  }
  cells_.emplace_back(column, value);
  return *this;
}

Row& Row::measure(const std::string& name, const std::vector<double>& samples) {
  add({name, Role::measure}, samples.empty() ? "" : text(median(samples)));
  return add({name + "_spread", Role::spread}, samples.size() < 2 ? "" : text(range(samples)));
}

Row& Row::append(const Row& other) {
  for (const auto& [column, value] : other.cells_) add(column, value);
  return *this;
}

std::string Row::at(const std::string& name) const {
  for (const auto& [column, value] : cells_)
    if (column.name == name) return value;
  return "";
}

double Row::number(const std::string& name) const {
  return number_of(at(name));
}

void Table::add(const Row& row) {
  rows.emplace_back();
  for (const auto& [column, value] : row.cells()) {
    const auto known =
        std::find_if(columns.begin(), columns.end(), [&c = column](const Column& k) { return k.name == c.name; });
    if (known == columns.end()) columns.push_back(column);
    rows.back()[column.name] = value;
  }
  const std::string key = key_of(rows.size() - 1);
  for (std::size_t r = 0; r + 1 < rows.size() && !key.empty(); ++r) {
    if (key_of(r) != key) continue;
    rows[r] = std::move(rows.back());
    rows.pop_back();
    return;
  }
}

Row Table::row(std::size_t index) const {
  Row out;
  for (const Column& column : columns) {
    const auto value = rows[index].find(column.name);
    if (value != rows[index].end()) out.add(column, value->second);
  }
  return out;
}

std::string Table::key_of(std::size_t row) const {
  std::string key;
  for (const Column& column : columns) {
    if (column.role != Role::key) continue;
    const auto value = rows[row].find(column.name);
    if (value == rows[row].end() || value->second.empty()) continue;
    key += (key.empty() ? "" : " ") + column.name + "=" + value->second;
  }
  return key;
}

std::string to_csv(const Table& table) {
  std::string out;
  for (const auto& [key, value] : table.header) out += "# " + key + ": " + value + "\n";
  std::string roles, names;
  for (const Column& column : table.columns) {
    roles += std::string(roles.empty() ? "" : " ") + name_of(column.role);
    names += (names.empty() ? "" : ",") + quoted(column.name);
  }
  out += "# roles: " + roles + "\n" + names + "\n";
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const auto value = row.find(table.columns[c].name);
      out += (c ? "," : "") + (value == row.end() ? "" : quoted(value->second));
    }
    out += "\n";
  }
  return out;
}

Table from_csv(const std::string& text, const std::string& where) {
  Table table;
  std::vector<Role> roles;
  std::size_t number = 0;
  const auto fail = [&](const std::string& what) {
    return input_error(what, where + ":" + std::to_string(number), "make the file again with bin_scenes_bench");
  };
  const auto role_of = [&](const std::string& word) {
    for (const auto& [role, name] : role_names)
      if (word == name) return role;
    throw fail("unknown role '" + word + "' of a column");
  };
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (const std::size_t colon = line.find(": "); line.rfind("# ", 0) == 0) {
      if (colon == std::string::npos) continue;
      table.header.emplace_back(line.substr(2, colon - 2), line.substr(colon + 2));
      if (table.header.back().first != "roles") continue;
      std::istringstream words(table.header.back().second);
      for (std::string word; words >> word;) roles.push_back(role_of(word));
      table.header.pop_back();
    } else if (const std::vector<std::string> fields = fields_of(line); table.columns.empty() && !line.empty()) {
      if (fields.size() != roles.size()) throw fail("as many roles as columns are needed above the column names");
      for (std::size_t c = 0; c < fields.size(); ++c) table.columns.push_back({fields[c], roles[c]});
    } else if (!line.empty()) {
      if (fields.size() != table.columns.size())
        throw fail(std::to_string(fields.size()) + " fields in a table of " + std::to_string(table.columns.size()) +
                   " columns");
      table.rows.emplace_back();
      for (std::size_t c = 0; c < fields.size(); ++c) table.rows.back()[table.columns[c].name] = fields[c];
    }
  }
  if (table.columns.empty()) throw fail("no column names");
  return table;
}

Table read_csv(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw input_error("cannot be read", path, "give a CSV file, or a folder of them, of bin_scenes_bench");
  return from_csv({std::istreambuf_iterator<char>(file), {}}, path);
}

}  // namespace bin_scenes::bench
