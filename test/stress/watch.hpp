/// What a scene's energy, momentum and speeds were while it ran, from the states a trace hands over.
#pragma once

#include "bin_scenes/part/loaded_request.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <string>
#include <vector>

namespace bin_scenes::stress {

class Watch {
 public:
  /// `loaded` must live as long as the watch.
  explicit Watch(const LoadedRequest& loaded) : request_(loaded.request), parts_(loaded.parts) {}

  /// One sample, the first at time 0. Parts that have not entered yet have no pose.
  void observe(const std::vector<BodyState>& states);

  /// Largest energy above what had been put in so far / all that was put in. What a part brings in: its energy when it
  /// is first seen to move.
  double energy_gain() const { return gain_; }
  /// |change of momentum| / sum of |momenta| from first to last sample; angular momentum / sum of spins and of momenta
  /// times part diagonals; the larger.
  double momentum_change() const;
  double top_speed() const { return top_speed_; }
  bool finite() const { return finite_; }

 private:
  struct Body {
    std::size_t line;
    double mass;
    Mat3 inertia;  ///< body frame
    bool entered = false, seen_moving = false;
    Pose first = {};
    Vec3 entry = Vec3::Zero();
    double brought = 0.0;
  };
  struct Momentum {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    double linear_sum = 0.0, angular_sum = 0.0;
  };
  void begin();

  const Request& request_;
  const std::vector<PartModelPtr>& parts_;
  std::vector<Body> bodies_;
  Momentum first_, last_;
  Vec3 about_ = Vec3::Zero();
  double mass_ = 0.0;
  double gain_ = 0.0, scale_ = 0.0, top_speed_ = 0.0;
  bool finite_ = true;
};

}  // namespace bin_scenes::stress
