#include "bin_scenes/pour/contact_action.hpp"

#include "bin_scenes/core/assertion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bin_scenes {

namespace {

constexpr double impact_fall = 0.01;    ///< / d
constexpr double overlap = 1e-3;        ///< / d
constexpr double sliding_speed = 0.05;  ///< d per second
constexpr double rounding = 1e-3;       ///< of the length of a normal in single precision

/// Models of all bodies: the copies of each line follow each other.
std::vector<const PartModel*> models_of(const LoadedRequest& loaded) {
  std::vector<const PartModel*> models;
  for (std::size_t line = 0; line < loaded.request.parts.size(); ++line)
    models.insert(models.end(), loaded.request.parts[line].count, loaded.parts.at(line).get());
  return models;
}

/// Velocity (m/s) of the point of a body that is at `point`; a body that is not there, like the bin, does not move.
Vec3 velocity_at(const Vec3& point, const BodyState& state, const PartModel& model) {
  if (!state.pose.finite()) return Vec3::Zero();
  return state.velocity.linear + state.velocity.angular.cross(point - state.pose * model.mass().center);
}

class Actions {
 public:
  Actions(const std::vector<BodyState>& before, const std::vector<BodyState>& now, const LoadedRequest& loaded)
      : before_(before.empty() ? now : before), now_(now), models_(models_of(loaded)) {
    BIN_SCENES_ASSERT(now_.size() == models_.size() && before_.size() == now_.size());
    gravity_ = loaded.request.gravity.norm();
  }

  ContactAction of(const ContactForce& force) const {
    BIN_SCENES_ASSERT(force.a >= 0 && force.a < static_cast<int>(models_.size()) && force.force.allFinite());
    BIN_SCENES_ASSERT(force.b < static_cast<int>(models_.size()) && is_unit(force.normal));
    const double diagonal = std::min(diagonal_of(force.a), diagonal_of(force.b));
    const Vec3 speed = relative_velocity(force, now_);
    const double approach = -relative_velocity(force, before_).dot(force.normal), away = speed.dot(force.normal);
    if (std::max(approach, away) > std::sqrt(2.0 * gravity_ * impact_fall * diagonal)) return ContactAction::impact;
    if (force.gap < -overlap * diagonal) return ContactAction::pushed_apart;
    if ((speed - away * force.normal).norm() > sliding_speed * diagonal) return ContactAction::sliding;
    return ContactAction::resting;
  }

 private:
  double diagonal_of(int body) const {
    return body < 0 ? std::numeric_limits<double>::infinity() : models_[static_cast<std::size_t>(body)]->diagonal();
  }
  /// Of b as seen from a.
  Vec3 relative_velocity(const ContactForce& force, const std::vector<BodyState>& states) const {
    const auto of = [&](int body) {
      const auto i = static_cast<std::size_t>(body);
      return body < 0 ? Vec3(Vec3::Zero()) : velocity_at(force.point, states[i], *models_[i]);
    };
    return of(force.b) - of(force.a);
  }

  const std::vector<BodyState>&before_, &now_;
  std::vector<const PartModel*> models_;
  double gravity_ = 0.0;
};

}  // namespace

std::vector<SceneContact> contacts_of(const std::vector<ContactForce>& forces, const std::vector<BodyState>& before,
                                      const std::vector<BodyState>& now, const LoadedRequest& loaded) {
  const Actions actions(before, now, loaded);
  std::vector<SceneContact> contacts;
  for (ContactForce f : forces) {
    BIN_SCENES_ASSERT(std::abs(f.normal.norm() - 1.0) < rounding);
    f.normal.normalize();
    contacts.push_back({f.a, f.b, f.point, f.normal, f.force, actions.of(f)});
  }
  return contacts;
}

}  // namespace bin_scenes
