#include "output/ply.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/read_file.hpp"
#include "output/png.hpp"

#include <cstdlib>
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

Mesh read_ply(const std::string& path) {
  const std::string bytes = read_file(path), end = "end_header\n";
  const auto count = [&](const std::string& element) {
    const std::size_t found = bytes.find("element " + element + " ");
    return found == std::string::npos ? 0 : std::strtoul(bytes.c_str() + found + 9 + element.size(), nullptr, 10);
  };
  const std::size_t vertices = count("vertex"), faces = count("face"), head = bytes.find(end);
  if (head == std::string::npos || vertices > bytes.size() || faces > bytes.size() ||
      bytes.size() != head + end.size() + 12 * vertices + 13 * faces)
    throw input_error("is no whole PLY of this project", path, "run the plan into its folder again");
  const char* at = bytes.data() + head + end.size();
  Mesh mesh;
  for (std::size_t i = 0; i < vertices; ++i, at += 12) {
    Eigen::Vector3f vertex;
    std::memcpy(vertex.data(), at, 12);
    mesh.vertices.emplace_back(vertex.cast<double>());
  }
  for (std::size_t i = 0; i < faces; ++i, at += 13) {
    mesh.triangles.emplace_back();
    std::memcpy(mesh.triangles.back().data(), at + 1, 12);
  }
  return mesh;
}

}  // namespace bin_scenes
