/// Returns all keys of a request as rows. docs/use/request.md, suggestions for unknown keys and completion use them.
#pragma once

#include <string>
#include <vector>

namespace bin_scenes::config {

struct Entry {
  std::string path;   ///< "parts[].count"; the path of a section or list itself for its heading
  std::string kind;   ///< the type of a value; "section" or "list" for a heading
  std::string value;  ///< the default; "" if left out means none
  std::string unit, text;
};

/// Every key in the order of the table, made once.
const std::vector<Entry>& reference();

/// Markdown: a table of the outermost keys, then a chapter for each section and list.
/// @param defaults  whether the tables have a column of defaults
std::string key_chapters(const std::vector<Entry>& entries, bool defaults);

}  // namespace bin_scenes::config
