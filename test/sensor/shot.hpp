/// An image by a sensor model beside the truth, and a V-groove to take one of.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/view.hpp"
#include "sensor/models/measurement.hpp"
#include "sensor/targets.hpp"

#include <cmath>
#include <vector>

namespace bin_scenes::test {

struct Shot {
  View view;
  Measurement measured;
  std::vector<double> sigma;  ///< of depth, as the model predicts it (m)
};

/// By a camera at the origin that looks along z.
template <class Model, class Setup>
Shot shoot(Targets& targets, const Lens& camera, const Setup& setup, bool decoded, std::uint64_t seed = 1) {
  const Scenery scenery = targets.scenery();
  Shot shot{render(scenery, camera, Pose(), setup.near, setup.far), Measurement(0), {}};
  const Model model(scenery, shot.view, targets.surfaces(), setup);
  const Random random(seed, 0, Stream::noise);
  shot.measured = decoded ? model.decoded(random) : model.analytic(random);
  for (std::size_t i = 0; i < shot.view.depth.size(); ++i) shot.sigma.push_back(model.depth_sigma(i));
  return shot;
}

/// Two faces at right angles, `width` wide, that meet in a line along y at the depth.
inline Targets groove(const Surface& surface, double depth, double width, double length) {
  Mesh mesh;
  for (const int side : {-1, 1}) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const double far : {0.0, width})
      for (const double y : {-0.5 * length, 0.5 * length})
        mesh.vertices.push_back(Vec3(0, y, depth) + far * (Vec3(side, 0.0, -1.0) / std::sqrt(2.0)));
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangles.push_back({base + 1, base + 3, base + 2});
  }
  Targets targets;
  targets.add(mesh, Pose(), surface);
  return targets;
}

}  // namespace bin_scenes::test
