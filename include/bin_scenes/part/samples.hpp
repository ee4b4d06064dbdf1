/// Contact samples of the default sphere solver: points on the surface, denser along sharp edges and at corners.
#pragma once

#include "bin_scenes/scene/mesh.hpp"

#include <vector>

namespace bin_scenes {

struct SurfaceSample {
  Vec3 point = Vec3::Zero();   ///< on the surface, model frame (m)
  Vec3 normal = Vec3::Zero();  ///< outward, averaged at edges and corners
  double spacing = 0.0;        ///< distance to the next samples of its kind (m)
};

struct SampleSet {
  std::vector<SurfaceSample> samples;  ///< ordered so that every run of `cluster` samples is compact in space
  int cluster = 16;
};

struct SampleOptions {
  int count = 1000;           ///< aim; sharp features may add to it
  double sharp_angle = 0.5;   ///< rad: edges bent more than this are sampled as edges
};

SampleSet surface_samples(const Mesh& mesh, const SampleOptions& options);

}  // namespace bin_scenes
