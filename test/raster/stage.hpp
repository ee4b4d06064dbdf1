/// Scenes for tests of sensors, and an independent ray cast to compare with.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/scenery.hpp"
#include "bin_scenes/scene/scene.hpp"
#include "part/shapes.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace bin_scenes::test {

/// Parts placed by hand in a bin, none unless set.
struct Stage {
  Request request;
  Scene scene;
  std::vector<PartModelPtr> models;
  SceneryCache cache;

  Stage() { request.bin.kind = Bin::Kind::none; }
  std::size_t model(const Mesh& mesh) {
    models.push_back(PartModel::from_mesh(mesh, "shape" + std::to_string(models.size())));
    request.parts.emplace_back();
    return models.size() - 1;
  }
  void place(std::size_t line, const Pose& pose) {
    ScenePart part;
    part.id = static_cast<int>(scene.parts.size());
    part.line = line;
    part.pose = pose;
    part.state = PartState::resting;
    scene.parts.push_back(part);
  }
  Scenery scenery(const PartModelPtr& bin = nullptr) { return Scenery(scene, {request, models, bin}, cache); }
};

inline Pose at(double x, double y, double z, const Quat& turn = Quat::Identity()) {
  return {Vec3(x, y, z), turn};
}
inline Quat turned(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// Moller and Trumbore 1997, "Fast, minimum storage ray-triangle intersection", in double, over every triangle.
struct BruteHit {
  double distance = std::numeric_limits<double>::quiet_NaN();
  int label = 0;
};
class BruteCast {
 public:
  void add(const Mesh& mesh, const Pose& pose, int label) {
    for (const Triangle& t : mesh.triangles) {
      const Vec3 a = pose * mesh.vertices[t[0]];
      triangles_.push_back({a, pose * mesh.vertices[t[1]] - a, pose * mesh.vertices[t[2]] - a, label});
    }
  }
  explicit BruteCast(const Stage& stage) {
    for (const ScenePart& part : stage.scene.parts) add(stage.models[part.line]->mesh(), part.pose, part.id + 1);
  }
  /// @param only  label of the one part that is looked at; -1: all
  BruteHit hit(const Vec3& origin, const Vec3& direction, double near, double far, int only = -1) const {
    BruteHit best;
    double end = far;
    for (const Corner& t : triangles_) {
      if (only >= 0 && t.label != only) continue;
      const Vec3 p = direction.cross(t.e2);
      const double det = t.e1.dot(p);
      if (det == 0.0) continue;
      const Vec3 s = origin - t.a, q = s.cross(t.e1);
      const double u = s.dot(p) / det, v = direction.dot(q) / det, distance = t.e2.dot(q) / det;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(distance >= near && distance <= end)) continue;
      best = {end = distance, t.label};
    }
    return best;
  }

 private:
  struct Corner {
    Vec3 a, e1, e2;
    int label;
  };
  std::vector<Corner> triangles_;
};

}  // namespace bin_scenes::test
