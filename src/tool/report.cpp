#include "page/report.hpp"

#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"

#include <cstdio>

namespace bin_scenes {

int report(const ReportOptions& options) {
  const std::string path = options.out.empty() ? options.directory + "/report.html" : options.out;
  ProgressBar bar;
  bar.stage(0.0, 1.0, "reading the data set");
  const ReportResult result = write_report(options.directory, path);
  bar.clear();
  std::printf("%s: %zu scenes, %zu pictures, %.1f MB\n", path.c_str(), result.scenes, result.pictures,
              static_cast<double>(result.bytes) / 1e6);
  if (!result.in_3d)
    std::fprintf(
        stderr,
        "bin_scenes: no 3-D view, since three.js was not found (install libjs-three, and make the report again)\n");
  return exit_done;
}

}  // namespace bin_scenes
