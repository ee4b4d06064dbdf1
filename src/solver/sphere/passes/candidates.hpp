/// Finds the places where the surfaces of two bodies, or of a body and the bin, are close: samples of each body are
/// tested against the distance field of the other one, and edges by a local descent (Macklin et al. 2020, "Local
/// optimization for robust signed distance field collision"). The results are candidates; reduce.hpp selects few of
/// them as contacts.
#pragma once

#include "solver/sphere/math.hpp"
#include "solver/sphere/world.hpp"

#include <vector>

namespace bin_scenes::sphere {

/// A point where two surfaces are close, before reduction. All vectors are in the frame of body a.
struct Candidate {
  Vec3f on_a, on_b;       ///< nearest points of both surfaces (m)
  Vec3f normal;           ///< unit normal, from a to b
  float separation;       ///< m along the normal, negative if the surfaces overlap
  std::uint32_t feature;  ///< Contact::feature
};
using Candidates = std::vector<Candidate>;

/// A body at the time within the step at which its contacts are found (StepPlan::contact_time).
struct Placement {
  Vec3f x;
  Mat3f rotation;
  Vec3f v = Vec3f::Zero(), w = Vec3f::Zero();  ///< velocities, without gravity in the step: the body may be held up

  Placement(const World& world, const Body& body) : x(body.x), rotation(body.rotation) {
    if (!body.moves()) return;
    v = body.v;
    w = body.w;
    x += world.plan().contact_time * body.v;
    rotation = integrated(body.q, body.w, world.plan().contact_time).toRotationMatrix();
  }
};

/// Finds candidates: tests the samples of each body of a pair against the field of the other body.
/// @param margin  largest separation of a candidate (m)
/// @param out  the candidates are appended to it
void candidates_of_pair(const World& world, const Manifold& m, const Placement& a, const Placement& b, float margin,
                        Counters& counters, Candidates& out);

/// Tests the samples of a body against walls and floor of the bin; parameters as for candidates_of_pair().
void candidates_of_ground(const World& world, const Manifold& m, const Placement& a, float margin, Counters& counters,
                          Candidates& out);

}  // namespace bin_scenes::sphere
