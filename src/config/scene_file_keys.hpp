/// The table of the keys of scene.json (see scene/keys.hpp). The tables of parts and report are in
/// scene/report_keys.hpp. Reading, writing and docs/use/scene.md all use these tables.
#pragma once

#include "bin_scenes/config/scene_file.hpp"
#include "bin_scenes/scene/sensor_name.hpp"
#include "scene/keys.hpp"
#include "scene/only_keys.hpp"
#include "scene/report_keys.hpp"
#include "sensor/sensor_keys.hpp"

#include <algorithm>

namespace bin_scenes {

constexpr const char* scene_format = "bin_scenes/1";

template <class Visitor>
void visit(Visitor& v, PartTruth& truth) {
  v.field({"id", "", "Id of the part."}, truth.id);
  v.field({"pose_in_camera", "m", "Pose of the model frame in the optical frame of the sensor."}, truth.pose_in_camera);
  v.field({"visible_fraction", "", "`px_count_visib` / `px_count_all`; 0 if `px_count_all` is 0."},
          truth.visible_fraction);
  v.field({"bbox_visib", "pixel",
           "Bounding box of the visible pixels: x, y, width and height. All are -1 if no pixel is visible."},
          truth.visible_box);
  v.field({"bbox_obj", "pixel",
           "Bounding box of the whole part, including hidden pixels: x, y, width and height. It may extend beyond the "
           "image."},
          truth.whole_box);
  v.field({"px_count_visib", "", "Number of pixels that truly show the part."}, truth.visible_pixels);
  v.field({"px_count_measured", "", "Number of the pixels that truly show the part and have a measured depth."},
          truth.measured_pixels);
  v.field({"px_count_all", "", "Number of pixels of the part's silhouette, as if nothing hid it."}, truth.all_pixels);
}

struct SceneBin {
  Bin& bin;
};

template <class Visitor>
void visit(Visitor& v, SceneBin& scene) {
  Bin& bin = scene.bin;
  v.bin_kind(bin, BinKeys(bin));
  visit_only(v, {"inner_size", "wall_thickness", "mesh"}, bin);
  v.field({"sha256", "", "SHA-256 of the mesh file of the bin.", anything, !bin.mesh_sha256.empty()}, bin.mesh_sha256);
  visit_only(v, {"unit", "pose", "floor", "none", "friction", "restitution"}, bin);
}

struct SceneSurface {
  Surface& surface;
};

/// Without the name of the material, whose values are written.
template <class Visitor>
void visit(Visitor& v, SceneSurface& scene) {
  visit_only(v,
             {"albedo", "gloss", "roughness", "refraction", "extinction", "colour", "anisotropy", "along", "texture"},
             scene.surface);
}

struct SceneTable {
  Table& table;
};

template <class Visitor>
void visit(Visitor& v, SceneTable& scene) {
  v.field({"height", "m", "Height of the table, as z in the bin frame."}, scene.table.height);
  SceneSurface surface{scene.table.surface};
  v.section({"surface", "", "Optical properties of the table."}, surface);
  visit_only(v, {"mottle", "patch"}, scene.table);
}

/// A projector or laser as its sensor has placed it.
template <class Device>
struct SceneDevice {
  Device& device;
};

template <class Visitor, class Device>
void visit(Visitor& v, SceneDevice<Device>& placed) {
  visit_only(v, {"pose"}, placed.device);
  if constexpr (std::is_same_v<Device, Projector>)
    visit_only(v, {"width", "height", "fov", "distortion"}, placed.device);
}

template <class Visitor>
void visit(Visitor& v, SceneSensor& scene) {
  Sensor& sensor = scene;
  const auto keys = [&](std::initializer_list<std::string> names) {
    OnlyKeys<Visitor> only(v, names);
    visit_view(only, sensor);
  };
  keys({"name"});
  std::string frame = graph_name(sensor.name) + "_optical_frame";
  v.field({"frame", "", "Name of the TF frame of the sensor. The key `pose` is the pose of this frame."}, frame);
  keys({"model", "preset"});
  Pose pose = sensor.pose.value_or(Pose());
  v.field({"pose", "m", "Pose of the optical frame (x to the right, y down, z forward) in the bin frame."}, pose);
  sensor.pose = pose;
  keys({"width", "height"});
  v.field({"K", "pixel", "Intrinsics of the camera as a row-major 3x3 matrix [fx, 0, cx, 0, fy, cy, 0, 0, 1]."},
          sensor.k);
  keys({"distortion", "near", "far"});
  v.field({"depth_scale", "m", "Depth that one count of the 16-bit depth images represents."}, sensor.depth_scale);
  visit_only(v, {"noise"}, sensor);
  keys({"view_of"});
  const auto& all = sensor_models();
  const auto model = std::find_if(all.begin(), all.end(), [&](const auto* one) { return one->name == sensor.model; });
  const auto uses = [&](bool SensorModel::*device) { return model != all.end() && (*model)->*device; };
  SceneDevice<Projector> projector{sensor.projector};
  v.section({"projector", "", "The projector, if the sensor model has one.", anything, uses(&SensorModel::projector)},
            projector);
  SceneDevice<Laser> laser{sensor.laser};
  v.section({"laser", "", "The laser, if the sensor model has one.", anything, uses(&SensorModel::laser)}, laser);
  v.list({"truth", "",
          "What the camera truly sees of each part in the scene that is no distractor. It is present if an image was "
          "made."},
         scene.truth);
}

template <class Visitor>
void visit(Visitor& v, SceneModel& model) {
  PartLine& line = model;
  visit_only(v, {"model"}, line);
  v.field({"sha256", "", "SHA-256 of the model file."}, line.sha256);
  visit_only(v, {"unit"}, line);
  visit_only(v, {"scale"}, line, line.scale != 1.0);
  visit_only(v, {"thickness", "solid"}, line);
  visit_only(v, {"chord", "angle"}, line.tessellation, line.tessellation.given());
}

template <class Visitor>
void visit(Visitor& v, SceneFile& scene) {
  std::string format = scene_format;
  v.field({"format", "", "Name and version of the file format: `bin_scenes/1`.", anything, true, true}, format);
  v.field({"seed", "", "Seed of the request.", anything, true, true}, scene.seed);
  v.field({"index", "", "Index of the scene. The scene depends only on the request, the seed and this index.", anything,
           true, true},
          scene.index);
  SceneBin bin{scene.bin};
  v.section({"bin", "",
             "The container of the parts. The origin of the bin frame is the centre of the floor's top surface, and z "
             "points up."},
            bin);
  SceneTable table{scene.table};
  v.section(
      {"table", "",
       "The table below the bin: an endless plane that the sensors see and the simulation does not contain. It is "
       "left out if there is no table.",
       anything, scene.table.height.has_value()},
      table);
  v.field({"gravity", "m/s2", "Acceleration of gravity in the bin frame."}, scene.gravity);
  v.field({"request_sha256", "", "SHA-256 of the request with all its defaults and of its model files."},
          scene.request_sha256);
  v.list({"sensors", "", "The sensors as they measured, with their poses and intrinsics."}, scene.sensors);
  v.list({"models", "",
          "The model of each entry of the request's list `parts`, and the settings with which it was read if they "
          "differ from the defaults.",
          anything, !scene.models.empty()},
         scene.models);
  v.list({"parts", "", "The parts in the order of their ids.", anything, true, true}, scene.parts);
  v.section({"report", "", "Report on the quality of the scene, measured on the true meshes."}, scene.report);
}

}  // namespace bin_scenes
