/// Lists the members of meshes and flags for byte streams (core/byte_stream.hpp), which the disk cache and contained
/// processes use. A new member of these structs must be added here.
#pragma once

#include "bin_scenes/mesh/mesh.hpp"
#include "bin_scenes/scene/report.hpp"
#include "core/byte_stream.hpp"

namespace bin_scenes {

template <class Stream>
void members(Stream& stream, Mesh& mesh) {
  stream(mesh.vertices, mesh.triangles);
}

template <class Stream>
void members(Stream& stream, Flag& flag) {
  stream(flag.code, flag.text, flag.remedy);
}

}  // namespace bin_scenes
