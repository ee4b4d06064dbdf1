/// Checks a file before assimp sees it: format by content, counts that it promises against its size. Then joins all its
/// meshes under the transforms of their nodes.
#include "mesh_file.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "cad.hpp"
#include "collada.hpp"
#include "contained.hpp"
#include "core/read_file.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <functional>
#include <sstream>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_triangles = 20'000'000;  // 2 GB in memory
const char* const formats = "give an STL, OBJ, PLY, DAE, OFF, STEP or IGES file";

/// Refuses what cannot be a model before any of it is read.
void check_file(const std::string& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (status.type() == fs::file_type::not_found) {
    throw input_error("no such model file", path,
                      "check the path; in a request, relative ones start from its file's folder");
  }
  if (failed) throw input_error("cannot be looked at: " + failed.message(), path, "check the folder's permissions");
  if (status.type() == fs::file_type::directory) throw input_error("is a folder", path, formats);
  if (status.type() != fs::file_type::regular) throw input_error("is not a regular file", path, formats);
  const std::uintmax_t size = fs::file_size(path, failed);
  if (!failed && size == 0) throw input_error("the file is empty", path, "export the model again");
  if (!failed && size > max_model_file_size) {
    throw input_error("the file has " + std::to_string(size >> 20) + " MiB, more than the " +
                          std::to_string(max_model_file_size >> 20) + " MiB that are read",
                      path, "reduce the mesh; a part of a pile needs at most some 100,000 triangles");
  }
}

bool starts_with(const std::string& bytes, const std::string& text) {
  return bytes.compare(0, text.size(), text) == 0;
}

/// STL in binary: 80 bytes, a count, 50 bytes a triangle. Its length gives it away even where the header says "solid".
std::optional<std::uint32_t> binary_stl_count(const std::string& bytes) {
  if (bytes.size() < 84) return std::nullopt;
  std::uint32_t count;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}
bool is_binary_stl(const std::string& bytes) {
  const auto count = binary_stl_count(bytes);
  return count && bytes.size() == 84 + 50 * static_cast<std::size_t>(*count);
}

/// Lines of 80 characters, of which the 73rd names the section, and the first section is the start.
bool is_iges(const std::string& bytes) {
  return bytes.size() > 80 && bytes.find_first_of("\r\n") == 80 && bytes[72] == 'S' &&
         std::atoi(bytes.substr(73, 7).c_str()) == 1;
}

std::string format_of_name(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  for (const char* known : {"STL", "OBJ", "PLY", "DAE", "OFF", "STEP", "IGES"}) {
    if (extension == std::string(".") + known) return known;
  }
  if (extension == ".STP") return "STEP";
  if (extension == ".IGS") return "IGES";
  return {};
}

/// Format by content, or empty; OBJ has no mark of its own.
std::string format_of_content(const std::string& bytes) {
  const std::string start = bytes.substr(0, 4096);
  if (is_binary_stl(bytes)) return "STL";
  if (starts_with(start, "ply\n") || starts_with(start, "ply\r")) return "PLY";
  if (start.find("<COLLADA") != std::string::npos) return "DAE";
  if (starts_with(start, "OFF\n") || starts_with(start, "OFF\r") || starts_with(start, "OFF ")) return "OFF";
  if (is_iges(bytes)) return "IGES";
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && start.compare(first, 12, "ISO-10303-21") == 0) return "STEP";
  if (first != std::string::npos && start.compare(first, 5, "solid") == 0 && start.find("facet") != std::string::npos) {
    return "STL";
  }
  return {};
}

