/// The effects of a gripper in the solve of a block: jaws that stay on their axis, and the pull of a vacuum. This code
/// runs only while a grasp is proved, and costs nothing in other scenes.
#pragma once

#include "solver/sphere/passes/blocks.hpp"
#include "solver/sphere/passes/contact_rows.hpp"

#include <algorithm>

namespace bin_scenes::sphere {

/// The jaws of the world, if they are in this block. Contacts may push jaws in any direction; after each color, only
/// the change of their common closing speed is kept, and otherwise they move with the hand. Contacts therefore press
/// with the force of the jaws, and the hand does not yield, whatever the mass of the jaws.
class HeldJaws {
 public:
  HeldJaws(const World& world, const Blocks& blocks, std::size_t block) {
    if (!world.jaws) return;
    const JawPair& jaws = *world.jaws;
    first_ = blocks.place(block, jaws.first);
    second_ = blocks.place(block, jaws.second);
    const std::size_t bodies = blocks.bodies(block).size();
    const auto here = [&](std::uint32_t place, std::uint32_t body) {
      return place < bodies && blocks.bodies(block)[place] == body;
    };
    if (here(first_, jaws.first) && here(second_, jaws.second)) jaws_ = &jaws;
  }

  bool has(std::size_t place) const { return jaws_ && (place == first_ || place == second_); }
  void begin(std::vector<Motion>& motions) const {
    if (!jaws_) return;
    motions[first_].v[3] = motions[second_].v[3] = 1.0f / jaws_->mass;
    move(closing(motions), motions);
  }
  /// Applies the force of the jaws for a sub-step (s).
  void press(float sub_step, std::vector<Motion>& motions) const {
    if (jaws_) move(std::min(closing(motions) + sub_step * jaws_->force / jaws_->mass, jaws_->speed), motions);
  }
  void keep_to_axis(std::vector<Motion>& motions) const {
    if (jaws_) move(closing(motions), motions);
  }

 private:
  static Vec3f vector(const Quad& q) { return {q[0], q[1], q[2]}; }
  /// Returns the closing speed of each jaw (m/s).
  float closing(const std::vector<Motion>& motions) const {
    return 0.5f * jaws_->axis.dot(vector(motions[first_].v) - vector(motions[second_].v));
  }
  void move(float closing, std::vector<Motion>& motions) const {
    const auto set = [&](Motion& motion, const Vec3f& v) {
      motion.v = Quad{v.x(), v.y(), v.z(), motion.v[3]};
      motion.w = Quad{};
    };
    set(motions[first_], jaws_->velocity + closing * jaws_->axis);
    set(motions[second_], jaws_->velocity - closing * jaws_->axis);
  }

  const JawPair* jaws_ = nullptr;
  std::uint32_t first_ = 0, second_ = 0;  ///< indices of the jaws in the block
};

/// Applies the forces of World::pulls to bodies of a block, for a sub-step (s).
inline void pull(const World& world, const Blocks& blocks, std::size_t block, float sub_step,
                 std::vector<Motion>& motions) {
  for (const Pull& pull : world.pulls) {
    const std::uint32_t place = blocks.place(block, pull.body);
    if (place >= blocks.bodies(block).size() || blocks.bodies(block)[place] != pull.body) continue;
    const Body& b = world.bodies[pull.body];
    const Mat3f r = b.q.toRotationMatrix();
    const Vec3f v = sub_step * b.inverse_mass * pull.force;
    const Vec3f w = sub_step * (r * (b.inverse_inertia * (r.transpose() * Vec3f((r * pull.arm).cross(pull.force)))));
    motions[place].v += Quad{v.x(), v.y(), v.z(), 0.0f};
    motions[place].w += Quad{w.x(), w.y(), w.z(), 0.0f};
  }
}

}  // namespace bin_scenes::sphere
