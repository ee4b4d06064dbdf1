/// Checks a file, detects its format, and lets the reader of that format make a mesh of it.
#include "mesh_file.hpp"

#include "assimp_import.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "cad.hpp"
#include "collada.hpp"
#include "core/read_file.hpp"
#include "model_format.hpp"

#include <filesystem>
#include <stdexcept>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

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
    throw input_error("'solid' selects a solid of a STEP or IGES file, but this file is " + file.format, path,
                      "remove this key");
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
