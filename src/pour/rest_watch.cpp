#include "bin_scenes/pour/rest_watch.hpp"

#include "bin_scenes/core/assertion.hpp"

namespace bin_scenes {

void RestWatch::observe(std::size_t index, double time, const Vec3& center, const Quat& orientation,
                        const Limits& limits) {
  BIN_SCENES_ASSERT(index < bodies_.size());
  Body& body = bodies_[index];
  const bool still = body.seen && (center - body.center).norm() <= limits.move &&
                     orientation.angularDistance(body.orientation) <= limits.turn;  // NaN is not still
  if (!still) {
    body = {true, false, time, center, orientation};
    return;
  }
  // Looks fall on whole steps, so the window is met to within rounding.
  body.resting = time - body.since >= limits.window * (1.0 - 1e-9);
}

}  // namespace bin_scenes
