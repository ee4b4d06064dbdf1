#include "bin_scenes/output/scene_writer.hpp"
#include "output/png.hpp"

#include <cstring>

namespace bin_scenes {

namespace {
template <class Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &value, sizeof(Number));
  bytes.append(raw, sizeof(Number));
}
}  // namespace

void write_ply(const std::string& path, const Mesh& mesh, double scale) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) {
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(scale * v[i]));
  }
  for (const Triangle& t : mesh.triangles) {
    bytes.push_back(3);
    for (const std::uint32_t index : t) append(bytes, static_cast<std::int32_t>(index));
  }
  write_bytes(path, bytes.data(), bytes.size());
}

}  // namespace bin_scenes
