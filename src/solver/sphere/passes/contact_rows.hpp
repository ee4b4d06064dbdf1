/// Contacts in the form in which the solver processes them (GLSL: contact_row.h): eight at a time, one of each of eight
/// manifolds that share no moving body.
#pragma once

#include "solver/sphere/passes/blocks.hpp"
#include "solver/sphere/passes/lanes.hpp"
#include "solver/sphere/shared_code.hpp"
#include "solver/sphere/world.hpp"

#include <array>
#include <vector>

namespace bin_scenes::sphere {

using Real = Lanes;
using Real3 = LaneVec;
using Mask = LaneMask;

#include "shared/sphere/contact.h"
#include "shared/sphere/patch.h"
#include "shared/sphere/wait.h"

/// The motion of a body while contacts are solved (world frame). Each vector is x, y, z and a fourth value.
struct alignas(64) Motion {
  Quad v{};       ///< m/s; fourth: inverse mass (1/kg), 0 = the body is immovable in this step
  Quad w{};       ///< rad/s
  Quad moved{};   ///< displacement since contacts were found (m)
  Quad turned{};  ///< rotation vector since contacts were found (rad)

  float inverse_mass() const { return v[3]; }
};

inline Quad padded(const Vec3f& v, float fourth = 0) {
  return Quad{v.x(), v.y(), v.z(), fourth};
}

inline Vec3f vector_of(Quad q) {
  return {q[0], q[1], q[2]};
}

/// The k-th contact of each manifold of a bundle. A lane whose manifold has no such contact is all zeros, and does
/// nothing.
struct ContactRows {
  LaneVec normal, tangent;                     ///< unit vectors; the second tangent is normal x tangent
  LaneVec moment_a, moment_b, turn_a, turn_b;  ///< moment (arm x normal) and spin of a unit impulse along the normal
  LaneVec ra, rb;  ///< lever arms from the centres of mass to a common point (m, world frame); constant in a step, or
                   ///< in a sub-step if Bundle::refreshed
  Lanes normal_mass{}, tangent_mass{};                 ///< effective masses (kg)
  Lanes normal_impulse{}, t1_impulse{}, t2_impulse{};  ///< impulses of one sub-step (N s)
  Lanes separation{};                                  ///< distance when contacts were found (m)
  Lanes approach{};            ///< relative speed when both meet, if they do in this step (m/s); negative = closing
  Lanes lasting{};             ///< normal impulse at the start of the sub-step (N s)
  Lanes max_impulse{}, gap{};  ///< largest normal impulse (N s); distance when last computed (m)
  LaneMask waits{};            ///< takes no impulse in relaxation (shared/sphere/wait.h)
};

using LaneBodies = std::array<std::uint32_t, lane_count>;  ///< indices of bodies within their block

/// Eight manifolds of one color. In unused lanes, both bodies are the ground.
struct Bundle {
  LaneBodies a{}, b{};
  std::array<std::uint32_t, lane_count> manifold{};
  int lanes = 0;  ///< number of lanes in use
  int color = 0;
  bool paired = false;        ///< whether it is solved together with the next bundle, which has the same color
  LaneMask strikes{};         ///< manifolds with a contact that closes at Settings::restitution_speed or faster
  LaneMask refreshed{};       ///< those of them without a ball: their lever arms are computed in each sub-step
  std::uint32_t first, last;  ///< range of its rows; as many as the longest manifold has contacts
  Lanes friction{}, restitution{};
  Lanes tipping_arm{};                                 ///< m: moment of rolling friction / normal force; 0 with a ball
  LaneSymmetric inverse_inertia_a, inverse_inertia_b;  ///< world frame; 0 for immovable bodies

  std::uint32_t rows() const { return last - first; }
};

/// Removes from an impulse the part that was an impact (`speed`: impact_speed()). A contact that will bounce keeps the
/// impulse of its impact until it has bounced, because the bounce may have to reduce it.
inline void forget_impact(ContactRows& c, const Bundle& bundle, float speed, float restitution_speed) {
  const LaneMask bounces = (bundle.restitution > 0.0f) & (c.approach <= -restitution_speed);
  const Lanes share = select(bounces, all_lanes(1), lasting_share(c.normal_impulse, c.lasting, c.normal_mass, speed));
  for (Lanes* impulse : {&c.normal_impulse, &c.t1_impulse, &c.t2_impulse}) *impulse *= share;
}

/// The velocities of a bundle's bodies, in registers while its contacts are solved.
struct Velocities {
  LaneVec va, wa, vb, wb;
  Lanes inverse_mass_a{}, inverse_mass_b{};

  /// Returns the velocity of b's contact point relative to that of a (m/s).
  LaneVec at(const ContactRows& c) const { return vb + cross(wb, c.rb) - va - cross(wa, c.ra); }

  /// Returns the component of this velocity along the normal (m/s), positive if the points separate.
  Lanes along_normal(const ContactRows& c) const {
    return dot(c.normal, vb - va) + dot(c.moment_b, wb) - dot(c.moment_a, wa);
  }

  /// Applies `impulse` (N s) to b, and the opposite impulse to a.
  void push(const LaneVec& impulse, const ContactRows& c, const Bundle& bundle) {
    va = va - inverse_mass_a * impulse;
    wa = wa - bundle.inverse_inertia_a * cross(c.ra, impulse);
    vb = vb + inverse_mass_b * impulse;
    wb = wb + bundle.inverse_inertia_b * cross(c.rb, impulse);
  }
  /// Does the same with an impulse along the normal (N s).
  void push_along_normal(Lanes impulse, const ContactRows& c) {
    va = va - (inverse_mass_a * impulse) * c.normal;
    wa = wa - impulse * c.turn_a;
    vb = vb + (inverse_mass_b * impulse) * c.normal;
    wb = wb + impulse * c.turn_b;
  }
};

/// Displacements of a bundle's bodies since contacts were found.
struct Displacements {
  LaneVec moved_a, turned_a, moved_b, turned_b;

