/// Newton's restitution at the end of a step: bodies that collided separate with a share of their approach speed. It is
/// done after all sub-steps, in sweeps of its own, because an impact must first have propagated through the heap.
#pragma once

#include "solver/sphere/passes/contact_rows.hpp"
#include "solver/sphere/passes/held.hpp"

namespace bin_scenes::sphere {

class Restitution {
 public:
  /// h: duration of a sub-step (s). speed: approach speed from which contacts bounce (m/s).
  Restitution(const std::vector<Bundle>& bundles, std::vector<ContactRows>& rows, std::vector<Motion>& motions, float h,
              float speed)
      : bundles_(bundles), rows_(rows), motions_(motions), h_(h), speed_(speed) {}

  void apply(const HeldJaws& jaws) const {
    struct Bounce {
      const Bundle* bundle;
      LaneMask lanes;
    };
    static thread_local std::vector<Bounce> hits;
    hits.clear();
    for (const Bundle& bundle : bundles_)
      if (any(bundle.strikes))
        if (const LaneMask lanes = bouncing(bundle); any(lanes)) hits.push_back({&bundle, lanes});
    for (int k = 0; k < int(SPHERE_BOUNCE_SWEEPS); ++k)
      for (const Bounce& b : hits) {
        bounce(*b.bundle, b.lanes);
        jaws.keep_to_axis(motions_);
      }
    for (const Bounce& b : hits)  // an impact is over: it must not warm-start the next step
      for (std::uint32_t i = b.bundle->first; i < b.bundle->last; ++i) {
        ContactRows& c = rows_[i];
        const LaneMask over = b.lanes & hit(c);
        for (Lanes* impulse : {&c.normal_impulse, &c.t1_impulse, &c.t2_impulse})
          *impulse = over ? all_lanes(0) : *impulse;
      }
  }

 private:
  LaneMask hit(const ContactRows& c) const { return was_hit(c.approach, c.max_impulse > 0.0f, c.gap, h_, speed_); }
  /// Returns which manifolds of a bundle have a contact that was hit and took part in the impact.
  LaneMask bouncing(const Bundle& bundle) const {
    LaneMask out{};
    for (std::uint32_t i = bundle.first; i < bundle.last; ++i) out |= hit(rows_[i]) & (rows_[i].max_impulse > 0.0f);
    return out & (bundle.restitution > 0.0f);
  }
  void bounce(const Bundle& bundle, LaneMask lanes) const {
    Velocities u = velocities_of(bundle, motions_);
    for (std::uint32_t i = bundle.first; i < bundle.last; ++i) {
      ContactRows& c = rows_[i];
      const LaneMask bounces = lanes & hit(c);
      if (!any(bounces)) continue;
      const Lanes before = c.normal_impulse;
      c.normal_impulse = select(
          bounces, bounced_impulse(before, u.along_normal(c), c.normal_mass, bundle.restitution, c.approach), before);
      u.push_along_normal(c.normal_impulse - before, c);
    }
    store(u, bundle, motions_);
  }

  const std::vector<Bundle>& bundles_;
  std::vector<ContactRows>& rows_;
  std::vector<Motion>& motions_;
  const float h_, speed_;
};

}  // namespace bin_scenes::sphere
