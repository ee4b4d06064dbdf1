/// Where a figure was measured.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bin_scenes::bench {

/// cpu, cores, gl (GL_RENDERER), driver (GL_VERSION), version, commit, date, as `# key: value` lines of a table.
std::vector<std::pair<std::string, std::string>> host();

/// Of the sources this was built from; "-dirty" with changes that are not committed.
std::string commit();

/// Whether GL has hardware of its own.
bool has_gpu();

/// Name for the folder of results: GL device if it is hardware, else the CPU, in letters, digits and '-'.
std::string device_slug();

}  // namespace bin_scenes::bench
