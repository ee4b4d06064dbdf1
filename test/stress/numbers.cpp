/// Many of everything: spheres per part, parts per scene, scenes per process.
#include "stress/stress.hpp"

namespace bin_scenes::stress {

namespace {

Case many_samples(std::size_t samples, std::size_t count) {
  Case c = a_case(std::to_string(samples) + " samples a part");
  c.request.bin.inner_size = Vec3(0.12, 0.1, 0.1);
  pour_in(c, "angle", angle(0.05, 0.01, 0.03), count).density = 2700.0;
  c.request.solver.sphere.coarse_samples = static_cast<int>(samples);
  c.request.solver.sphere.fine_samples = static_cast<int>(samples);
  return c;
}

/// The thesis stops at 4096 spheres a body. A cube of n voxels an edge has n^3 - (n-2)^3 of them at its surface.
Case many_voxels(int voxels, std::size_t count) {
  const int inside = voxels - 2, spheres = voxels * voxels * voxels - inside * inside * inside;
  Case c = a_case(std::to_string(spheres) + " spheres a part");
  c.request.bin.inner_size = Vec3(0.12, 0.1, 0.1);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < count; ++i) places.emplace_back(-0.03 + 0.055 * i, 0, 0.03);
  put(c, "cube", cube(0.05), places);
  c.request.solver.thesis.voxels = voxels;
  c.request.seconds = 0.2;
  c.expect.rests = false;
  return c;
}

/// Layers of cubes, `gap` between them, that fall on a floor and on each other: each must land, none may be lost.
Case many_parts(int across, int layers, double gap) {
  Case c = on_floor(std::to_string(across * across * layers) + " cubes fall on a floor");
  constexpr double edge = 0.03, pitch = 0.05, clearance = 0.005;  // m; clearance: of the lowest layer
  std::vector<Vec3> places;
  for (int i = 0; i < across * across * layers; ++i)
    places.emplace_back(pitch * (i % across) - 0.5 * pitch * across,
                        pitch * (i / across % across) - 0.5 * pitch * across,
                        clearance + 0.5 * edge + (edge + gap) * (i / (across * across)));
  put(c, "cube_30", cube(edge), places);
  // Until the highest lies on all others: below the ceiling there is no room for a layer that touches none.
  const double fall = clearance + gap * (layers - 1);
  c.request.seconds = 1.2 * std::sqrt(2.0 * fall / c.request.gravity.norm());
  c.expect.ceiling = edge * (layers - 0.5) + 0.5 * gap;
  c.expect.rests = false;
  return c;
}

Case many_scenes(std::size_t scenes, std::size_t parts, bool until_rest) {
  Case c = a_case(std::to_string(scenes) + " scenes in one process");
  c.request.bin.inner_size = Vec3(0.12, 0.1, 0.1);
  pour_in(c, "angle", angle(0.05, 0.01, 0.03), parts).density = 2700.0;
  c.request.scenes = scenes;
  if (!until_rest) c.request.seconds = 0.05;
  c.expect.rests = until_rest;
  c.expect.flat = true;
  c.expect.traced = false;
  c.expect.all_in = until_rest;
  return c;
}

}  // namespace

std::vector<Row> numbers(bool soak) {
  std::vector<Row> rows;
  rows.push_back({"number", "10,000 samples a part", {"sphere"}, {many_samples(10000, soak ? 10 : 3)}, {}});
  rows.push_back({"number", "10,000 spheres a part", {"thesis"}, {many_voxels(42, 2)}, {}});
  Row parts{"number", "parts in one scene", both, {}, {}};
  parts.cases.push_back(soak ? many_parts(50, 8, 0.02) : many_parts(20, 5, 0.02));
  rows.push_back(parts);
  Row on_gl{"number", "parts in one scene, thesis on OpenGL", {"thesis"}, {}, {}};
  on_gl.cases.push_back(soak ? many_parts(50, 8, 0.004) : many_parts(10, 5, 0.004));
  on_gl.cases[0].request.solver.thesis.voxels = 2;           // 8 spheres a cube: software OpenGL takes 128 MiB a buffer
  on_gl.cases[0].expect.penetration = 0.5 / std::sqrt(3.0);  // half an edge: its surface is as rough as its spheres
  rows.push_back(on_gl);
  Row large{"number", "parts in one scene, on OpenGL", {"sphere/gpu"}, {}, {}};
  large.cases.push_back(many_parts(6, 5, 0.004));  // 192 bodies are the most on software OpenGL
  rows.push_back(large);
  rows.push_back({"number", "scenes in one process", both, {many_scenes(1000, 3, soak)}, {}});
  rows.push_back(
      {"number", "scenes in one process, on OpenGL", {"sphere/gpu"}, {many_scenes(soak ? 200 : 50, 2, soak)}, {}});
  rows.push_back(
      {"number", "scenes in one process, thesis", {"thesis"}, {many_scenes(soak ? 1000 : 50, 3, false)}, {}});
  return rows;
}

}  // namespace bin_scenes::stress
