/// Samples of one body against the distance field of another: nodes where they are, edges by descent (Macklin et al.
/// 2020, "Local optimization for robust signed distance field collision").
#pragma once

#include "solver/sphere/passes/candidates.hpp"
#include "solver/sphere/shapes/contact_samples.hpp"
#include "solver/sphere/shapes/field.hpp"

namespace bin_scenes::sphere {

/// Whose samples are tested, and where they lie in the frame of the field.
struct View {
  const Samples& samples;
  const Field& own;      ///< of the samples' body
  const Samples& other;  ///< of the field's body
  const Field& field;
  const Carry& to_field;
  const Carry* to_a;  ///< from the field's frame to that of the pair's first body; null: it is the same
  float margin;       ///< up to which distance (m)
  bool way_back;      ///< Settings::way_back
};

/// Bounding spheres first. What touches is added to `out`.
void test_samples(const View& view, Counters& counters, Candidates& out);

}  // namespace bin_scenes::sphere