/// Texts in UTF-16 (with byte order mark), which assimp's readers take for noise, as UTF-8.
std::optional<std::string> utf8_from_utf16(const std::string& bytes) {
  const bool little = starts_with(bytes, "\xff\xfe"), big = starts_with(bytes, "\xfe\xff");
  if (!little && !big) return std::nullopt;
  const iconv_t converter = iconv_open("UTF-8", little ? "UTF-16LE" : "UTF-16BE");
  if (converter == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  std::string source = bytes.substr(2), text(2 * bytes.size(), '\0');
  char *in = source.data(), *out = text.data();
  std::size_t in_left = source.size(), out_left = text.size();
  const std::size_t result = iconv(converter, &in, &in_left, &out, &out_left);
  iconv_close(converter);
  if (result == static_cast<std::size_t>(-1)) return std::nullopt;
  text.resize(text.size() - out_left);
  return text;
}

void check_counts_of_off(const std::string& bytes, const std::string& path) {
  std::uint64_t promised = 0;
  std::istringstream text(bytes.substr(0, 65536));
  std::string word;
  std::vector<std::string> words;
  while (words.size() < 3 && text >> word) {
    if (word[0] == '#') {
      std::getline(text, word);
    } else if (std::isdigit(static_cast<unsigned char>(word[0])) || word[0] == '-') {
      words.push_back(word);
    }
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(2, words.size()); ++i) {
    if (words[i][0] == '-') throw input_error("negative count in the header: " + words[i], path, "export it again");
    promised += std::min(std::strtoull(words[i].c_str(), nullptr, 10), 1ull << 60);
  }
  // assimp takes each from a line of its own, and aborts where there is none.
  const auto ends = [&](char end) { return std::count(bytes.begin(), bytes.end(), end); };
  const auto lines = static_cast<std::uint64_t>(1 + std::max(ends('\n'), ends('\r')));
  if (promised > lines) {
    throw input_error("the header promises " + words[0] + " vertices and " + (words.size() > 1 ? words[1] : "0") +
                          " faces, but the file has only " + std::to_string(lines) + " lines",
                      path, "the file is damaged or cut off: copy or export it again");
  }
}

void check_counts_of_ply(const std::string& bytes, const std::string& path) {
  std::uint64_t promised = 0;
  std::istringstream text(bytes.substr(0, 65536));
  std::string line;
  const std::string header = bytes.substr(0, 65536);
  if (header.find("\nend_header") == std::string::npos && header.find("\rend_header") == std::string::npos) {
    throw input_error("the file is cut off or damaged: its header has no end in its first 64 KiB", path,
                      "copy or export it again");  // assimp searches it for minutes
  }
  while (std::getline(text, line) && !starts_with(line, "end_header")) {
    std::istringstream words(line);
    std::string keyword, name;
    std::int64_t count = 0;
    if (!(words >> keyword >> name) || keyword != "element") continue;
    if (!(words >> count) || count < 0) {
      throw input_error("bad element count in the header: \"" + line + "\"", path, "export it again");
    }
    promised = std::max<std::uint64_t>(promised, static_cast<std::uint64_t>(count));
  }
  if (promised > bytes.size()) {
    throw input_error("the header promises " + std::to_string(promised) + " elements, but the file has only " +
                          std::to_string(bytes.size()) + " bytes",
                      path, "the file is damaged or cut off: copy or export it again");
  }
}

void check_counts_of_stl(const std::string& bytes, const std::string& path) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && bytes.compare(first, 5, "solid") == 0) return;
  const auto count = binary_stl_count(bytes);
  if (!count) {
    throw input_error("neither an ASCII STL (it does not begin with \"solid\") nor long enough for a binary one", path,
                      "export it again");
  }
  const std::size_t needed = 84 + 50 * static_cast<std::size_t>(*count);
  if (bytes.size() < needed) {
    throw input_error("the file is cut off: its header promises " + std::to_string(*count) + " triangles, " +
                          std::to_string(needed) + " bytes, but it has " + std::to_string(bytes.size()) + " bytes",
                      path, "copy or export it again");
  }
}

/// Refuses a header that promises more than the file can hold: assimp would believe it and ask for the memory.
void check_promised_counts(const std::string& bytes, const std::string& format, const std::string& path) {
  if (format == "OFF") check_counts_of_off(bytes, path);
  if (format == "PLY") check_counts_of_ply(bytes, path);
  if (format == "STL") check_counts_of_stl(bytes, path);
}

Eigen::Affine3d affine(const aiMatrix4x4& m) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4;
  return transform;
}

/// What assimp makes of a file, or its complaint.
struct Import {
  std::string complaint;  ///< empty if it was read
  Mesh mesh;
  std::uint64_t meshes = 0, points = 0, lines = 0;
};

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

template <class T>
void put(std::string& to, const T* from, std::size_t count) {
  to.append(reinterpret_cast<const char*>(from), count * sizeof(T));
}
template <class T>
void take(const std::string& from, std::size_t& offset, T* to, std::size_t count) {
  if (count == 0) return;  // an empty vector has no place to copy to
  std::memcpy(static_cast<void*>(to), from.data() + offset, count * sizeof(T));
  offset += count * sizeof(T);
}

/// What a file may cost: ten times what assimp takes for the dearest format, an XML of many short numbers.
ContainedLimits limits_of(std::size_t bytes) {
  const double megabytes = 1e-6 * static_cast<double>(bytes);
  ContainedLimits limits;
  limits.cpu_seconds = static_cast<unsigned>(std::clamp(2.0 * megabytes, 1.0, 120.0));
  limits.bytes = static_cast<std::size_t>(256e6 + 200.0 * static_cast<double>(bytes));
  return limits;
}

