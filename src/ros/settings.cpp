#include "settings.hpp"

#include "bin_scenes/core/error.hpp"

#include <ros/package.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace bin_scenes {

namespace {

/// The parameters of one node, read with a reason for each refusal.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& params) : params_(params) {}

  /// The parameter, or `value` as it is if it is not set. A value of another type is an error, not the default.
  template <class Value>
  void read(const std::string& name, Value& value, const char* expected) const {
    if (!params_.hasParam(name)) return;
    if (!params_.getParam(name, value)) throw refusal(name, "is of another type", std::string("give ") + expected);
  }
  void read(const std::string& name, double& value, double lower, double upper, const std::string& unit) const {
    read(name, value, "a number");
    if (!(value >= lower && value <= upper)) {
      throw refusal(name, "is " + text(value) + " " + unit, "give " + text(lower) + " to " + text(upper));
    }
  }
  void read(const std::string& name, int& value, int lower, int upper) const {
    read(name, value, "a whole number");
    if (value < lower || value > upper) {
      throw refusal(name, "is " + std::to_string(value), "give " + text(lower) + " to " + text(upper));
    }
  }
  Error refusal(const std::string& name, const std::string& problem, const std::string& remedy) const {
    return input_error(problem, "parameter " + params_.resolveName(name), remedy);
  }

 private:
  static std::string text(double number) {
    std::ostringstream out;
    out << number;
    return out.str();
  }
  const ros::NodeHandle& params_;
};

/// tf2 refuses a leading slash; spaces and control characters are nobody's intention.
void check_frame(const Reader& reader, const std::string& parameter, const std::string& frame) {
  const bool plain = std::all_of(frame.begin(), frame.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '/' || c == '-' || c == '.';
  });
  if (!plain || (!frame.empty() && frame[0] == '/') || frame.size() > 200) {
    throw reader.refusal(parameter, "is '" + frame + "', which is no name of a frame",
                         "use letters, digits and _, without a slash at the begin");
  }
}

Frames read_frames(const Reader& reader, const std::string& prefix) {
  Frames frames;
  frames.prefix = prefix;
  reader.read("frame_prefix", frames.prefix, "text");
  reader.read("bin_frame", frames.bin, "text");
  reader.read("parent_frame", frames.parent, "text");
  check_frame(reader, "frame_prefix", frames.prefix);
  check_frame(reader, "bin_frame", frames.bin);
  check_frame(reader, "parent_frame", frames.parent);
  if (frames.bin.empty()) throw reader.refusal("bin_frame", "is empty", "name the frame of the bin");
  frames.bin = frames.prefix + frames.bin;
  if (frames.bin == frames.parent) {
    throw reader.refusal("parent_frame", "is the bin's own frame", "name another frame, or none: \"\"");
  }

  std::vector<double> pose = {0, 0, 0, 0, 0, 0, 1};
  const char* expected = "[x, y, z, qx, qy, qz, qw], for instance [0, 0, 0, 0, 0, 0, 1]";
  reader.read("bin_pose", pose, expected);
  const double length = pose.size() == 7 ? Eigen::Vector4d(pose[3], pose[4], pose[5], pose[6]).norm() : 0.0;
  if (pose.size() != 7) {
    throw reader.refusal("bin_pose", "has " + std::to_string(pose.size()) + " numbers instead of 7",
                         std::string("give ") + expected);
  }
  if (!(std::abs(length - 1.0) < 1e-2) || !std::isfinite(pose[0] + pose[1] + pose[2])) {
    throw reader.refusal("bin_pose", "is no pose with a quaternion of length 1", std::string("give ") + expected);
  }
  frames.bin_pose = {Vec3(pose[0], pose[1], pose[2]), Quat(pose[6], pose[3], pose[4], pose[5]).normalized()};
  return frames;
}

}  // namespace

Settings read_settings(const ros::NodeHandle& params, const std::string& frame_prefix) {
  const Reader reader(params);
  Settings s;
  s.frames = read_frames(reader, frame_prefix);
  reader.read("tf_rate", s.tf_rate, 0.01, 1000.0, "Hz");
  reader.read("tf_span", s.tf_span, 0.0, 1e9, "s");
  reader.read("publish_rate", s.publish_rate, 0.0, 100.0, "Hz");
  reader.read("queue_size", s.queue_size, 1, 1000);
  reader.read("scenes_ahead", s.scenes_ahead, 0, 100);
  reader.read("rgb", s.rgb, "true or false");
  std::string goals = "queue";
  reader.read("goals", goals, "queue or preempt");
  if (goals != "queue" && goals != "preempt")
    throw reader.refusal("goals", "is '" + goals + "'", "give queue or preempt");
  s.preempt = goals == "preempt";

  const std::string package = ros::package::getPath("bin_scenes");
  s.paths.roots = {(package.empty() ? std::string(".") : package) + "/models"};
  s.paths.roots_name = params.resolveName("model_roots");
  s.paths.find_package = [](const std::string& name) { return ros::package::getPath(name); };
  reader.read("model_roots", s.paths.roots, "a list of folders: [/path/one, /path/two]");
  if (s.paths.roots.empty()) throw reader.refusal("model_roots", "is empty", "list the folders of your models");
  for (const std::string& root : s.paths.roots) {
    std::error_code ignored;
    if (!std::filesystem::is_directory(root, ignored)) {
      throw reader.refusal("model_roots", "names '" + root + "', which is no folder", "list folders that exist");
    }
  }
  reader.read("request", s.request, "a path");
  if (!s.request.empty()) {
    s.paths.roots.push_back(std::filesystem::absolute(s.request).parent_path().string());
  }
  return s;
}

}  // namespace bin_scenes
