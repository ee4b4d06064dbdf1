#include "scene/range_check.hpp"

#include <sstream>

namespace bin_scenes {

namespace {

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

std::string text_of(const Range& range) {
  std::string text;
  if (std::isfinite(range.least)) text = (range.above ? "above " : "at least ") + shown(range.least);
  if (std::isfinite(range.most)) text += (text.empty() ? "at most " : " and at most ") + shown(range.most);
  return text;
}

void check_number(const std::string& path, const Key& key, double value) {
  const Range& range = key.range;
  const bool high_enough = range.above ? value > range.least : value >= range.least;
  if (std::isfinite(value) && high_enough && value <= range.most) return;
  const std::string wanted = text_of(range);
  throw input_error("must be " + (wanted.empty() ? "a finite number" : wanted) + ", is " + shown(value), path,
                    described(key));
}

void check_pose(const std::string& path, const Pose& pose) {
  if (!pose.finite()) throw input_error("contains a number that is not finite", path, "give seven finite numbers");
  if (std::abs(pose.orientation.squaredNorm() - 1.0) > 1e-6)
    throw input_error("its quaternion does not have the length 1", path, "normalise the quaternion");
  if (pose.position.norm() > 1e4)
    throw input_error("is " + shown(pose.position.norm()) + " m away from the origin", path,
                      "check the position, which is in m");
}

}  // namespace bin_scenes
