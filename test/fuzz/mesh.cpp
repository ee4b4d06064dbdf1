/// A model file: the first byte chooses the ending of its name, the second how it is loaded.
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "fuzz.hpp"

#include <array>

using namespace bin_scenes;

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <pthread.h>
#include <sanitizer/common_interface_defs.h>

/// The child that parses may die: that is an answer. It must not leave its input behind as if it were a finding.
[[maybe_unused]] static const int child_dies_quietly =
    pthread_atfork(nullptr, nullptr, [] { __sanitizer_set_death_callback(nullptr); });
#endif
#endif

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  constexpr std::array<const char*, 6> endings = {".stl", ".obj", ".ply", ".dae", ".off", ""};
  ModelFile file;
  file.path = std::string("model") + endings[data[0] % endings.size()];
  file.bytes.assign(reinterpret_cast<const char*>(data + 2), size - 2);
  file.sha256 = sha256_hex(file.bytes);
  LoadOptions options;
  options.require_closed = data[1] % 2 == 0;
  if (data[1] & 2) options.thickness = 0.01;
  if (data[1] & 4) options.unit = Unit::millimetre;
  may_refuse([&] {
    const LoadedMesh loaded = load_mesh(file, options);
    for (const Vec3& vertex : loaded.mesh.vertices)
      if (!vertex.allFinite()) found("a vertex that is not finite");
    for (const Triangle& triangle : loaded.mesh.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= loaded.mesh.vertices.size()) found("a triangle of a vertex that is not there");
  });
  return 0;
}
