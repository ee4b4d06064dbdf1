/// Contact samples of the default sphere solver: points on the surface, denser along sharp edges and at corners.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct SurfaceSample {
  Vec3 point = Vec3::Zero();   ///< on the surface, model frame (m)
  Vec3 normal = Vec3::Zero();  ///< outward, averaged at edges and corners
  double spacing = 0.0;        ///< mean distance to the next samples of its kind (m)
};

struct SampleSet {
  std::vector<SurfaceSample> samples;  ///< ordered so that every run of `cluster` samples is compact in space
  int cluster = 16;
};

struct SampleOptions {
  int count = 1000;          ///< number of samples; fewer only if the spacing becomes zero
  double sharp_angle = 0.5;  ///< rad: edges bent more than this are sampled as edges
};

class MeshQuery;

/// Corners first, then convex sharp edges at half the spacing of the faces, then faces by farthest point sampling,
/// until `count` is reached. Corners and edges take at most 0.7 of it. Closed cavities and faces inside another shell
/// of the same part get no samples, because nothing can touch them. Deterministic.
SampleSet surface_samples(const Mesh& mesh, const SampleOptions& options);
SampleSet surface_samples(const MeshQuery& query, const SampleOptions& options);

}  // namespace bin_scenes
