/// Returns all keys of a request as rows. docs/use/request.md, suggestions for unknown keys and completion use them.
#pragma once

#include <string>
#include <vector>

namespace bin_scenes::config {

struct Entry {
  std::string path;   ///< path of the key, such as "parts[].count"
  std::string kind;   ///< the type of a value; "section" or "list" for a heading
  std::string value;  ///< the default; "": there is none
  std::string unit, text;
};

/// Returns all keys in the order of the tables. The list is made at the first call.
const std::vector<Entry>& reference();

/// Returns Markdown text: a table of the top-level keys, then a chapter for each section and list.
/// @param defaults  whether the tables have a column of defaults
std::string key_chapters(const std::vector<Entry>& entries, bool defaults);

}  // namespace bin_scenes::config
