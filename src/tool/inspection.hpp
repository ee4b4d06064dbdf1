/// What `inspect` states of a model, and the tables of it that its JSON and its text are both made from. inspect.cpp
/// fills it in and prints it.
#pragma once

#include "bin_scenes/part/shape_error.hpp"

#include "scene/report_keys.hpp"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace bin_scenes {

struct Inspection {
  std::string model;
  struct File {
    std::string format, unit;
    double metres_per_unit = 1.0;
    std::size_t meshes = 0, vertices = 0, triangles = 0;
    std::string sha256;
    double tessellation_error = 0.0;
    std::vector<Flag> flags;
  } file;
  Vec3 size = Vec3::Zero(), lower = Vec3::Zero();
  double diagonal = 0.0;
  std::size_t vertices = 0, triangles = 0, shells = 0;
  bool watertight = false;
  std::size_t open_edges = 0;
  // An open surface has no volume, and none of these.
  struct Mass {
    double volume = 0.0, area = 0.0;
    Vec3 center = Vec3::Zero();
    std::vector<Vec3> inertia;
    Vec3 principal = Vec3::Zero();
  } mass;
  struct Symmetry {
    std::size_t round_axes = 0, discrete = 0;
    double residual = 0.0;
    std::size_t nearly = 0;
  } symmetries;
  struct Proxies {
    struct Spheres {
      std::size_t count = 0;
      ShapeError error;
    } spheres;
    struct Samples {
      std::size_t count = 0;
    } samples;
    struct Field {
      std::array<int, 3> nodes{};
      ShapeError error;
    } field;
    struct Hulls {
      std::size_t count = 0;
      bool met = false;
      double surface_error = 0.0, volume_error = 0.0;
      ShapeError error;
    } hulls;
  } proxies;
  struct CacheState {
    std::string directory, state;
    std::size_t files_made = 0;
  } cache;
};

template <class Visitor>
void visit(Visitor& v, Inspection::File& file) {
  v.field({"format", "", "of the file"}, file.format);
  v.field({"unit", "", "unit of length of the file, or its length"}, file.unit);
  v.field({"metres_per_unit", "m", "factor that was used"}, file.metres_per_unit);
  v.field({"meshes", "", "meshes in the file; of STEP and IGES files, solids"}, file.meshes);
  v.field({"vertices", "", "before any repair"}, file.vertices);
  v.field({"triangles", "", "before any repair"}, file.triangles);
  v.field({"sha256", "", "digest of the bytes of the file"}, file.sha256);
  v.field({"tessellation_error", "m", "largest distance of a triangle from the true surface", anything,
           file.tessellation_error > 0.0},
          file.tessellation_error);
  v.list({"flags", "", "one for each repair"}, file.flags);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Mass& mass) {
  v.field({"volume", "m3", "that the surface encloses"}, mass.volume);
  v.field({"area", "m2", "of the surface"}, mass.area);
  v.field({"center_of_mass", "m", "centre of the volume"}, mass.center);
  v.field({"inertia_at_1_kg_m3", "kg m2", "tensor about the centre of mass, at a density of 1 kg/m3"}, mass.inertia);
  v.field({"principal_moments_at_1_kg_m3", "kg m2", "moments about the principal axes"}, mass.principal);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Symmetry& symmetry) {
  v.field({"round_axes", "", "axes about which the part may be turned by any angle"}, symmetry.round_axes);
  v.field({"discrete", "", "further turns after which the part looks the same"}, symmetry.discrete);
  v.field({"residual", "m", "largest distance between the part and the turned part"}, symmetry.residual);
  v.field({"nearly", "", "turns that miss the tolerance by little (bin_scenes symmetries)"}, symmetry.nearly);
}

template <class Visitor>
void visit(Visitor& v, ShapeError& error) {
  v.field({"to_mesh_mean", "", "mean distance from the shape to the mesh / diagonal"}, error.to_mesh_mean);
  v.field({"to_mesh_max", "", "largest distance from the shape to the mesh / diagonal"}, error.to_mesh_max);
  v.field({"from_mesh_mean", "", "mean distance from the mesh to the shape / diagonal"}, error.from_mesh_mean);
  v.field({"from_mesh_max", "", "largest distance from the mesh to the shape / diagonal"}, error.from_mesh_max);
  v.field({"volume", "", "(volume of the shape - volume of the mesh) / volume of the mesh"}, error.volume);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Spheres& spheres) {
  v.field({"count", "", "number of spheres"}, spheres.count);
  v.section({"error", "", "how far the shape is from the mesh"}, spheres.error);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Samples& samples) {
  v.field({"count", "", "number of points of the surface"}, samples.count);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Field& field) {
  v.field({"nodes", "", "numbers of nodes along x, y and z"}, field.nodes);
  v.section({"error", "", "how far the shape is from the mesh"}, field.error);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Hulls& hulls) {
  v.field({"count", "", "number of hulls"}, hulls.count);
  v.field({"met", "", "false: solver.bullet.max_hulls hulls miss hull_error or hull_volume_error"}, hulls.met);
  v.field({"surface_error", "", "that hull_error limits"}, hulls.surface_error);
  v.field({"volume_error", "", "that hull_volume_error limits"}, hulls.volume_error);
  v.section({"error", "", "how far the shape is from the mesh"}, hulls.error);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies& proxies) {
  v.section({"spheres", "", "shape of the solver thesis"}, proxies.spheres);
  v.section({"samples", "", "points of the solver sphere"}, proxies.samples);
  v.section({"field", "", "distance field of the solver sphere"}, proxies.field);
  v.section({"hulls", "", "convex hulls of the solver bullet"}, proxies.hulls);
}

template <class Visitor>
void visit(Visitor& v, Inspection::CacheState& cache) {
  v.field({"directory", "", "of the cache"}, cache.directory);
  v.field({"state", "", "warm: all was there; cold: files were made; off"}, cache.state);
  v.field({"files_made", "", "by this call"}, cache.files_made);
}

template <class Visitor>
void visit(Visitor& v, Inspection& found) {
  v.field({"model", "", "file"}, found.model);
  v.section({"file", "", "what the file contains"}, found.file);
  v.field({"size", "m", "of the bounding box"}, found.size);
  v.field({"lower", "m", "lower corner of the bounding box"}, found.lower);
  v.field({"diagonal", "m", "of the bounding box"}, found.diagonal);
  v.field({"vertices", "", "after the repair"}, found.vertices);
  v.field({"triangles", "", "after the repair"}, found.triangles);
  v.field({"shells", "", "connected components"}, found.shells);
  v.field({"watertight", "", "whether the surface is closed, and so has an inside"}, found.watertight);
  v.field({"open_edges", "", "edges with one triangle: close them, or give the part a `thickness` in the request"},
          found.open_edges);
  v.section({"mass_properties", "", "of the solid", anything, found.watertight}, found.mass);
  v.section({"symmetries", "", "of the solid", anything, found.watertight}, found.symmetries);
  v.section({"proxies", "", "collision shapes with the default settings of each solver", anything, found.watertight},
            found.proxies);
  v.section({"cache", "", "of prepared models"}, found.cache);
}

}  // namespace bin_scenes
