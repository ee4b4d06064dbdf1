#include "bin_scenes/output/trace.hpp"

#include "bin_scenes/core/error.hpp"
#include "output/trace_file.hpp"

#include <filesystem>

namespace bin_scenes {

namespace {

BagTraceMaker& bag_trace_maker() {
  static BagTraceMaker maker;
  return maker;
}

}  // namespace

void register_bag_trace(BagTraceMaker maker) {
  bag_trace_maker() = std::move(maker);
}

std::unique_ptr<Trace> open_trace(const std::string& path, const Request& request) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw environment_error("the trace cannot be written: it is a directory", path, "name a file for --trace");
  }
  if (std::filesystem::path(path).extension() != ".bag") return std::make_unique<TraceFile>(path);
  if (!bag_trace_maker())
    throw environment_error("this build knows no bags", path, "build with ROS, or name a .csv file for --trace");
  return bag_trace_maker()(path, request);
}

}  // namespace bin_scenes
