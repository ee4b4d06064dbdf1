/// The command `new`: a first request for a part, with the bin that fits, and its first scene.
#include "bin_scenes/config/presets.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "core/formatted.hpp"
#include "dataset/whole_folders.hpp"
#include "generate/fitted_bin.hpp"
#include "tool/commands.hpp"
#include "tool/progress_bar.hpp"
#include "tool/unit_option.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr double density = 7850.0, wall_thickness = 0.005;
constexpr int comment_column = 40;

/// Plain where YAML reads it back as the same text.
std::string quoted(const std::string& text) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./+";
  const bool is_plain =
      text.find_first_not_of(plain) == std::string::npos && text.find_first_not_of("0123456789.+") != std::string::npos;
  if (is_plain) return text;
  try {
    return nlohmann::json(text).dump();
  } catch (const nlohmann::json::type_error&) {
    throw input_error("this name is no UTF-8, which a request is", text, "rename the file, folder or solid");
  }
}

std::string size_text(const Vec3& size) {
  return formatted("%.3g x %.3g x %.3g m", size.x(), size.y(), size.z());
}

std::string line(std::string key, const std::string& comment) {
  if (!comment.empty()) {
    key.resize(std::max<std::size_t>(key.size() + 1, comment_column), ' ');
    key += "# " + comment;
  }
  return key + "\n";
}

/// Relative to the request where the model lies near it, so that both may move together.
std::string path_from(const fs::path& folder, const std::string& model) {
  const std::string near = fs::proximate(fs::canonical(model), fs::canonical(folder)).string();
  return near.compare(0, 9, "../../../") == 0 ? fs::canonical(model).string() : near;
}

struct Draft {
  const NewOptions& options;
  PartModelPtr part = nullptr;
  ChosenUnit unit = {};
  FittedBin fitted = {};
  Bin bin = {};
  std::optional<Sensor> sensor = {};  ///< of the preset
  SensorPlace place = {};
};

std::string part_text(const Draft& d, const fs::path& folder) {
  const NewOptions& o = d.options;
  const double mass = density * d.part->mass().volume;
  std::string text = "parts:\n";
  const std::string path = path_from(folder, o.part);
  text += line("  - model: " + quoted(path), fs::path(path).is_absolute() ? "" : "relative to this file");
  const std::string size = size_text(d.part->mesh().bounds().size());
  if (d.unit.unit)
    text += line(std::string("    unit: ") + name_of(*d.unit.unit), size + ", " + d.unit.reason);
  else
    text += "    # " + size + ", " + d.unit.reason + "\n";
  if (!o.solid.empty()) text += line("    solid: " + quoted(o.solid), "");
  if (o.thickness)
    text += line(formatted("    thickness: %g", *o.thickness), "m: the surface is open and becomes a shell");
  text += line("    count: " + std::to_string(o.count), "");
  text += line(formatted("    density: %g", density),
               formatted("kg/m3: steel, %.3g kg a part; aluminium 2700, plastic 1050", mass));
  text += line("    friction: 0.5", "of a pair: sqrt(a * b)");
  text += line("    restitution: 0.1", "of a pair: the larger of the two");
  return text + "    # surface: {material: steel_brushed}   # what cameras see; names: config/materials\n";
}

std::string sensor_text(const Draft& d) {
  std::string text = "sensors:\n  - name: camera\n";
  if (!d.sensor) {
    text += line("    width: 640", "an ideal camera above the bin, all of it in view; or:");
    text += "    height: 480\n    # preset: ...";
    for (const std::string& preset : sensor_presets()) text += "\n    #   " + preset;
    return text + "\n";
  }
  text += line("    preset: " + d.options.sensor, formatted("it stands %.2f m above the floor", d.place.distance));
  if (d.place.height) text += line(formatted("    pose: [0, 0, %.3f, 1, 0, 0, 0]", *d.place.height), "looks down");
  if (!d.place.warning.empty()) text += "    # " + d.place.warning + "\n";
  return text;
}

std::string request_text(const Draft& d, const fs::path& folder) {
  const Vec3& size = d.bin.inner_size;
  std::string text =
      "# Made by `bin_scenes new`. Every key: docs/use/request.md. More scenes:\n"
      "#   bin_scenes generate " +
      d.options.out + " --out scenes --scenes 10 --formats json,png,ply\n";
  text += line("seed: 1", "same request and seed = same scenes");
  text += "bin:\n";
  text += line(formatted("  inner_size: [%g, %g, %g]", size.x(), size.y(), size.z()), "m, see below");
  text += line(formatted("  wall_thickness: %g", wall_thickness), "m");
  text += line("  friction: 0.5", "");
  text += formatted(
      "  # Chosen for the part and count: a heap takes about %.2g times the convex hulls (%.3g cm3 each) of its\n"
      "  # parts. On this floor it lies %.0f mm high on average; the rim is above its top.\n",
      d.fitted.loose, 1e6 * d.fitted.hull, 1e3 * d.fitted.level);
  text += part_text(d, folder);
  text += line("pour: {pattern: rain}", "parts enter just above the heap");
  return text + sensor_text(d);
}

