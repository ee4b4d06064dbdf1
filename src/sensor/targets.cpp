#include "sensor/targets.hpp"

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace bin_scenes {

Mesh box_target(const Vec3& size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(size.cwiseProduct(Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1) - Vec3::Constant(0.5)));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh ball_target(double radius, int level) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  Mesh ball;
  ball.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  ball.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& v : ball.vertices) v.normalize();
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> centers;
    const auto center = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] = centers.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(ball.vertices.size()));
      if (fresh) ball.vertices.push_back((ball.vertices[a] + ball.vertices[b]).normalized());
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : ball.triangles) {
      const std::uint32_t a = center(t[0], t[1]), b = center(t[1], t[2]), c = center(t[2], t[0]);
      for (const Triangle& f : {Triangle{t[0], a, c}, Triangle{t[1], b, a}, Triangle{t[2], c, b}, Triangle{a, b, c}}) {
        finer.push_back(f);
      }
    }
    ball.triangles = std::move(finer);
  }
  // Mean distance of a facet's points from the centre, by the points of a rule that is exact for cubics.
  double sum = 0.0, area = 0.0;
  for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
    const auto [i, j, k] = ball.triangles[t];
    const Vec3 &a = ball.vertices[i], &b = ball.vertices[j], &c = ball.vertices[k];
    const double weight = ball.area_vector(t).norm();
    const double edges = ((a + b) / 2).norm() + ((b + c) / 2).norm() + ((c + a) / 2).norm();
    sum += weight *
           (3.0 / 60 * (a.norm() + b.norm() + c.norm()) + 8.0 / 60 * edges + 27.0 / 60 * ((a + b + c) / 3).norm());
    area += weight;
  }
  for (Vec3& v : ball.vertices) v *= radius * area / sum;
  return ball;
}

void Targets::add(const Mesh& mesh, const Pose& pose, const Surface& surface) {
  const std::size_t line = models_.size();
  models_.push_back(PartModel::from_mesh(mesh, "target " + std::to_string(line)));
  ScenePart part;
  part.id = static_cast<int>(line);
  part.line = line;
  part.pose = pose;
  part.state = PartState::fixed;
  scene_.parts.push_back(part);
  request_.bin.kind = Bin::Kind::none;
  request_.parts.emplace_back();
  surfaces_.lines.push_back(surface);
}

Scenery Targets::scenery() {
  return Scenery(scene_, {request_, models_}, *cache_);
}

}  // namespace bin_scenes
