#include "cad.hpp"

#include "bin_scenes/core/error.hpp"
#include "contained.hpp"
#include "mesh_bytes.hpp"

#include <algorithm>

namespace bin_scenes {

bool is_cad(const std::string& format) {
  return format == "STEP" || format == "IGES";
}

namespace cad {

template <class Stream>
void members(Stream& stream, Solids& solids) {
  stream(solids.complaint, solids.remedy, solids.mesh, solids.count, solids.metres_per_unit, solids.error,
         solids.flags);
}

namespace {

/// Curved surfaces take more time and memory for a byte than triangles do.
ContainedLimits limits_of(std::size_t bytes) {
  const double megabytes = 1e-6 * static_cast<double>(bytes);
  ContainedLimits limits;
  limits.cpu_seconds = static_cast<unsigned>(std::clamp(30.0 + 6.0 * megabytes, 30.0, 300.0));
  limits.bytes = static_cast<std::size_t>(1.5e9 + 80.0 * static_cast<double>(bytes));
  return limits;
}

}  // namespace

MeshFile read_contained(const std::string& bytes, const std::string& format, const std::string& path,
                        const LoadOptions& options) {
  if (!reads_cad())
    throw input_error("this build does not read " + format, path,
                      "install libocct-data-exchange-dev and build again, or export an STL file");
  const Contained child = run_contained(
      [&] {
        Solids solids = read_here(bytes, format, options);
        WriterInto<std::string> out;
        out(solids);
        return out.take();
      },
      limits_of(bytes.size()));
  if (!child.finished)
    throw input_error("cannot be read as " + format + ": OpenCASCADE " + child.failure, path,
                      "give a larger tessellation.chord, simplify the part, or export an STL file");
  Solids solids;
  ByteReader(child.output)(solids);
  if (!solids.complaint.empty()) throw input_error(solids.complaint, path, solids.remedy);
  MeshFile file;
  file.format = format;
  file.mesh = std::move(solids.mesh);
  file.meshes = solids.count;
  file.metres_per_unit = solids.metres_per_unit;
  file.tessellation_error = solids.error;
  file.flags = std::move(solids.flags);
  return file;
}

}  // namespace cad

}  // namespace bin_scenes
