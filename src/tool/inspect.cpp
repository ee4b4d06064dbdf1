/// The command `inspect`: what a model file is, its mass, holes, symmetries, and the error of each solver's shape, as
/// text or JSON.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/cache.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/part/symmetry.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"
#include "tool/unit_option.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace bin_scenes {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json json_of(const ShapeError& e) {
  return {{"to_mesh_mean", e.to_mesh_mean},
          {"to_mesh_max", e.to_mesh_max},
          {"from_mesh_mean", e.from_mesh_mean},
          {"from_mesh_max", e.from_mesh_max},
          {"volume", e.volume}};
}

/// Its name, or for one without (a COLLADA file in feet) its length.
std::string unit_text(const LoadReport& report) {
  if (metres_per(report.unit) == report.metres_per_unit) return name_of(report.unit);
  std::ostringstream text;
  text << report.metres_per_unit << " m";
  return text.str();
}

std::size_t files_below(const std::string& directory) {
  std::size_t count = 0;
  std::error_code error;
  if (directory.empty()) return 0;
  for (auto it = std::filesystem::recursive_directory_iterator(directory, error);
       !error && it != std::filesystem::recursive_directory_iterator(); it.increment(error)) {
    ++count;
  }
  return count;
}

Json file_json(const LoadReport& report) {
  Json json = {
      {"format", report.format},        {"unit", unit_text(report)},        {"metres_per_unit", report.metres_per_unit},
      {"meshes", report.meshes},        {"vertices", report.file_vertices}, {"triangles", report.file_triangles},
      {"sha256", report.content_sha256}};
  if (report.tessellation_error > 0.0) json["tessellation_error"] = report.tessellation_error;
  Json& flags = json["flags"] = Json::array();
  for (const Flag& flag : report.flags) {
    flags.push_back({{"code", flag.code}, {"text", flag.text}, {"remedy", flag.remedy}});
  }
  return json;
}

Json mass_json(const MassProperties& mass) {
  Json inertia = Json::array();
  for (int i = 0; i < 3; ++i) inertia.push_back({mass.inertia(i, 0), mass.inertia(i, 1), mass.inertia(i, 2)});
  return {{"volume", mass.volume},
          {"area", mass.area},
          {"center_of_mass", json_of(mass.center)},
          {"inertia_at_1_kg_m3", inertia},
          {"principal_moments_at_1_kg_m3", json_of(mass.principal)}};
}

/// Those that `bullet` works on with its default settings.
HullOptions default_hulls() {
  const SolverSettings defaults;
  HullOptions hulls;
  hulls.max_error = defaults.bullet.hull_error;
  hulls.max_volume_error = defaults.bullet.hull_volume_error;
  hulls.max_hulls = defaults.bullet.max_hulls;
  return hulls;
}

VoxelOptions default_voxels() {
  const SolverSettings defaults;
  VoxelOptions voxels;
  voxels.voxels = defaults.thesis.voxels;
  voxels.tightness = defaults.thesis.tightness;
  return voxels;
}
FieldOptions default_field() {
  FieldOptions field;
  field.cell = SolverSettings().sphere.field_cell;
  return field;
}
std::size_t sample_count(const PartModel& part) {
  SampleOptions samples;
  samples.count = SolverSettings().sphere.fine_samples;
  return part.samples(samples).samples.size();
}

/// The model keeps the proxies that each solver makes of it with its default settings.
struct Inspection {
  PartModelPtr part;
  SymmetryReport symmetries;         ///< only of a closed surface, and so the errors: an open one has no volume
  ShapeError spheres, field, hulls;  ///< fractions of the diagonal
  std::string cache;
  std::size_t files_made = 0;  ///< in the cache

  const char* cache_state() const { return cache.empty() ? "off" : files_made == 0 ? "warm" : "cold"; }
  double symmetry_residual() const {
    std::vector<double> errors = symmetries.discrete_error;
    errors.insert(errors.end(), symmetries.continuous_error.begin(), symmetries.continuous_error.end());
    return errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end());
  }
};

void measure_proxies(Inspection& found, ProgressBar& bar) {
  const PartModel& part = *found.part;
  bar.stage(0.25, 0.35, "distance field");
  found.field = part.field_error(default_field());
  bar.stage(0.35, 0.45, "spheres");
  found.spheres = part.sphere_error(default_voxels());
  bar.stage(0.45, 0.85, "convex hulls");
  part.hulls(default_hulls());
  bar.stage(0.85, 1.0, "errors of the convex hulls");
  found.hulls = part.hull_error(default_hulls());
  sample_count(part);
}

Inspection inspected(const InspectOptions& options) {
  LoadOptions load;
  load.require_closed = false;
  load.unit = unit_given(options.unit);
  load.solid = options.solid;
  load.tessellation.chord = options.chord;
  if (options.angle) load.tessellation.angle = *options.angle;
  Inspection found;
  found.cache = Cache::global().directory();
  const std::size_t before = files_below(found.cache);
  ProgressBar bar;
  bar.stage(0.0, 0.1, "reading " + options.model);
  found.part = PartModel::load(options.model, load);
  const LoadReport& report = found.part->load_report();
  if (report.closed) {
    bar.stage(0.1, 0.25, "symmetries");
    found.symmetries = examine_symmetries(*found.part);
    measure_proxies(found, bar);
    if (!options.hulls.empty()) write_hulls_obj(found.part->hulls(default_hulls()), options.hulls);
  } else if (!options.hulls.empty()) {
    throw input_error("an open surface has no convex hulls", options.model,
                      "close its " + std::to_string(report.open_edges) + " open edges, or leave out --hulls");
  }
  const std::size_t after = files_below(found.cache);
  found.files_made = after - std::min(before, after);  // others may clear it meanwhile
  return found;
}

