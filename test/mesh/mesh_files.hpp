/// Files of meshes in every format, and what loading them says.
#pragma once

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace bin_scenes::test {

namespace fs = std::filesystem;

inline double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6.0;
  }
  return sum;
}

inline std::string stl_ascii(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid part\n";
  for (const Triangle& t : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) out << "vertex " << mesh.vertices[v].transpose() << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid part\n";
  return out.str();
}

inline std::string stl_binary(const Mesh& mesh, const std::string& header = "made by a test") {
  std::string out = header;
  out.resize(80, ' ');
  const auto put = [&](const void* data, std::size_t size) { out.append(static_cast<const char*>(data), size); };
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  put(&count, 4);
  for (const Triangle& t : mesh.triangles) {
    float numbers[12] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) numbers[3 + 3 * k + i] = static_cast<float>(mesh.vertices[t[k]][i]);
    }
    put(numbers, sizeof numbers);
    put("\0\0", 2);
  }
  return out;
}

inline std::string obj(const Mesh& mesh) {
  std::ostringstream out;
  for (const Vec3& v : mesh.vertices) out << "v " << v.transpose() << "\n";
  for (const Triangle& t : mesh.triangles) out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return out.str();
}

inline std::string off(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
  for (const Vec3& v : mesh.vertices) out << v.transpose() << "\n";
  for (const Triangle& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

inline std::string ply(const Mesh& mesh) {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) out << v.transpose() << "\n";
  for (const Triangle& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

class MeshLoader : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("bin_scenes_loader_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }

  /// The error a call gives; its where() is the path, its remedy is not empty.
  template <class Call>
  std::string error_of(Call&& call, const std::string& where) const {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_EQ(error.where(), where);
      EXPECT_FALSE(error.remedy().empty());
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  }
  std::string load_error(const std::string& path, const LoadOptions& options = {}) const {
    return error_of([&] { load_mesh(path, options); }, path);
  }
  std::string repair_error(const Mesh& mesh, const LoadOptions& options = {}) const {
    return error_of([&] { repair_mesh(mesh, options, "part"); }, "part");
  }

  fs::path folder_;
};

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
#define EXPECT_CONTAINS(text, part) EXPECT_PRED2(contains, text, part)

inline bool has_flag(const LoadReport& report, const std::string& code) {
  for (const Flag& flag : report.flags) {
    if (flag.code == code) return !flag.text.empty() && !flag.remedy.empty();
  }
  return false;
}

}  // namespace bin_scenes::test
