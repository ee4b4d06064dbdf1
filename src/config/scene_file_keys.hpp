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
  v.field({"id", "", "of the part"}, truth.id);
  v.field({"pose_in_camera", "m", "of the model frame in the sensor's optical frame"}, truth.pose_in_camera);
  v.field({"visible_fraction", "", "px_count_visib / px_count_all; 0 if the latter is 0"}, truth.visible_fraction);
  v.field({"bbox_visib", "pixel", "x, y, width, height of the visible pixels; -1 four times: none is visible"},
          truth.visible_box);
  v.field({"bbox_obj", "pixel", "the same of the whole part, as if nothing hid it; it may exceed the image"},
          truth.whole_box);
  v.field({"px_count_visib", "", "pixels that truly show the part"}, truth.visible_pixels);
  v.field({"px_count_measured", "", "those among them that have a depth"}, truth.measured_pixels);
  v.field({"px_count_all", "", "pixels of its silhouette, as if nothing hid it"}, truth.all_pixels);
}

struct SceneBin {
  Bin& bin;
};

template <class Visitor>
void visit(Visitor& v, SceneBin& scene) {
  Bin& bin = scene.bin;
  v.bin_kind(bin, BinKeys(bin));
  visit_only(v, {"inner_size", "wall_thickness", "mesh"}, bin);
  v.field({"sha256", "", "mesh: digest of the file", anything, !bin.mesh_sha256.empty()}, bin.mesh_sha256);
  visit_only(v, {"unit", "pose", "floor", "none", "friction", "restitution"}, bin);
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
  v.field({"frame", "", "TF frame of the pose"}, frame);
  keys({"model", "preset"});
  Pose pose = sensor.pose.value_or(Pose());
  v.field({"pose", "m", "optical frame (x right, y down, z forward) in the bin frame"}, pose);
  sensor.pose = pose;
  keys({"width", "height"});
  v.field({"K", "pixel", "3x3 row-major intrinsics [fx, 0, cx, 0, fy, cy, 0, 0, 1]"}, sensor.k);
  keys({"distortion", "near", "far"});
  v.field({"depth_scale", "m", "of one count of the 16-bit depth images"}, sensor.depth_scale);
  visit_only(v, {"noise"}, sensor);
  keys({"view_of"});
  const auto& all = sensor_models();
  const auto model = std::find_if(all.begin(), all.end(), [&](const auto* one) { return one->name == sensor.model; });
  const auto uses = [&](bool SensorModel::*device) { return model != all.end() && (*model)->*device; };
  SceneDevice<Projector> projector{sensor.projector};
  v.section({"projector", "", "models that have one", anything, uses(&SensorModel::projector)}, projector);
  SceneDevice<Laser> laser{sensor.laser};
  v.section({"laser", "", "models that have one", anything, uses(&SensorModel::laser)}, laser);
  v.list({"truth", "", "what the camera truly sees of each part that is in the scene; there if an image was made"},
         scene.truth);
}

template <class Visitor>
void visit(Visitor& v, SceneModel& model) {
  PartLine& line = model;
  visit_only(v, {"model"}, line);
  v.field({"sha256", "", "digest of the file"}, line.sha256);
  visit_only(v, {"unit"}, line);
  visit_only(v, {"scale"}, line, line.scale != 1.0);
  visit_only(v, {"thickness", "solid"}, line);
  visit_only(v, {"chord", "angle"}, line.tessellation, line.tessellation.given());
}

template <class Visitor>
void visit(Visitor& v, SceneFile& scene) {
  std::string format = scene_format;
  v.field({"format", "", "bin_scenes/1", anything, true, true}, format);
  v.field({"seed", "", "of the request", anything, true, true}, scene.seed);
  v.field({"index", "", "of the scene: it depends on (seed, index) alone", anything, true, true}, scene.index);
  SceneBin bin{scene.bin};
  v.section({"bin", "", "its origin is the centre of the floor's top, z up"}, bin);
  v.field({"gravity", "m/s2", "in the bin frame"}, scene.gravity);
  v.field({"request_sha256", "", "digest of the request with all its defaults and of its models"},
          scene.request_sha256);
  v.list({"sensors", "", "as they measured: places and intrinsics are filled in"}, scene.sensors);
  v.list({"models", "", "by part line: the model, and how it was read where that is not the default", anything,
          !scene.models.empty()},
         scene.models);
  v.list({"parts", "", "ascending by id", anything, true, true}, scene.parts);
  v.section({"report", "", "measured on the true meshes"}, scene.report);
}

}  // namespace bin_scenes
