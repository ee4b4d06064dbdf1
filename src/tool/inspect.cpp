/// The command `inspect`: what a model file is, its mass, holes, symmetries, and the error of each solver's shape, as
/// text or JSON.
#include "bin_scenes/core/cache.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/part/symmetry.hpp"
#include "config/json_fields.hpp"
#include "page/html.hpp"
#include "tool/commands.hpp"
#include "tool/inspection.hpp"
#include "tool/progress_bar.hpp"
#include "tool/unit_option.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace bin_scenes {

namespace {

using Json = config::Json;

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

double largest_error(const SymmetryReport& symmetries) {
  double largest = 0.0;
  for (const double error : symmetries.discrete_error) largest = std::max(largest, error);
  for (const double error : symmetries.continuous_error) largest = std::max(largest, error);
  return largest;
}

Inspection::File file_of(const LoadReport& report) {
  Inspection::File file;
  file.format = report.format;
  file.unit = unit_text(report);
  file.metres_per_unit = report.metres_per_unit;
  file.meshes = report.meshes;
  file.vertices = report.file_vertices;
  file.triangles = report.file_triangles;
  file.sha256 = report.content_sha256;
  file.tessellation_error = report.tessellation_error;
  file.flags = report.flags;
  return file;
}

Inspection::Mass mass_of(const MassProperties& mass) {
  std::vector<Vec3> rows;
  for (int i = 0; i < 3; ++i) rows.push_back(mass.inertia.row(i).transpose());
  return {mass.volume, mass.area, mass.center, rows, mass.principal};
}

Inspection::Proxies proxies_of(const PartModel& part, ProgressBar& bar) {
  Inspection::Proxies proxies;
  bar.stage(0.25, 0.35, "distance field");
  proxies.field = {part.field(default_field()).nodes, part.field_error(default_field())};
  bar.stage(0.35, 0.45, "spheres");
  proxies.spheres = {part.spheres(default_voxels()).spheres.size(), part.sphere_error(default_voxels())};
  bar.stage(0.45, 0.85, "convex hulls");
  const ConvexHulls& hulls = part.hulls(default_hulls());
  bar.stage(0.85, 1.0, "errors of the convex hulls");
  proxies.hulls = {hulls.hulls.size(), hulls.met, hulls.surface_error, hulls.volume_error,
                   part.hull_error(default_hulls())};
  SampleOptions samples;
  samples.count = SolverSettings().sphere.fine_samples;
  proxies.samples = {part.samples(samples).samples.size()};
  return proxies;
}

/// Of a closed surface only: an open one has no volume.
void examine_solid(const PartModel& part, Inspection& found, ProgressBar& bar) {
  found.mass = mass_of(part.mass());
  bar.stage(0.1, 0.25, "symmetries");
  const SymmetryReport report = examine_symmetries(part);
  found.symmetries = {report.symmetries.continuous.size(), report.symmetries.discrete.size(), largest_error(report),
                      report.nearly.size()};
  found.proxies = proxies_of(part, bar);
}

PartModelPtr loaded(const InspectOptions& options) {
  LoadOptions load;
  load.require_closed = false;
  load.unit = unit_given(options.unit);
  load.solid = options.solid;
  load.tessellation.chord = options.chord;
  if (options.angle) load.tessellation.angle = *options.angle;
  return PartModel::load(options.model, load);
}

Inspection inspected(const InspectOptions& options) {
  Inspection found;
  found.model = options.model;
  found.cache.directory = Cache::global().directory();
  const std::size_t before = files_below(found.cache.directory);
  ProgressBar bar;
  bar.stage(0.0, 0.1, "reading " + options.model);
  const PartModelPtr part = loaded(options);
  const LoadReport& report = part->load_report();
  const Aabb box = part->mesh().bounds();
  found.file = file_of(report);
  found.size = box.size(), found.lower = box.lower, found.diagonal = part->diagonal();
  found.vertices = part->mesh().vertices.size(), found.triangles = part->mesh().triangles.size();
  found.shells = report.shells, found.watertight = report.closed, found.open_edges = report.open_edges;
  if (report.closed) {
    examine_solid(*part, found, bar);
    if (!options.hulls.empty()) write_hulls_obj(part->hulls(default_hulls()), options.hulls);
  } else if (!options.hulls.empty()) {
    throw input_error("an open surface has no convex hulls", options.model,
                      "close its " + std::to_string(report.open_edges) + " open edges, or leave out --hulls");
  }
  const std::size_t after = files_below(found.cache.directory);
  found.cache.files_made = after - std::min(before, after);  // others may clear it meanwhile
  found.cache.state = found.cache.directory.empty() ? "off" : found.cache.files_made == 0 ? "warm" : "cold";
  return found;
}

std::string value_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return short_number(value.get<double>(), 6);
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& item : value) text += (text.empty() ? "" : " ") + value_text(item);
  return text;
}

/// Visitor of a table: prints a line for each key with its unit and meaning; those of a section are indented.
class TextWriter {
 public:
  template <class Value>
  void field(const Key& key, Value& value) {
    if (key.written) line(key, value_text(config::json_of(value)));
  }
  template <class Struct>
  void section(const Key& key, Struct& value) {
    if (!key.written) return;
    line(key, "");
    indent_ += 2;
    visit(*this, value);
    indent_ -= 2;
  }
  template <class Struct>
  void list(const Key& key, std::vector<Struct>& values) {
    for (Struct& value : values) section(key, value);
  }

 private:
  void line(const Key& key, const std::string& value) const {
    const std::string unit = value.empty() || !*key.unit ? "" : std::string(" ") + key.unit;
    std::printf("%*s%-*s %-30s %s\n", indent_, "", 22 - indent_, key.name, (value + unit).c_str(), key.text);
  }
  int indent_ = 0;
};

}  // namespace

int inspect(const InspectOptions& options) {
  Inspection found = inspected(options);
  if (options.json) {  // names of files are any bytes
    std::cout << config::JsonWriter::object(found).dump(1, ' ', false, Json::error_handler_t::replace) << "\n";
  } else {
    TextWriter text;
    visit(text, found);
  }
  return exit_done;
}

}  // namespace bin_scenes
