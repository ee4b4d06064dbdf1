#include "part_bytes.hpp"

namespace bin_scenes {

void put(ByteWriter& out, const Mesh& mesh) {
  out.put(static_cast<std::uint64_t>(mesh.vertices.size()));
  out.put_raw(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  out.put(static_cast<std::uint64_t>(mesh.triangles.size()));
  out.put_raw(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
}

void get(ByteReader& in, Mesh& mesh) {
  mesh.vertices.resize(in.count(sizeof(Vec3)));
  in.get_raw(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  mesh.triangles.resize(in.count(sizeof(Triangle)));
  in.get_raw(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
}

namespace {

/// The plain members of a load report, in one order for both directions.
template <class Report, class Each>
void for_each_member(Report& r, Each&& each) {
  each(r.format);
  each(r.file_vertices);
  each(r.file_triangles);
  each(r.meshes);
  each(r.welded_vertices);
  each(r.degenerate_removed);
  each(r.duplicate_removed);
  each(r.holes_closed);
  each(r.t_junctions_split);
  each(r.turned);
  each(r.open_edges);
  each(r.shells);
  each(r.inverted);
  each(r.closed);
  each(r.unit);
  each(r.metres_per_unit);
  each(r.file_metres_per_unit);
  each(r.tessellation_error);
  each(r.content_sha256);
}

}  // namespace

void put(ByteWriter& out, const LoadedMesh& loaded) {
  put(out, loaded.mesh);
  for_each_member(loaded.report, [&](const auto& member) { out.put(member); });
  out.put(static_cast<std::uint64_t>(loaded.report.flags.size()));
  for (const Flag& flag : loaded.report.flags) {
    out.put(flag.code);
    out.put(flag.text);
    out.put(flag.remedy);
  }
}

void get(ByteReader& in, LoadedMesh& loaded) {
  get(in, loaded.mesh);
  for_each_member(loaded.report, [&](auto& member) { in.get(member); });
  loaded.report.flags.resize(in.count(3 * sizeof(std::uint64_t)));
  for (Flag& flag : loaded.report.flags) {
    in.get(flag.code);
    in.get(flag.text);
    in.get(flag.remedy);
  }
}

void put(ByteWriter& out, const DistanceField& field) {
  out.put(field.origin);
  out.put(field.cell);
  for (const int n : field.nodes) out.put(n);
  out.put(field.coarsened);
  out.put(static_cast<std::uint64_t>(field.values.size()));
  out.put_raw(field.values.data(), field.values.size() * sizeof(float));
}

void get(ByteReader& in, DistanceField& field) {
  in.get(field.origin);
  in.get(field.cell);
  for (int& n : field.nodes) in.get(n);
  in.get(field.coarsened);
  field.values.resize(in.count(sizeof(float)));
  in.get_raw(field.values.data(), field.values.size() * sizeof(float));
}

void put(ByteWriter& out, const SampleSet& set) {
  out.put(set.cluster);
  out.put(static_cast<std::uint64_t>(set.samples.size()));
  for (const SurfaceSample& s : set.samples) {
    out.put(s.point);
    out.put(s.normal);
    out.put(s.spacing);
  }
}

void get(ByteReader& in, SampleSet& set) {
  in.get(set.cluster);
  set.samples.resize(in.count(7 * sizeof(double)));
  for (SurfaceSample& s : set.samples) {
    in.get(s.point);
    in.get(s.normal);
    in.get(s.spacing);
  }
}

void put(ByteWriter& out, const SphereSet& set) {
  out.put(set.pitch);
  out.put(static_cast<std::uint64_t>(set.interior_removed));
  out.put(static_cast<std::uint64_t>(set.spheres.size()));
  for (const Sphere& s : set.spheres) {
    out.put(s.center);
    out.put(s.radius);
    out.put(s.normal);
  }
}

void get(ByteReader& in, SphereSet& set) {
  in.get(set.pitch);
  in.get(set.interior_removed);
  set.spheres.resize(in.count(7 * sizeof(double)));
  for (Sphere& s : set.spheres) {
    in.get(s.center);
    in.get(s.radius);
    in.get(s.normal);
  }
}

void put(ByteWriter& out, const ConvexHulls& set) {
  out.put(set.surface_error);
  out.put(set.volume_error);
  out.put(set.met);
  out.put(static_cast<std::uint64_t>(set.hulls.size()));
  for (const Mesh& hull : set.hulls) put(out, hull);
}

void get(ByteReader& in, ConvexHulls& set) {
  in.get(set.surface_error);
  in.get(set.volume_error);
  in.get(set.met);
  set.hulls.resize(in.count(2 * sizeof(std::uint64_t)));
  for (Mesh& hull : set.hulls) get(in, hull);
}

}  // namespace bin_scenes
