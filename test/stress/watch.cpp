#include "stress/watch.hpp"

#include <algorithm>

namespace bin_scenes::stress {

namespace {

double density_of(const PartLine& line, const PartModel& part) {
  return line.mass ? *line.mass / part.mass().volume : line.density.value_or(1000.0);
}

}  // namespace

void Watch::begin() {
  for (std::size_t line = 0; line < request_.parts.size(); ++line)
    for (std::size_t copy = 0; copy < request_.parts[line].count; ++copy) {
      const double density = density_of(request_.parts[line], *parts_[line]);
      bodies_.push_back({line, density * parts_[line]->mass().volume, density * parts_[line]->mass().inertia});
    }
}

void Watch::observe(const std::vector<BodyState>& states) {
  const bool at_start = bodies_.empty();
  if (at_start) begin();
  double energy = 0.0, put_in = 0.0, scale = 0.0;
  Momentum sum;
  for (std::size_t i = 0; i < states.size(); ++i) {
    Body& body = bodies_[i];
    if (request_.parts[body.line].fixed) continue;
    const PartModel& part = *parts_[body.line];
    const BodyState& state = states[i];
    if (!body.entered && !state.pose.finite()) continue;  // it waits for its turn
    if (!body.entered) body.first = state.pose;
    body.entered = true;
    if (!state.velocity.linear.allFinite() || !state.velocity.angular.allFinite()) {
      finite_ = false;
      continue;
    }
    const Vec3 center = state.pose * part.mass().center;
    const Mat3 R = state.pose.orientation.toRotationMatrix();
    const Vec3 momentum = body.mass * state.velocity.linear;
    if (at_start) about_ += body.mass * center, mass_ += body.mass;
    const Vec3 spin = R * body.inertia * R.transpose() * state.velocity.angular;
    const double kinetic = 0.5 * momentum.dot(state.velocity.linear) + 0.5 * spin.dot(state.velocity.angular);
    const double now = kinetic - body.mass * request_.gravity.dot(center);
    const bool moved = state.pose.position != body.first.position || kinetic > 0.0;
    if (!body.seen_moving) {  // still where it started, or just in
      body.brought = now;
      body.entry = center;
    }
    body.seen_moving = body.seen_moving || moved;
    energy += now;
    put_in += body.brought;
    // A centimetre a second is the least that counts as energy: scenes that start at rest on the floor have none.
    scale += body.mass * (request_.gravity.norm() * ((center - body.entry).norm() + part.diagonal()) + 0.5 * 1e-4);
    if (at_start) scale += kinetic;
    top_speed_ = std::max(top_speed_, state.velocity.linear.norm());
    sum.linear += momentum;
    sum.angular += spin + center.cross(momentum);
    sum.linear_sum += momentum.norm();
    sum.angular_sum += spin.norm() + part.diagonal() * momentum.norm();
  }
  if (at_start) {
    first_ = sum;
    scale_ = scale;
    if (mass_ > 0.0) about_ /= mass_;
  }
  scale_ = std::max(scale_, scale);
  gain_ = std::max(gain_, (energy - put_in) / scale_);
  last_ = sum;
}

double Watch::momentum_change() const {
  const auto relative = [](double change, double sum) { return sum > 0.0 ? change / sum : change; };
  // About the common centre of mass at the start: far from the origin, rounding of places would count otherwise.
  const Vec3 linear = last_.linear - first_.linear, angular = last_.angular - first_.angular - about_.cross(linear);
  return std::max(relative(linear.norm(), first_.linear_sum), relative(angular.norm(), first_.angular_sum));
}

}  // namespace bin_scenes::stress
