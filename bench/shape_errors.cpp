/// How far each solver's proxy is from the part, with its default settings: what `bin_scenes inspect` says, for all
/// samples.
#include "framework/benchmark.hpp"
#include "framework/isolated.hpp"
#include "runs.hpp"

#include <cmath>

namespace bin_scenes::bench {
namespace {

constexpr double rounding = 1e-9;  ///< of float32 meshes; less is no error
constexpr const char* parts[] = {"bolt_hex", "bracket_l",  "channel_u", "clip_spring", "conrod", "gear_spur", "mug",
                                 "nut_hex",  "pipe_elbow", "pipe_tee",  "ring_24",     "teapot", "washer"};

struct Proxy {
  const char* name;
  const char* solver;
  std::size_t (*count)(const PartModel&);  ///< of spheres, hulls, or nodes of the field
  ShapeError (*error)(const PartModel&);
};

const SolverSettings settings;

VoxelOptions voxels() {
  VoxelOptions options;
  options.voxels = settings.thesis.voxels;
  options.tightness = settings.thesis.tightness;
  return options;
}
HullOptions hulls() {
  HullOptions options;
  options.max_error = settings.bullet.hull_error;
  options.max_hulls = settings.bullet.max_hulls;
  return options;
}
FieldOptions field() {
  FieldOptions options;
  options.cell = settings.sphere.field_cell;
  return options;
}

std::size_t nodes_of(const PartModel& part) {
  std::size_t count = 1;
  for (int k = 0; k < 3; ++k) count *= static_cast<std::size_t>(part.field(field()).nodes[k]);
  return count;
}

const Proxy proxies[] = {
    {"field", "sphere", nodes_of, [](const PartModel& part) { return part.field_error(field()); }},
    {"hulls", "bullet", [](const PartModel& part) { return part.hulls(hulls()).hulls.size(); },
     [](const PartModel& part) { return part.hull_error(hulls()); }},
    {"spheres", "sphere/thesis", [](const PartModel& part) { return part.spheres(voxels()).spheres.size(); },
     [](const PartModel& part) { return part.sphere_error(voxels()); }}};

void run(Run& out) {
  for (const char* name : parts) {
    for (const Proxy& proxy : proxies) {
      const Row key = Row().key("part", name).key("proxy", proxy.name).key("solver", proxy.solver);
      if (!out.wanted(key)) continue;
      const auto measured = [&] {
        const PartModelPtr part = load_parts(bin_of(name, 1)).front();
        const ShapeError error = proxy.error(*part);
        const auto rounded = [](double value) { return std::abs(value) < rounding ? 0.0 : value; };
        return Row()
            .exact("count", proxy.count(*part))
            .exact("to_mesh_mean_rel", rounded(error.to_mesh_mean))
            .exact("to_mesh_max_rel", rounded(error.to_mesh_max))
            .exact("from_mesh_mean_rel", rounded(error.from_mesh_mean))
            .exact("from_mesh_max_rel", rounded(error.from_mesh_max))
            .exact("volume_rel", rounded(error.volume));
      };
      out.row(Row(key).append(isolated(measured, 120.0).row));
    }
    if (out.quick()) return;
  }
}

const Registration registration{"shape_errors",
                                "distance and volume of field, hulls and spheres against the mesh",
                                {"part", "proxy", "solver"},
                                run};

}  // namespace
}  // namespace bin_scenes::bench
