/// Writes the report of a data set as one HTML page: statistics of its scenes, the plan, and pictures of some scenes.
/// The page contains all of its data and can be opened from the disk without a network. It only reads the data set.
#pragma once

#include <string>

namespace bin_scenes {

struct ReportResult {
  std::size_t bytes = 0, scenes = 0, pictures = 0;
  bool in_3d = false;  ///< whether three.js was available, so that the report has 3-D views
};

/// Reads index, plan and some scenes of a data set, and writes a page of at most 5 MB to `path`. Throws Error.
ReportResult write_report(const std::string& directory, const std::string& path);

}  // namespace bin_scenes
