/// Lists the members of collision shapes for byte streams (core/byte_stream.hpp), with which the disk cache stores
/// them. The cache verifies that the bytes are those that were written, and its key contains the format version;
/// reading therefore guards only against running past the end.
#pragma once

#include "bin_scenes/core/cache.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/part/convex_hulls.hpp"
#include "bin_scenes/part/distance_field.hpp"
#include "bin_scenes/part/samples.hpp"
#include "bin_scenes/part/spheres.hpp"
#include "mesh/mesh_bytes.hpp"

namespace bin_scenes {

/// Increase it whenever a layout below or the construction of a shape changes, so that older files are ignored.
constexpr int part_format = 8;

using ByteWriter = WriterInto<Bytes>;

template <class Stream>
void members(Stream& stream, Pose& pose) {
  stream(pose.position);
  stream.raw(pose.orientation.coeffs().data(), 4 * sizeof(double));
}

template <class Stream>
void members(Stream& stream, LoadReport& r) {
  stream(r.format, r.file_vertices, r.file_triangles, r.meshes, r.welded_vertices, r.degenerate_removed,
         r.duplicate_removed, r.holes_closed, r.t_junctions_split, r.turned, r.open_edges, r.shells, r.inverted,
         r.closed, r.unit, r.metres_per_unit, r.file_metres_per_unit, r.tessellation_error, r.content_sha256, r.flags);
}

template <class Stream>
void members(Stream& stream, LoadedMesh& loaded) {
  stream(loaded.mesh, loaded.report);
}

template <class Stream>
void members(Stream& stream, DistanceField& field) {
  stream(field.origin, field.cell, field.nodes, field.coarsened, field.values);
}

template <class Stream>
void members(Stream& stream, SurfaceSample& sample) {
  stream(sample.point, sample.normal, sample.spacing);
}

template <class Stream>
void members(Stream& stream, SampleSet& set) {
  stream(set.cluster, set.samples);
}

template <class Stream>
void members(Stream& stream, Sphere& sphere) {
  stream(sphere.center, sphere.radius, sphere.normal);
}

template <class Stream>
void members(Stream& stream, SphereSet& set) {
  stream(set.pitch, set.interior_removed, set.spheres);
}

template <class Stream>
void members(Stream& stream, ConvexHulls& set) {
  stream(set.surface_error, set.volume_error, set.met, set.hulls);
}

}  // namespace bin_scenes
