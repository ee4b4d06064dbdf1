/// Parts that a gripper takes out, dragging others along.
#include "pour/heap_core.hpp"

#include "bin_scenes/core/cancel.hpp"

#include <cmath>

namespace bin_scenes {

namespace {

constexpr double lift_speed = 0.1;  ///< m/s

}  // namespace

void HeapCore::lift(const std::vector<std::size_t>& bodies, const Vec3& direction, double distance,
                    const RunHooks& hooks) {
  states();
  if (settling_.done()) begin(Stage::repair);
  start_clock();
  std::vector<Pose> poses;
  for (const std::size_t b : bodies) poses.push_back(states_[b].pose);
  const double slice = solver_.step_size();
  // Gravity takes its part of the velocity back within the step.
  const BodyState moved{Pose(), {lift_speed * direction - slice * plan_->world.gravity, Vec3::Zero()}};
  const int pieces = static_cast<int>(std::ceil(distance / (lift_speed * slice)));
  for (int piece = 1; piece <= pieces; ++piece) {
    stop_if_cancelled();
    // Put on its path again in every step, so that it carries parts instead of falling with them.
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (place_[bodies[i]] != Place::in) continue;  // it lay outside of the bin
      BodyState state = moved;
      state.pose = poses[i];
      state.pose.position += direction * (distance * (piece - 1) / pieces);
      solver_.insert(id_, bodies[i], state);
    }
    advanced(solver_.advance({id_}, slice));
    update_rest();
    if (hooks.progress) {
      Progress now = progress();
      now.phase = "lift";
      now.fraction = 0.0;
      hooks.progress(now);
    }
  }
}

}  // namespace bin_scenes
