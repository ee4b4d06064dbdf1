#include "grasp/score.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes {

namespace {

constexpr double safe = 6.0;         ///< safety factors are limited to 1 / safe .. safe
constexpr double enough_pad = 0.05;  ///< share of the pad in contact at which the column is 1 - 1/e
constexpr double wide_margin = 0.5;  ///< / radius of the cup: margin at which the column is 1

}  // namespace

GraspColumns columns_of(const Grasp& grasp, const Hold& hold, const Gripper& gripper, double friction, double tilt) {
  GraspColumns columns;
  columns.safety = hold.safety;
  columns.sliding = hold.sliding;
  columns.moment = 1.0 - std::sqrt(std::clamp(hold.moment, 0.0, 1.0));
  columns.upright = 1.0 - tilt / (0.5 * M_PI);
  if (gripper.type == Gripper::Type::parallel) {
    columns.antipodal = std::max(0.0, 1.0 - grasp.friction / friction);
    columns.overlap = 1.0 - std::exp(-grasp.share / enough_pad);
    columns.closing = std::max(0.0, 1.0 - gripper.between_fingers(grasp.aperture()) / gripper.travel());
  } else {
    columns.antipodal = std::max(0.0, 1.0 - grasp.gap / gripper.lip);
    columns.overlap = std::min(1.0, grasp.margin / (wide_margin * grasp.radius));
    columns.closing = 1.0;
  }
  return columns;
}

double score_of(const GraspColumns& c, const Gripper& gripper) {
  const ScoreWeights w = gripper.weights();
  const auto spare = [](double factor) { return std::log(std::clamp(factor, 1.0 / safe, safe)); };
  const double sum = *w.bias + *w.holding * spare(c.safety) + *w.sliding * spare(c.sliding) +
                     w.antipodal * c.antipodal + w.moment * c.moment + w.overlap * c.overlap + w.upright * c.upright +
                     w.clearance * c.clearance + w.closing * c.closing + w.seen * c.seen + w.measured * c.measured;
  return 1.0 / (1.0 + std::exp(-sum));
}

}  // namespace bin_scenes
