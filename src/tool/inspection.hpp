/// The results of `bin_scenes inspect` for a model, and the tables of keys from which its JSON and text outputs are
/// made. inspect.cpp fills in the results and prints them.
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
  // An open surface has no volume and therefore none of the following.
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
  v.field({"format", "", "Format of the file."}, file.format);
  v.field({"unit", "", "Unit of length of the file, or its length."}, file.unit);
  v.field({"metres_per_unit", "m", "Length of one unit of the file, as it was used."}, file.metres_per_unit);
  v.field({"meshes", "", "Number of meshes in the file; for STEP and IGES files, number of solids."}, file.meshes);
  v.field({"vertices", "", "Number of vertices before any repair."}, file.vertices);
  v.field({"triangles", "", "Number of triangles before any repair."}, file.triangles);
  v.field({"sha256", "", "SHA-256 of the file."}, file.sha256);
  v.field({"tessellation_error", "m", "Largest distance between a triangle and the true surface.", anything,
           file.tessellation_error > 0.0},
          file.tessellation_error);
  v.list({"flags", "", "Remark about a repair of the mesh."}, file.flags);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Mass& mass) {
  v.field({"volume", "m3", "Volume that the surface encloses."}, mass.volume);
  v.field({"area", "m2", "Area of the surface."}, mass.area);
  v.field({"center_of_mass", "m", "Centre of mass of the solid, in the frame of the model."}, mass.center);
  v.field({"inertia_at_1_kg_m3", "kg m2", "Inertia tensor about the centre of mass, at a density of 1 kg/m3."},
          mass.inertia);
  v.field({"principal_moments_at_1_kg_m3", "kg m2",
           "Moments of inertia about the principal axes, at a density of 1 kg/m3."},
          mass.principal);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Symmetry& symmetry) {
  v.field({"round_axes", "", "Number of axes about which the part may be turned by any angle."}, symmetry.round_axes);
  v.field({"discrete", "", "Number of further rotations after which the part looks the same."}, symmetry.discrete);
  v.field({"residual", "m", "Largest distance between the part and the turned part."}, symmetry.residual);
  v.field({"nearly", "", "Number of rotations that miss the tolerance by little (see `bin_scenes symmetries`)."},
          symmetry.nearly);
}

template <class Visitor>
void visit(Visitor& v, ShapeError& error) {
  v.field({"to_mesh_mean", "", "Mean distance from the shape to the mesh / diagonal."}, error.to_mesh_mean);
  v.field({"to_mesh_max", "", "Largest distance from the shape to the mesh / diagonal."}, error.to_mesh_max);
  v.field({"from_mesh_mean", "", "Mean distance from the mesh to the shape / diagonal."}, error.from_mesh_mean);
  v.field({"from_mesh_max", "", "Largest distance from the mesh to the shape / diagonal."}, error.from_mesh_max);
  v.field({"volume", "", "(Volume of the shape - volume of the mesh) / volume of the mesh."}, error.volume);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Spheres& spheres) {
  v.field({"count", "", "Number of spheres."}, spheres.count);
  v.section({"error", "", "Deviation of the shape from the mesh."}, spheres.error);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Samples& samples) {
  v.field({"count", "", "Number of surface samples."}, samples.count);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Field& field) {
  v.field({"nodes", "", "Numbers of nodes along x, y and z."}, field.nodes);
  v.section({"error", "", "Deviation of the shape from the mesh."}, field.error);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies::Hulls& hulls) {
  v.field({"count", "", "Number of hulls."}, hulls.count);
  v.field({"met", "",
           "False if the number of hulls in solver.bullet.max_hulls does not suffice for hull_error and "
           "hull_volume_error."},
          hulls.met);
  v.field({"surface_error", "", "Surface error that hull_error limits."}, hulls.surface_error);
  v.field({"volume_error", "", "Volume error that hull_volume_error limits."}, hulls.volume_error);
  v.section({"error", "", "Deviation of the shape from the mesh."}, hulls.error);
}

template <class Visitor>
void visit(Visitor& v, Inspection::Proxies& proxies) {
  v.section({"spheres", "", "Spheres of the solver sphere with the preset thesis."}, proxies.spheres);
  v.section({"samples", "", "Surface samples of the solver sphere."}, proxies.samples);
  v.section({"field", "", "Distance field of the solver sphere."}, proxies.field);
  v.section({"hulls", "", "Convex hulls of the solver bullet."}, proxies.hulls);
}

template <class Visitor>
void visit(Visitor& v, Inspection::CacheState& cache) {
  v.field({"directory", "", "Folder of the cache."}, cache.directory);
  v.field({"state", "", "warm: everything was there; cold: files were made; off: there is no cache."}, cache.state);
  v.field({"files_made", "", "Number of files that this call made."}, cache.files_made);
}

template <class Visitor>
void visit(Visitor& v, Inspection& found) {
  v.field({"model", "", "Path of the file."}, found.model);
  v.section({"file", "", "Contents of the file."}, found.file);
  v.field({"size", "m", "Size of the bounding box along x, y and z."}, found.size);
  v.field({"lower", "m", "Lower corner of the bounding box."}, found.lower);
  v.field({"diagonal", "m", "Diagonal of the bounding box."}, found.diagonal);
  v.field({"vertices", "", "Number of vertices after the repair."}, found.vertices);
  v.field({"triangles", "", "Number of triangles after the repair."}, found.triangles);
  v.field({"shells", "", "Number of connected components."}, found.shells);
  v.field({"watertight", "", "Whether the surface is closed, so that it has an inside."}, found.watertight);
  v.field({"open_edges", "",
           "Number of edges with only one triangle. Close them, or give the part a `thickness` in the request."},
          found.open_edges);
  v.section({"mass_properties", "", "Mass properties of the solid.", anything, found.watertight}, found.mass);
  v.section({"symmetries", "", "Symmetries of the solid.", anything, found.watertight}, found.symmetries);
  v.section({"proxies", "", "Collision shapes with the default settings of each solver.", anything, found.watertight},
            found.proxies);
  v.section({"cache", "", "Cache of prepared models."}, found.cache);
}

}  // namespace bin_scenes
