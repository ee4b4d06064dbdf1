#include "cad.hpp"

#include "bin_scenes/core/error.hpp"
#include "contained.hpp"

#include <algorithm>
#include <cstring>

namespace bin_scenes {

bool is_cad(const std::string& format) {
  return format == "STEP" || format == "IGES";
}

namespace cad {

namespace {

/// Numbers and texts one after the other.
class Packer {
 public:
  template <class T>
  void numbers(const std::vector<T>& values) {
    number(static_cast<double>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void number(double value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void text(const std::string& value) {
    number(static_cast<double>(value.size()));
    bytes_ += value;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Unpacker {
 public:
  explicit Unpacker(const std::string& bytes) : bytes_(bytes) {}
  template <class T>
  void numbers(std::vector<T>& values) {
    values.resize(static_cast<std::size_t>(number()));
    if (!values.empty())
      std::memcpy(static_cast<void*>(values.data()), take(values.size() * sizeof(T)), values.size() * sizeof(T));
  }
  double number() {
    double value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  std::string text() {
    const auto size = static_cast<std::size_t>(number());
    return std::string(take(size), size);
  }

 private:
  const char* take(std::size_t size) {
    const char* at = bytes_.data() + at_;
    at_ += size;
    return at;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::string packed(const Solids& solids) {
  Packer out;
  out.text(solids.complaint);
  out.text(solids.remedy);
  out.numbers(solids.mesh.vertices);
  out.numbers(solids.mesh.triangles);
  for (const double value : {static_cast<double>(solids.count), solids.metres_per_unit, solids.error})
    out.number(value);
  out.number(static_cast<double>(solids.flags.size()));
  for (const Flag& flag : solids.flags)
    for (const std::string* text : {&flag.code, &flag.text, &flag.remedy}) out.text(*text);
  return out.take();
}

Solids unpacked(const std::string& bytes) {
  Unpacker in(bytes);
  Solids solids;
  solids.complaint = in.text();
  solids.remedy = in.text();
  in.numbers(solids.mesh.vertices);
  in.numbers(solids.mesh.triangles);
  solids.count = static_cast<std::uint64_t>(in.number());
  solids.metres_per_unit = in.number();
  solids.error = in.number();
  solids.flags.resize(static_cast<std::size_t>(in.number()));
  for (Flag& flag : solids.flags)
    for (std::string* text : {&flag.code, &flag.text, &flag.remedy}) *text = in.text();
  return solids;
}

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
  const Contained child =
      run_contained([&] { return packed(read_here(bytes, format, options)); }, limits_of(bytes.size()));
  if (!child.finished)
    throw input_error("cannot be read as " + format + ": OpenCASCADE " + child.failure, path,
                      "give a larger tessellation.chord, simplify the part, or export an STL file");
  Solids solids = unpacked(child.output);
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
