/// A mesh in memory, as the repair gets it from any file: the first byte is the number of vertices, each with three
/// bytes on a coarse grid so that they meet; then triangles of three bytes each. What comes out is closed where that is
/// asked for.
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "fuzz.hpp"

using namespace bin_scenes;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::uint8_t how = data[0];
  const std::size_t count = data[1] % 64;
  if (count == 0 || size < 2 + 3 * count) return 0;
  Mesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* at = data + 2 + 3 * i;
    mesh.vertices.push_back(0.001 * Vec3(at[0] % 32, at[1] % 32, at[2] % 32));
    if (how & 4) mesh.vertices.back() += 1e-9 * Vec3(at[0] / 32, at[1] / 32, at[2] / 32);
  }
  for (std::size_t at = 2 + 3 * count; at + 3 <= size; at += 3) {
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = static_cast<std::uint32_t>(data[at + k] % count);
    mesh.triangles.push_back(triangle);
  }
  LoadOptions options;
  options.require_closed = how % 2 == 0;
  if (how & 2) options.thickness = 0.002;
  may_refuse([&] {
    const LoadedMesh loaded = repair_mesh(mesh, options, "mesh");
    if (options.require_closed && !loaded.report.closed) found("an open mesh where a closed one was asked for");
    for (const Vec3& vertex : loaded.mesh.vertices)
      if (!vertex.allFinite()) found("a vertex that is not finite");
    for (const Triangle& corners : loaded.mesh.triangles)
      for (const std::uint32_t corner : corners)
        if (corner >= loaded.mesh.vertices.size()) found("a triangle of a vertex that is not there");
  });
  return 0;
}
