/// Tests the samples of one body against the distance field of another body: nodes at their positions, edges by a local
/// descent (Macklin et al. 2020, "Local optimization for robust signed distance field collision").
#pragma once

#include "solver/sphere/passes/candidates.hpp"
#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

namespace bin_scenes::sphere {

/// The body whose samples are tested, and its pose in the frame of the field.
struct View {
  /// A body as far as the tests need it.
  struct Tested {
    const Samples& samples;
    const Field& field;
  };
  /// `sampled` against the field of `solid`; what touches is added to `out`.
  View(const Tested& sampled, const Tested& solid, const Carry& to_the_field, const Carry& to_first, Candidates& out)
      : samples(sampled.samples),
        other(solid.samples),
        own(sampled.field),
        field(solid.field),
        to_field(to_the_field),
        to_a(to_first),
        found(out) {}

  const Samples& samples;
  const Samples& other;  ///< of the field's body
  const Field& own;      ///< of the samples' body
  const Field& field;
  const Carry &to_field, &to_a;  ///< to_a: from the field's frame to that of the pair's first body
  std::uint32_t side = 0;        ///< SPHERE_SIDE_B: the field's frame is that of the first body
  Vec3f drift = Vec3f::Zero(),
        twist = Vec3f::Zero();  ///< displacement and turn of the samples over the field until the step ends (m, rad)
  float margin = 0;             ///< up to which distance (m)
  bool way_back = false;        ///< Settings::way_back
  Candidates& found;            ///< what touches is added
  Vec3f ahead = Vec3f::Zero();  ///< from where a sample is to where it is looked at (m)
};

/// Bounding spheres first.
void test_samples(const View& view, Counters& counters);

}  // namespace bin_scenes::sphere
