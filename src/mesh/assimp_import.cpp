/// Joins all meshes that assimp finds in a file under the transforms of their nodes, in a process that may crash or
/// take too long.
#include "assimp_import.hpp"

#include "contained.hpp"
#include "mesh_bytes.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cstring>
#include <functional>
#include <stdexcept>

namespace bin_scenes {

template <class Stream>
void members(Stream& stream, Import& import) {
  stream(import.complaint, import.mesh, import.meshes, import.points, import.lines);
}

namespace {

constexpr std::size_t max_triangles = 20'000'000;  // 2 GB in memory

Eigen::Affine3d affine(const aiMatrix4x4& m) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return transform;
}

void append(Import& import, const aiMesh& source, const Eigen::Affine3d& transform) {
  Mesh& mesh = import.mesh;
  const std::size_t base = mesh.vertices.size();
  // A mirror image turns the winding inside out.
  const bool mirrored = transform.linear().determinant() < 0.0;
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D& v = source.mVertices[i];
    mesh.vertices.push_back(transform * Vec3(v.x, v.y, v.z));
  }
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) {
      ++(face.mNumIndices == 1 ? import.points : import.lines);
      continue;
    }
    Triangle t;
    for (int k = 0; k < 3; ++k) {
      const unsigned index = face.mIndices[k];
      if (index >= source.mNumVertices) {
        throw std::runtime_error("a face names vertex " + std::to_string(index) + " of " +
                                 std::to_string(source.mNumVertices));
      }
      t[k] = static_cast<std::uint32_t>(base + index);
    }
    if (mirrored) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }
  if (mesh.triangles.size() > max_triangles || mesh.vertices.size() > 3 * max_triangles) {
    throw std::runtime_error("it has more than " + std::to_string(max_triangles) + " triangles");
  }
}

void append(Import& import, const aiScene& scene, bool ignore_root_transform) {
  const std::function<void(const aiNode&, const Eigen::Affine3d&)> visit = [&](const aiNode& node,
                                                                               const Eigen::Affine3d& parent) {
    const bool is_root = &node == scene.mRootNode;
    const Eigen::Affine3d here = is_root && ignore_root_transform ? parent : parent * affine(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) append(import, *scene.mMeshes[node.mMeshes[i]], here);
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], here);
  };
  if (scene.mRootNode) visit(*scene.mRootNode, Eigen::Affine3d::Identity());
}

Import import_here(const std::string& bytes, const std::string& format) {
  Import result;
  try {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene* scene =
        importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, format.c_str());
    if (!scene) {
      result.complaint = std::string("assimp: ") + importer.GetErrorString();
      return result;
    }
    result.meshes = scene->mNumMeshes;
    // assimp puts the unit into the root transform of a COLLADA scene, in single precision; it is applied later here.
    append(result, *scene, format == "DAE");
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    result.complaint = error.what();
  }
  return result;
}

/// What a file may cost: ten times what assimp takes for the dearest format, an XML of many short numbers.
ContainedLimits limits_of(std::size_t bytes) {
  const double megabytes = 1e-6 * static_cast<double>(bytes);
  ContainedLimits limits;
  limits.cpu_seconds = static_cast<unsigned>(std::clamp(2.0 * megabytes, 1.0, 120.0));
  limits.bytes = static_cast<std::size_t>(256e6 + 200.0 * static_cast<double>(bytes));
  return limits;
}

}  // namespace

Import import_contained(const std::string& bytes, const std::string& format) {
  const Contained child = run_contained(
      [&] {
        Import import = import_here(bytes, format);
        WriterInto<std::string> out;
        out(import);
        return out.take();
      },
      limits_of(bytes.size()));
  Import import;
  if (!child.finished) {
    import.complaint = "assimp " + child.failure;
    return import;
  }
  ByteReader(child.output)(import);
  std::replace(import.complaint.begin(), import.complaint.end(), '\n', ' ');
  return import;
}

}  // namespace bin_scenes
