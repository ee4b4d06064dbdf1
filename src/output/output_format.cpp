#include "bin_scenes/output/output_format.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/sensor/gray_image.hpp"
#include "output/png.hpp"

#include <filesystem>

namespace bin_scenes {

namespace {

using Needs = SceneFormat::Needs;

std::string below(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

std::function<std::vector<std::string>(const Request&)> one_a_sensor(const char* ending) {
  return [ending](const Request& request) {
    std::vector<std::string> names;
    for (const Sensor& sensor : request.sensors) names.push_back(sensor.name + ending);
    return names;
  };
}

std::function<std::vector<std::string>(const Request&)> one(const char* name) {
  return [name](const Request&) { return std::vector<std::string>{name}; };
}

/// Files of a cloud or picture for each sensor.
OutputFormat of_images(const char* name, const char* ending,
                       void (*write)(const std::string& folder, const RangeImage& image)) {
  return {*find_scene_format(name),
          [write](const std::string& folder, const SceneOutput& output) {
            for (const RangeImage& image : output.images) write(folder, image);
          },
          one_a_sensor(ending)};
}

std::string grasps_file(const Sensor& sensor, const Gripper& gripper) {
  return sensor.name + "_grasps_" + file_name_of(gripper) + ".npy";
}

void write_grasps(const std::string& folder, const SceneOutput& output) {
  if (!output.grasps) return;
  const Request& request = output.loaded.request;
  write_text(below(folder, "grasps.json"), grasps_json(*output.grasps, output.scene, request));
  for (const Sensor& sensor : output.scene.sensors)
    for (std::size_t i = 0; i < request.grippers.size(); ++i)
      write_text(below(folder, grasps_file(sensor, request.grippers[i])),
                 grasps_npy(*output.grasps, sensor, request, i));
  for (const RangeImage& image : output.images) write_grasp_maps(folder, image, *output.grasps, request);
}

std::vector<std::string> grasp_files(const Request& request) {
  std::vector<std::string> names = {"grasps.json"};
  for (const Sensor& sensor : request.sensors)
    for (const Gripper& gripper : request.grippers) names.push_back(grasps_file(sensor, gripper));
  return names;
}

OutputFormat built_in(const SceneFormat& format) {
  const std::string& name = format.name;
  if (name == "pcd")
    return of_images("pcd", ".pcd", [](const std::string& folder, const RangeImage& image) {
      write_pcd(below(folder, image.sensor.name + ".pcd"), image);
    });
  if (name == "ply")
    return of_images("ply", ".ply", [](const std::string& folder, const RangeImage& image) {
      write_ply(below(folder, image.sensor.name + ".ply"), image);
    });
  if (name == "png") return of_images("png", ".png", write_pngs);
  if (name == "gray")
    return of_images("gray", "_gray.png", [](const std::string& folder, const RangeImage& image) {
      write_bytes(below(folder, image.sensor.name + "_gray.png"), png8(image.width, image.height, 1, gray_of(image)));
    });
  if (name == "grasps") return {format, write_grasps, grasp_files};
  if (name == "bag")
    return {format,
            [](const std::string& folder, const SceneOutput& o) {
              bag_writer()(below(folder, "scene.bag"), o.scene, o.loaded, o.images);
            },
            one("scene.bag"), [] { return bool(bag_writer()); }};
  if (name == "mcap")
    return {format,
            [](const std::string& folder, const SceneOutput& o) {
              mcap_writer()(below(folder, "scene.mcap"), o.mcap, o.scene, o.loaded, o.images);
            },
            one("scene.mcap"), [] { return bool(mcap_writer()); }};
  return {format};
}

std::vector<OutputFormat>& table() {
  static std::vector<OutputFormat> formats = [] {
    std::vector<OutputFormat> all;
    for (const SceneFormat& format : scene_formats()) all.push_back(built_in(format));
    return all;
  }();
  return formats;
}

}  // namespace

const std::vector<OutputFormat>& output_formats() {
  return table();
}

void register_output_format(OutputFormat format) {
  std::vector<OutputFormat>& formats = table();
  if (find_scene_format(format.name))
    throw input_error("a format of this name is known", format.name, "name it otherwise");
  add_scene_format(format);
  formats.push_back(std::move(format));
}

}  // namespace bin_scenes
