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

/// What each solver makes of the part with its default settings. Errors are fractions of the diagonal.
Json proxies_json(const PartModel& part, ProgressBar& bar) {
  const SolverSettings defaults;
  VoxelOptions voxels;
  voxels.voxels = defaults.thesis.voxels;
  voxels.tightness = defaults.thesis.tightness;
  FieldOptions field;
  field.cell = defaults.sphere.field_cell;
  SampleOptions samples;
  samples.count = defaults.sphere.fine_samples;
  const HullOptions hulls = default_hulls();

  bar.stage(0.25, 0.35, "distance field");
  const auto& nodes = part.field(field).nodes;
  const Json field_error = json_of(part.field_error(field));
  bar.stage(0.35, 0.45, "spheres");
  const Json sphere_error = json_of(part.sphere_error(voxels));
  bar.stage(0.45, 0.85, "convex hulls");
  const ConvexHulls& decomposition = part.hulls(hulls);
  bar.stage(0.85, 1.0, "errors of the convex hulls");
  const Json hull_error = json_of(part.hull_error(hulls));
  return {{"spheres", {{"count", part.spheres(voxels).spheres.size()}, {"error", sphere_error}}},
          {"samples", {{"count", part.samples(samples).samples.size()}}},
          {"field", {{"nodes", nodes}, {"error", field_error}}},
          {"hulls",
           {{"count", decomposition.hulls.size()},
            {"met", decomposition.met},
            {"surface_error", decomposition.surface_error},
            {"volume_error", decomposition.volume_error},
            {"error", hull_error}}}};
}

/// `bin_scenes symmetries` shows more.
Json symmetries_json(const PartModel& part) {
  const SymmetryReport report = examine_symmetries(part);
  std::vector<double> errors = report.discrete_error;
  errors.insert(errors.end(), report.continuous_error.begin(), report.continuous_error.end());
  return {{"round_axes", report.symmetries.continuous.size()},
          {"discrete", report.symmetries.discrete.size()},
          {"residual", errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end())},
          {"nearly", report.nearly.size()}};
}

Json inspection(const InspectOptions& options) {
  LoadOptions load;
  load.require_closed = false;
  load.unit = unit_given(options.unit);
  load.solid = options.solid;
  load.tessellation.chord = options.chord;
  if (options.angle) load.tessellation.angle = *options.angle;
  const std::string cache = Cache::global().directory();
  const std::size_t before = files_below(cache);
  ProgressBar bar;
  bar.stage(0.0, 0.1, "reading " + options.model);
  const PartModelPtr part = PartModel::load(options.model, load);
  const LoadReport& report = part->load_report();
  const Aabb box = part->mesh().bounds();
  Json json = {{"model", options.model}, {"file", file_json(report)}};
  json["size"] = json_of(box.size());
  json["lower"] = json_of(box.lower);
  json["diagonal"] = part->diagonal();
  json["vertices"] = part->mesh().vertices.size();
  json["triangles"] = part->mesh().triangles.size();
  json["shells"] = report.shells;
  json["watertight"] = report.closed;
  json["open_edges"] = report.open_edges;
  if (report.closed) {  // an open surface has no volume, and nothing can be made of it
    json["mass_properties"] = mass_json(part->mass());
    bar.stage(0.1, 0.25, "symmetries");
    json["symmetries"] = symmetries_json(*part);
    json["proxies"] = proxies_json(*part, bar);
    if (!options.hulls.empty()) write_hulls_obj(part->hulls(default_hulls()), options.hulls);
  } else if (!options.hulls.empty()) {
    throw input_error("an open surface has no convex hulls", options.model,
                      "close its " + std::to_string(report.open_edges) + " open edges, or leave out --hulls");
  }
  const std::size_t after = files_below(cache),
                    made = after - std::min(before, after);  // others may clear it meanwhile
  json["cache"] = {{"directory", cache},
                   {"state", cache.empty() ? "off"
                             : made == 0   ? "warm"
                                           : "cold"},
                   {"files_made", made}};
  return json;
}

void print_error(const char* name, const std::string& count, const Json& error) {
  std::printf("  %-8s %-18s proxy to mesh max %.3f %% mean %.3f %%, mesh to proxy max %.3f %%, volume %+.2f %%\n", name,
              count.c_str(), 100 * error["to_mesh_max"].get<double>(), 100 * error["to_mesh_mean"].get<double>(),
              100 * error["from_mesh_max"].get<double>(), 100 * error["volume"].get<double>());
}

