/// The convex pieces of the sample parts are the parts, no more and no less: the referee's word hangs on it.
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/part/hull_geometry.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "referee.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace bin_scenes::bench {
namespace {

// Shares of the diagonal. Meshes are float32 and pieces are rounded to 1e-5 mm, 4e-7 of the smallest part.
constexpr double beside = 1e-5;     ///< how far from the surface a point is taken
constexpr double tolerance = 2e-6;  ///< how far a point may be from a piece that it is in: on the seam of two pieces

struct Sample {
  PartModelPtr part;
  std::vector<HullPlanes> hulls;

  explicit Sample(const std::string& name) {
    const std::string models = std::getenv("BIN_SCENES_MODELS");
    ::setenv("BIN_SCENES_CACHE", "off", 1);  // what this build makes of the file, not an older one
    LoadOptions options;
    options.unit = Unit::millimetre;
    part = PartModel::load(models + "/" + name + ".stl", options);
    for (const std::vector<Vec3>& piece : read_pieces(models + "/pieces/" + name + ".obj", 1e-3))
      if (const Mesh hull = convex_hull(piece, 1000); !hull.triangles.empty())
        hulls.emplace_back(hull);
      else
        ADD_FAILURE() << name << " has a flat piece";
  }
  double outside(const Vec3& p) const { return distance_to_union(hulls, p) / part->diagonal(); }
};

std::vector<std::string> samples() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::getenv("BIN_SCENES_MODELS") + std::string("/pieces")))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Pieces, EndWhereTheMeshEnds) {
  for (const std::string& name : samples()) {
    const Sample sample(name);
    const double step = beside * sample.part->diagonal();
    const Mesh& mesh = sample.part->mesh();
    std::size_t too_small = 0, too_large = 0;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
      const Vec3 normal = (b - a).cross(c - a).normalized();
      for (const Vec3& weights : {Vec3(1, 1, 1), Vec3(8, 1, 1), Vec3(1, 8, 1), Vec3(1, 1, 8)}) {
        const Vec3 on = (weights[0] * a + weights[1] * b + weights[2] * c) / weights.sum();
        too_small += sample.outside(on - step * normal) > tolerance ? 1 : 0;
        too_large += sample.outside(on + step * normal) < beside - tolerance ? 1 : 0;
      }
    }
    EXPECT_EQ(too_small, 0u) << name << " of " << 4 * mesh.triangles.size();
    EXPECT_EQ(too_large, 0u) << name << " of " << 4 * mesh.triangles.size();
  }
}

TEST(Pieces, FillTheMesh) {
  for (const std::string& name : samples()) {
    const Sample sample(name);
    const Aabb box = sample.part->mesh().bounds();
    Random random(1, 0, Stream::probe);
    std::size_t wrong = 0;
    for (int k = 0; k < 4000; ++k) {
      const Vec3 p(random.uniform(box.lower.x(), box.upper.x()), random.uniform(box.lower.y(), box.upper.y()),
                   random.uniform(box.lower.z(), box.upper.z()));
      const double inside = -sample.part->query().signed_distance(p) / sample.part->diagonal();
      if (std::abs(inside) < beside) continue;
      wrong += (inside > 0.0) != (sample.outside(p) <= tolerance) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u) << name;
  }
}

}  // namespace
}  // namespace bin_scenes::bench
