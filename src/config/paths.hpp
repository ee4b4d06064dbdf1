/// Resolves a path of a request, which may be relative or a package:// path, to a file inside the permitted folders. It
/// is the only place that decides which files a request may name.
#pragma once

#include "bin_scenes/config/request_reader.hpp"

#include <string>

namespace bin_scenes::config {

/// Returns the absolute path of `written`, which is absolute, relative to `base` or to one of rules.roots, or
/// package://name/path. The file must be readable and, after symbolic links are resolved, be inside one of rules.roots.
/// Throws an input Error at `where` otherwise.
std::string resolve_file(const std::string& written, const std::string& base, const PathRules& rules,
                         const std::string& where);

}  // namespace bin_scenes::config
