#include "bin_scenes/output/trace.hpp"

#include "bin_scenes/core/error.hpp"
#include "output/trace_file.hpp"
#include "output/trace_lines.hpp"

#include <filesystem>

namespace bin_scenes {

namespace {

MessageTraceMaker& message_trace_maker() {
  static MessageTraceMaker maker;
  return maker;
}

}  // namespace

void register_message_trace(MessageTraceMaker maker) {
  message_trace_maker() = std::move(maker);
}

std::unique_ptr<Trace> open_trace(const std::string& path, const Request& request, McapProfile profile) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw environment_error("the trace cannot be written: it is a directory", path, "name a file for --trace");
  }
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  if (extension == ".jsonl") return std::make_unique<TraceLines>(path);
  if (extension != ".bag" && extension != ".mcap") return std::make_unique<TraceFile>(path);
  if (!message_trace_maker()) {
    throw environment_error("this build writes no messages of ROS", path,
                            "build with ROS, or name a .csv file for --trace");
  }
  return message_trace_maker()(path, request, profile);
}

}  // namespace bin_scenes
