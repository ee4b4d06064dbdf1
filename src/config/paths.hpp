/// Resolves a path of a request, which may be relative or a package:// path, to a file inside the permitted folders. It
/// is the only place that decides which files a request may name.
#pragma once

#include "bin_scenes/config/request_reader.hpp"

#include <string>

namespace bin_scenes::config {

/// Absolute path of `written`: relative to `base` or else to one of rules.roots, absolute, or package://name/path. The
/// file must exist, be readable and, symbolic links resolved, lie in one of rules.roots. Throws an input Error with
/// `where`.
std::string resolve_file(const std::string& written, const std::string& base, const PathRules& rules,
                         const std::string& where);

}  // namespace bin_scenes::config
