#include "settings.hpp"

#include "bin_scenes/core/error.hpp"

#include <ros/package.h>

#include <filesystem>

namespace bin_scenes {

namespace {

/// The parameter, or the default if it is not set. A value of another type is an error, not the default.
template <class Value>
Value get(const ros::NodeHandle& params, const std::string& name, const Value& fallback, const char* expected) {
  Value value;
  if (!params.hasParam(name)) return fallback;
  if (!params.getParam(name, value)) {
    throw input_error(std::string("expected ") + expected, "parameter " + params.resolveName(name), "mend its type");
  }
  return value;
}

}  // namespace

Settings read_settings(const ros::NodeHandle& params) {
  Settings s;
  s.frames.bin = get(params, "bin_frame", s.frames.bin, "text");
  s.frames.parent = get(params, "parent_frame", s.frames.parent, "text");
  if (s.frames.bin.empty()) {
    throw input_error("is empty", "parameter " + params.resolveName("bin_frame"), "name the frame of the bin");
  }
  const auto pose = get(params, "bin_pose", std::vector<double>{0, 0, 0, 0, 0, 0, 1}, "seven numbers");
  const double length = pose.size() == 7 ? Eigen::Vector4d(pose[3], pose[4], pose[5], pose[6]).norm() : 0.0;
  if (!(std::abs(length - 1.0) < 1e-2)) {
    throw input_error("expected x, y, z and a quaternion qx, qy, qz, qw of length 1",
                      "parameter " + params.resolveName("bin_pose"), "for instance [0, 0, 0, 0, 0, 0, 1]");
  }
  s.frames.bin_pose = {Vec3(pose[0], pose[1], pose[2]), Quat(pose[6], pose[3], pose[4], pose[5]).normalized()};
  s.tf_rate = get(params, "tf_rate", s.tf_rate, "a number");
  if (!(s.tf_rate > 0.0 && s.tf_rate <= 1000.0)) {
    throw input_error("is " + std::to_string(s.tf_rate) + " Hz", "parameter " + params.resolveName("tf_rate"),
                      "use more than 0 and at most 1000");
  }
  const std::string package = ros::package::getPath("bin_scenes");
  const std::vector<std::string> models = {(package.empty() ? std::string(".") : package) + "/models"};
  s.paths.roots = get(params, "model_roots", models, "a list of folders");
  if (s.paths.roots.empty()) {
    throw input_error("is empty", "parameter " + params.resolveName("model_roots"), "list the folders of your models");
  }
  if (!package.empty()) s.paths.packages.emplace_back("bin_scenes", package);
  s.request = get(params, "request", std::string(), "a path");
  if (!s.request.empty()) {
    s.paths.roots.push_back(std::filesystem::absolute(s.request).parent_path().string());
  }
  return s;
}

}  // namespace bin_scenes