Json proxies_json(const Inspection& found) {
  const PartModel& part = *found.part;
  const ConvexHulls& hulls = part.hulls(default_hulls());
  return {{"spheres", {{"count", part.spheres(default_voxels()).spheres.size()}, {"error", json_of(found.spheres)}}},
          {"samples", {{"count", sample_count(part)}}},
          {"field", {{"nodes", part.field(default_field()).nodes}, {"error", json_of(found.field)}}},
          {"hulls",
           {{"count", hulls.hulls.size()},
            {"met", hulls.met},
            {"surface_error", hulls.surface_error},
            {"volume_error", hulls.volume_error},
            {"error", json_of(found.hulls)}}}};
}

Json json_of(const Inspection& found, const std::string& model) {
  const PartModel& part = *found.part;
  const LoadReport& report = part.load_report();
  const Aabb box = part.mesh().bounds();
  Json json = {{"model", model},
               {"file", file_json(report)},
               {"size", json_of(box.size())},
               {"lower", json_of(box.lower)},
               {"diagonal", part.diagonal()},
               {"vertices", part.mesh().vertices.size()},
               {"triangles", part.mesh().triangles.size()},
               {"shells", report.shells},
               {"watertight", report.closed},
               {"open_edges", report.open_edges}};
  if (report.closed) {
    const SymmetryReport& s = found.symmetries;
    json["mass_properties"] = mass_json(part.mass());
    json["symmetries"] = {{"round_axes", s.symmetries.continuous.size()},
                          {"discrete", s.symmetries.discrete.size()},
                          {"residual", found.symmetry_residual()},
                          {"nearly", s.nearly.size()}};
    json["proxies"] = proxies_json(found);
  }
  json["cache"] = {{"directory", found.cache}, {"state", found.cache_state()}, {"files_made", found.files_made}};
  return json;
}

void print_error(const char* name, const std::string& count, const ShapeError& error) {
  std::printf("  %-8s %-18s proxy to mesh max %.3f %% mean %.3f %%, mesh to proxy max %.3f %%, volume %+.2f %%\n", name,
              count.c_str(), 100 * error.to_mesh_max, 100 * error.to_mesh_mean, 100 * error.from_mesh_max,
              100 * error.volume);
}

void print_file(const Inspection& found, const std::string& model) {
  const Mesh& mesh = found.part->mesh();
  const LoadReport& report = found.part->load_report();
  const Vec3 size = mesh.bounds().size();
  std::printf("%s\n", model.c_str());
  std::printf("size        %.4g x %.4g x %.4g m (unit %s)\n", size.x(), size.y(), size.z(), unit_text(report).c_str());
  std::printf("mesh        %zu vertices, %zu triangles, %zu shells\n", mesh.vertices.size(), mesh.triangles.size(),
              report.shells);
  if (report.tessellation_error > 0.0)
    std::printf("triangles   at most %.3g mm (%.2g %% of the diagonal) from the true surface\n",
                1000 * report.tessellation_error, 100 * report.tessellation_error / found.part->diagonal());
  for (const Flag& flag : report.flags) std::printf("flag        %s (%s)\n", flag.text.c_str(), flag.remedy.c_str());
}

void print_solid(const Inspection& found) {
  const PartModel& part = *found.part;
  const MassProperties& m = part.mass();
  const SymmetryReport& s = found.symmetries;
  std::printf("watertight  yes\n");
  std::printf("volume      %.6g m3, surface %.6g m2, %.6g kg at 1000 kg/m3\n", m.volume, m.area, 1000 * m.volume);
  std::printf("centre      %.6g %.6g %.6g m\n", m.center.x(), m.center.y(), m.center.z());
  std::printf("moments     %.4g %.4g %.4g kg m2 at 1000 kg/m3\n", 1000 * m.principal.x(), 1000 * m.principal.y(),
              1000 * m.principal.z());
  std::printf("symmetries  %zu round axes, %zu further turns, residual %.3g mm; nearly %zu (bin_scenes symmetries)\n",
              s.symmetries.continuous.size(), s.symmetries.discrete.size(), 1000 * found.symmetry_residual(),
              s.nearly.size());
  std::printf("proxies     errors in %% of the diagonal (%.4g m)\n", part.diagonal());
  print_error("spheres", std::to_string(part.spheres(default_voxels()).spheres.size()), found.spheres);
  const auto& [nx, ny, nz] = part.field(default_field()).nodes;
  print_error("field", std::to_string(nx) + " x " + std::to_string(ny) + " x " + std::to_string(nz), found.field);
  const ConvexHulls& hulls = part.hulls(default_hulls());
  print_error("hulls", std::to_string(hulls.hulls.size()), found.hulls);
  const HullOptions goal = default_hulls();
  if (!hulls.met)
    std::printf("  %-8s these hulls miss their goal, %g %% of the diagonal and %g %% of the volume, with %d at most\n",
                "", 100 * goal.max_error, 100 * goal.max_volume_error, goal.max_hulls);
  std::printf("  %-8s %zu\n", "samples", sample_count(part));
}

void print_text(const Inspection& found, const std::string& model) {
  const LoadReport& report = found.part->load_report();
  print_file(found, model);
  if (report.closed)
    print_solid(found);
  else
    std::printf("watertight  no: %zu open edges; close them, or give the part a `thickness` in the request\n",
                report.open_edges);
  std::printf("cache       %s %s (%zu files made now)\n", found.cache_state(), found.cache.c_str(), found.files_made);
}

}  // namespace

int inspect(const InspectOptions& options) {
  const Inspection found = inspected(options);
  if (options.json)  // names of files are any bytes
    std::cout << json_of(found, options.model).dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
  else
    print_text(found, options.model);
  return exit_done;
}

}  // namespace bin_scenes
