/// Tests the samples of one body against the distance field of another body: nodes at their positions, edges by a local
/// descent (Macklin et al. 2020, "Local optimization for robust signed distance field collision").
#pragma once

#include "solver/sphere/passes/candidates.hpp"
#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

namespace bin_scenes::sphere {

/// The test of the samples of one body against the distance field of another, with their relative pose and motion.
struct View {
  /// The data of a body that the tests need.
  struct Tested {
    const Samples& samples;
    const Field& field;
  };
  /// Tests `sampled` against the field of `solid`; the tests append candidates to `out`.
  View(const Tested& sampled, const Tested& solid, const Carry& to_the_field, const Carry& to_first, Candidates& out)
      : samples(sampled.samples),
        other(solid.samples),
        own(sampled.field),
        field(solid.field),
        to_field(to_the_field),
        to_a(to_first),
        found(out) {}

  const Samples& samples;
  const Samples& other;  ///< samples of the body that has the field
  const Field& own;      ///< field of the body that has the samples
  const Field& field;
  const Carry &to_field, &to_a;  ///< to_field: into the field's frame; to_a: from there to the pair's first body
  std::uint32_t side = 0;        ///< SPHERE_SIDE_B if the field is that of the pair's first body, else 0
  Vec3f drift = Vec3f::Zero(),
        twist = Vec3f::Zero();  ///< predicted motion of the samples in the field until the step ends (m, rad)
  float margin = 0;             ///< largest separation of a candidate (m)
  float slop = 0;               ///< overlap that contacts leave while parts move (m)
  bool way_back = false;        ///< Settings::way_back
  Candidates& found;            ///< candidates are appended to it
};

/// Tests all samples of a view, beginning with the bounding spheres of the clusters.
void test_samples(const View& view, Counters& counters);

}  // namespace bin_scenes::sphere