  /// Returns the increase of the distance of both points along the normal (m), to first order in the rotations.
  Lanes along(const ContactRows& c) const {
    return dot(c.normal, moved_b - moved_a) + dot(c.moment_b, turned_b) - dot(c.moment_a, turned_a);
  }
};

/// Reads one vector of eight bodies, one for each lane. The fourth components are stored in `fourth`.
inline LaneVec gather(const LaneBodies& bodies, const std::vector<Motion>& motions, Quad Motion::*vector,
                      Lanes& fourth) {
  Quad q[lane_count];
  for (int lane = 0; lane < lane_count; ++lane) q[lane] = motions[bodies[lane]].*vector;
  transpose(q[0], q[1], q[2], q[3]);
  transpose(q[4], q[5], q[6], q[7]);
  fourth = join(q[3], q[7]);
  return {join(q[0], q[4]), join(q[1], q[5]), join(q[2], q[6])};
}
inline LaneVec gather(const LaneBodies& bodies, const std::vector<Motion>& motions, Quad Motion::*vector) {
  Lanes fourth;
  return gather(bodies, motions, vector, fourth);
}
inline void scatter(const LaneVec& v, Lanes fourth, const LaneBodies& bodies, Quad Motion::*vector,
                    std::vector<Motion>& motions) {
  Quad q[lane_count] = {low_half(v.x),  low_half(v.y),  low_half(v.z),  low_half(fourth),
                        high_half(v.x), high_half(v.y), high_half(v.z), high_half(fourth)};
  transpose(q[0], q[1], q[2], q[3]);
  transpose(q[4], q[5], q[6], q[7]);
  for (int lane = 0; lane < lane_count; ++lane) motions[bodies[lane]].*vector = q[lane];
}

inline Velocities velocities_of(const Bundle& bundle, const std::vector<Motion>& motions) {
  Velocities out;
  out.va = gather(bundle.a, motions, &Motion::v, out.inverse_mass_a);
  out.wa = gather(bundle.a, motions, &Motion::w);
  out.vb = gather(bundle.b, motions, &Motion::v, out.inverse_mass_b);
  out.wb = gather(bundle.b, motions, &Motion::w);
  return out;
}

inline Displacements displacements_of(const Bundle& bundle, const std::vector<Motion>& motions) {
  return {gather(bundle.a, motions, &Motion::moved), gather(bundle.a, motions, &Motion::turned),
          gather(bundle.b, motions, &Motion::moved), gather(bundle.b, motions, &Motion::turned)};
}

/// Stores the velocities of a bundle's bodies. Those of the ground and of immovable bodies do not change.
inline void store(const Velocities& velocities, const Bundle& bundle, std::vector<Motion>& motions) {
  scatter(velocities.va, velocities.inverse_mass_a, bundle.a, &Motion::v, motions);
  scatter(velocities.wa, Lanes{}, bundle.a, &Motion::w, motions);
  scatter(velocities.vb, velocities.inverse_mass_b, bundle.b, &Motion::v, motions);
  scatter(velocities.wb, Lanes{}, bundle.b, &Motion::w, motions);
}

/// The bundles of one color: they share no moving body and may be solved in any order. If `in_turn`, they are those of
/// the manifolds without a color of their own, which are solved one by one.
struct Color {
  std::uint32_t first, last;
  bool in_turn;
};

/// The working memory of the solve of a block. It is kept to avoid allocations.
struct Scratch {
  /// Motions of the block's bodies, followed by those of static bodies: see make_bundles().
  std::vector<Motion> motions;
  std::vector<char> free;    ///< by body: whether it has no contacts
  std::vector<char> slides;  ///< by body: whether it has a contact that slips; static bodies follow
  /// Speeds of bodies at the start of the sub-step, including rotation at their radius (m/s).
  std::vector<float> speeds;
  std::vector<Bundle> bundles;  ///< in order of color
  std::vector<Color> colors;
  std::vector<ContactRows> rows;
};

/// Number of bundles that a thread processes at a time. It is even, so that paired bundles stay together.
constexpr std::uint32_t bundles_per_piece = 4;

/// Arranges the manifolds of a block in bundles, in order of color; within a color, the longest come first, so that
/// lanes are filled. Static bodies come after all moving bodies of the block, once for each piece of a color, so that
/// no two threads write to the same one. Returns the number of such pieces.
std::uint32_t make_bundles(const World& world, const Blocks& blocks, std::size_t block, std::vector<Bundle>& bundles,
                           std::vector<Color>& colors, std::vector<ContactRows>& rows);
/// Fills a bundle and its rows from its manifolds, with the forces of the last step as impulses of a sub-step of `h`
/// seconds. Also notes the contacts' normals in world axes.
void prepare(World& world, const std::vector<Motion>& motions, float h, Bundle& bundle, std::vector<ContactRows>& rows);
/// Computes lever arms, gaps and inertia of manifolds that are hit, for the present positions of their bodies
/// (shared/sphere/row.h).
void refresh_levers(const World& world, const std::vector<Motion>& motions, Bundle& bundle,
                    std::vector<ContactRows>& rows);
/// Stores the impulses of a sub-step of `h` seconds in the contacts, as forces.
void keep_forces(const Bundle& bundle, const std::vector<ContactRows>& rows, float h, World& world);

}  // namespace bin_scenes::sphere