/// "80 of 80 parts in a bin of ..., heap 0.13 m high", of the scene that `generate` left.
std::string outcome(const Scene& scene, const Draft& d) {
  std::size_t inside = 0;
  double top = 0.0;
  for (const ScenePart& part : scene.parts) {
    if (part.state == PartState::escaped || !is_there(part.state)) continue;
    ++inside;
    for (const Vec3& corner : d.part->corners())
      top = std::max(top, part.pose.position.z() + (part.pose.orientation * corner).z());
  }
  return formatted("%zu of %zu parts in a bin of %s, heap %.3g m high", inside, scene.parts.size(),
                   size_text(d.bin.inner_size).c_str(), top);
}

int pour_once(const Draft& d) {
  const fs::path folder = fs::path(d.options.out).replace_extension("");
  GenerateOptions generation;
  generation.request = d.options.out;
  generation.out = folder.string();
  generation.scenes = "1";
  generation.formats = {"json", "png"};
  generation.overwrite = true;
  const int code = generate(generation);
  const std::string scene = (folder / (code == exit_done ? "" : "set_apart") / "scene_000000").string();
  std::printf("%s: %s; %s\n", d.options.out.c_str(), outcome(read_scene_json(scene + "/scene.json"), d).c_str(),
              (code == exit_done ? "at rest, see " + scene + "/camera.png" : "set apart: " + scene).c_str());
  return code;
}

/// What a request states as keys is an option here.
PartModelPtr load_part(const NewOptions& options, const LoadOptions& load) {
  try {
    return PartModel::load(options.part, load);
  } catch (const Error& error) {
    const std::size_t at = error.remedy().find("give a thickness");
    if (at == std::string::npos) throw;
    std::string remedy = error.remedy();
    throw Error(error.kind(), error.problem(), error.where(),
                remedy.replace(at, std::string("give a thickness").size(), "add --thickness 0.001 (m)"));
  }
}

void check_options(const NewOptions& options) {
  if (options.count < 1 || options.count > 100000)
    throw input_error("must be at least 1 and at most 100000", "--count", "for instance 80");
  const std::string extension = fs::path(options.out).extension().string();
  if (extension != ".yaml" && extension != ".yml")
    throw input_error("'" + options.out + "' is no name of a request", "--out", "end it with .yaml");
  if (fs::exists(options.out) && !options.overwrite)
    throw input_error("is there already", options.out, "choose another name with --out, or add --overwrite");
  fs::path there = fs::absolute(options.out).lexically_normal().parent_path();
  while (!fs::exists(there) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there))
    throw input_error("'" + there.string() + "' is no folder", "--out", "name a file in a folder");
}

}  // namespace

int new_request(const NewOptions& options) {
  check_options(options);
  Draft draft{options};
  if (!options.sensor.empty()) draft.sensor = sensor_preset(options.sensor);
  const std::optional<Unit> given = unit_given(options.unit);
  LoadOptions load;
  load.solid = options.solid;
  load.require_closed = false;
  ProgressBar bar;
  bar.stage(0.0, 1.0, "reading " + options.part);
  draft.unit = choose_unit(load_mesh(options.part, load), given, options.part);
  load.unit = draft.unit.unit;
  load.thickness = options.thickness;
  load.require_closed = true;
  draft.part = load_part(options, load);
  draft.fitted = fit_bin(draft.part->mesh(), options.count);
  bar.clear();
  draft.bin.inner_size = draft.fitted.inner_size;
  draft.bin.wall_thickness = wall_thickness;
  if (draft.sensor) draft.place = place_sensor(*draft.sensor, draft.bin);

  const fs::path folder = fs::path(options.out).parent_path();
  if (!folder.empty()) make_directory(folder);
  write_text(options.out, request_text(draft, folder.empty() ? "." : folder));
  if (!draft.place.warning.empty()) std::fprintf(stderr, "bin_scenes: note: %s\n", draft.place.warning.c_str());
  if (options.pour) return pour_once(draft);
  std::printf("%s: %zu parts of %s (%s) in a bin of %s; not poured\n", options.out.c_str(), options.count,
              size_text(draft.part->mesh().bounds().size()).c_str(), draft.unit.reason.c_str(),
              size_text(draft.bin.inner_size).c_str());
  return exit_done;
}

}  // namespace bin_scenes