void print_text(const Json& j) {
  const auto number = [](const Json& value) { return value.get<double>(); };
  const Json& size = j["size"];
  std::printf("%s\n", j["model"].get<std::string>().c_str());
  std::printf("size        %.4g x %.4g x %.4g m (unit %s)\n", number(size[0]), number(size[1]), number(size[2]),
              j["file"]["unit"].get<std::string>().c_str());
  std::printf("mesh        %zu vertices, %zu triangles, %zu shells\n", j["vertices"].get<std::size_t>(),
              j["triangles"].get<std::size_t>(), j["shells"].get<std::size_t>());
  if (j["file"].contains("tessellation_error"))
    std::printf("triangles   at most %.3g mm (%.2g %% of the diagonal) from the true surface\n",
                1000 * number(j["file"]["tessellation_error"]),
                100 * number(j["file"]["tessellation_error"]) / number(j["diagonal"]));
  for (const Json& flag : j["file"]["flags"]) {
    std::printf("flag        %s (%s)\n", flag["text"].get<std::string>().c_str(),
                flag["remedy"].get<std::string>().c_str());
  }
  if (!j["watertight"].get<bool>()) {
    std::printf("watertight  no: %zu open edges; close them, or give the part a `thickness` in the request\n",
                j["open_edges"].get<std::size_t>());
  } else {
    const Json& m = j["mass_properties"];
    const Json &c = m["center_of_mass"], &p = m["principal_moments_at_1_kg_m3"];
    std::printf("watertight  yes\n");
    std::printf("volume      %.6g m3, surface %.6g m2, %.6g kg at 1000 kg/m3\n", number(m["volume"]), number(m["area"]),
                1000 * number(m["volume"]));
    std::printf("centre      %.6g %.6g %.6g m\n", number(c[0]), number(c[1]), number(c[2]));
    std::printf("moments     %.4g %.4g %.4g kg m2 at 1000 kg/m3\n", 1000 * number(p[0]), 1000 * number(p[1]),
                1000 * number(p[2]));
    const Json& s = j["symmetries"];
    std::printf("symmetries  %zu round axes, %zu further turns, residual %.3g mm; nearly %zu (bin_scenes symmetries)\n",
                s["round_axes"].get<std::size_t>(), s["discrete"].get<std::size_t>(), 1000 * number(s["residual"]),
                s["nearly"].get<std::size_t>());
    const Json& x = j["proxies"];
    std::printf("proxies     errors in %% of the diagonal (%.4g m)\n", number(j["diagonal"]));
    print_error("spheres", std::to_string(x["spheres"]["count"].get<std::size_t>()), x["spheres"]["error"]);
    const Json& n = x["field"]["nodes"];
    print_error("field",
                std::to_string(n[0].get<int>()) + " x " + std::to_string(n[1].get<int>()) + " x " +
                    std::to_string(n[2].get<int>()),
                x["field"]["error"]);
    print_error("hulls", std::to_string(x["hulls"]["count"].get<std::size_t>()), x["hulls"]["error"]);
    if (!x["hulls"]["met"].get<bool>()) {
      const HullOptions goal = default_hulls();
      std::printf(
          "  %-8s these hulls miss their goal, %g %% of the diagonal and %g %% of the volume, with %d at most\n", "",
          100 * goal.max_error, 100 * goal.max_volume_error, goal.max_hulls);
    }
    std::printf("  %-8s %zu\n", "samples", x["samples"]["count"].get<std::size_t>());
  }
  const Json& cache = j["cache"];
  std::printf("cache       %s %s (%zu files made now)\n", cache["state"].get<std::string>().c_str(),
              cache["directory"].get<std::string>().c_str(), cache["files_made"].get<std::size_t>());
}

}  // namespace

int inspect(const InspectOptions& options) {
  const Json json = inspection(options);
  if (options.json) {
    std::cout << json.dump(1, ' ', false, Json::error_handler_t::replace) << "\n";  // names of files are any bytes
  } else {
    print_text(json);
  }
  return exit_done;
}

}  // namespace bin_scenes