/// assimp in a process of its own; the result comes back through a pipe.
Import import_contained(const std::string& bytes, const std::string& format) {
  using Counts = std::array<std::uint64_t, 6>;
  const Contained child = run_contained(
      [&] {
        const Import import = import_here(bytes, format);
        const Counts counts = {import.complaint.size(),
                               import.mesh.vertices.size(),
                               import.mesh.triangles.size(),
                               import.meshes,
                               import.points,
                               import.lines};
        std::string output;
        put(output, counts.data(), counts.size());
        put(output, import.complaint.data(), counts[0]);
        put(output, import.mesh.vertices.data(), counts[1]);
        put(output, import.mesh.triangles.data(), counts[2]);
        return output;
      },
      limits_of(bytes.size()));
  Import import;
  if (!child.finished) {
    import.complaint = "assimp " + child.failure;
    return import;
  }
  Counts counts;
  std::size_t offset = 0;
  take(child.output, offset, counts.data(), counts.size());
  import.complaint.resize(counts[0]);
  import.mesh.vertices.resize(counts[1]);
  import.mesh.triangles.resize(counts[2]);
  take(child.output, offset, import.complaint.data(), counts[0]);
  take(child.output, offset, import.mesh.vertices.data(), counts[1]);
  take(child.output, offset, import.mesh.triangles.data(), counts[2]);
  import.meshes = counts[3];
  import.points = counts[4];
  import.lines = counts[5];
  std::replace(import.complaint.begin(), import.complaint.end(), '\n', ' ');
  return import;
}

}  // namespace

ModelFile read_model_file(const std::string& path) {
  check_file(path);
  ModelFile file{path, read_file(path), {}};
  file.sha256 = sha256_hex(file.bytes);
  return file;
}

namespace {

/// Unit and axes that a Collada file states.
void read_asset(const std::string& bytes, const std::string& path, MeshFile& file) {
  collada::Asset asset;
  try {
    asset = collada::read_asset(bytes);
  } catch (const std::runtime_error& error) {
    throw input_error(error.what(), path, "export it again");
  }
  file.metres_per_unit = asset.metres_per_unit.value_or(1.0);
  if (asset.up_axis != "Z_UP") {
    // As RViz and Gazebo do, so that a marker of the file and the pose of the part agree.
    file.flags.push_back({"up_axis", "the file says " + asset.up_axis + "; its coordinates are kept as they are",
                          "poses refer to the file's own axes: nothing to do unless a given pose assumes z up"});
  }
}

[[noreturn]] void refuse_without_faces(const Import& import, const std::string& path) {
  const std::string what = import.points + import.lines > 0
                               ? "holds " + std::to_string(import.points) + " points and " +
                                     std::to_string(import.lines) + " lines, but no faces"
                           : import.meshes > 0 ? "holds no faces"
                                               : "holds no mesh";
  throw input_error(what, path, "a part needs a closed surface of triangles: export it as a mesh");
}

}  // namespace

MeshFile parse_mesh_file(const ModelFile& model, const LoadOptions& options) {
  const std::string& path = model.path;
  MeshFile file;
  const std::optional<std::string> text = utf8_from_utf16(model.bytes);
  const std::string& bytes = text ? *text : model.bytes;
  if (text) {
    file.flags.push_back({"file_mended", "the file is UTF-16 text and was read as UTF-8", "save it as UTF-8"});
  }

  const std::string content = format_of_content(bytes);
  file.format = format_of_name(path);
  if (file.format.empty()) file.format = content;
  if (file.format.empty()) throw input_error("not a model format that is read here", path, formats);
  if (!content.empty() && content != file.format) {
    throw input_error("is named ." + file.format + ", but its contents are " + content, path, "rename the file");
  }
  check_promised_counts(bytes, file.format, path);

  if (is_cad(file.format)) {
    if (content.empty())
      throw input_error("is named ." + file.format + ", but its contents are not", path, "copy or export it again");
    return cad::read_contained(bytes, file.format, path, options);
  }
  if (!options.solid.empty())
    throw input_error("'solid' chooses one of a STEP or IGES file, and this is " + file.format, path, "leave it out");
  if (file.format == "DAE") read_asset(bytes, path, file);
  Import import = import_contained(bytes, file.format);
  if (!import.complaint.empty() && file.format == "DAE") {
    const std::string complaint = import.complaint;
    import = import_contained(collada::geometry_only(bytes), file.format);
    if (import.complaint.empty()) {
      file.flags.push_back({"file_mended",
                            "refused as it is (" + complaint +
                                "), but read without its images, materials, lights, cameras and animations",
                            "remove or complete what the complaint names; the shape does not need it"});
    } else {
      import.complaint = complaint;
    }
  }
  if (!import.complaint.empty()) {
    throw input_error("cannot be read as " + file.format + ": " + import.complaint, path,
                      "correct what is named or export it again");
  }
  if (import.mesh.triangles.empty()) refuse_without_faces(import, path);
  if (import.points + import.lines > 0) {
    file.flags.push_back({"not_faces",
                          std::to_string(import.points) + " points and " + std::to_string(import.lines) +
                              " lines of the file bound nothing and were left out",
                          "remove them from the file"});
  }
  file.meshes = import.meshes;
  file.mesh = std::move(import.mesh);
  return file;
}

}  // namespace bin_scenes
