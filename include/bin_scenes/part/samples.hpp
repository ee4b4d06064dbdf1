/// Contact samples of the default solver: points on the surface of a part that are tested against the distance fields
/// of other parts. They are denser along sharp edges and at corners, because parts touch there first.
/// src/solver/sphere/shapes adds what the solver needs at each sample.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

/// One sample: a point on the surface with its normal.
struct SurfaceSample {
  Vec3 point = Vec3::Zero();   ///< point on the surface, model frame (m)
  Vec3 normal = Vec3::Zero();  ///< outward unit normal, averaged over the faces at edges and corners
  double spacing = 0.0;        ///< mean distance (m) to neighbouring samples of the same kind (corners, edges or faces)
};

/// All samples of a part.
struct SampleSet {
  std::vector<SurfaceSample> samples;  ///< ordered so that every sequence of `cluster` samples is compact in space
  int cluster = 16;
};

/// Density of the samples.
struct SampleOptions {
  int count = 1000;          ///< number of samples; fewer only if the spacing becomes zero
  double sharp_angle = 0.5;  ///< rad: edges whose faces differ by more than this angle are sampled as edges
};

class MeshQuery;

/// Places `count` samples on a mesh: first at corners, then along convex sharp edges at half the spacing of the faces,
/// then on the faces by farthest-point sampling. Corners and edges take at most 0.7 of the samples. Closed cavities and
/// faces inside another shell of the same part get no samples, because nothing can touch them. The same mesh always
/// gives the same samples.
SampleSet surface_samples(const Mesh& mesh, const SampleOptions& options);
SampleSet surface_samples(const MeshQuery& query, const SampleOptions& options);

}  // namespace bin_scenes
