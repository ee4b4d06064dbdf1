/// Files of a finished scene. Everything is written to a temporary name first and renamed: nothing half-written.
#pragma once

#include "bin_scenes/scene/scene.hpp"
#include "bin_scenes/sensor/range_camera.hpp"

#include <string>
#include <vector>

namespace bin_scenes {

/// scene.json as text (interfaces.md, format "bin_scenes/1").
std::string scene_json(const Scene& scene, const Request& request);
/// Reads poses, states and ids back; throws an input Error naming file and key.
Scene read_scene_json(const std::string& path);

void write_text(const std::string& path, const std::string& text);
/// Organised, binary, optical frame, pose as VIEWPOINT; fields x y z normal_x normal_y normal_z intensity label.
void write_pcd(const std::string& path, const RangeImage& image);
/// Depth as 16-bit PNG (0.1 mm), labels as 16-bit PNG, and a shaded picture to look at.
void write_pngs(const std::string& directory, const RangeImage& image);
/// BOP layout (scene_gt.json, scene_camera.json, scene_gt_info.json, depth/, mask_visib/), instance = id.
void write_bop(const std::string& directory, const Scene& scene, const Request& request,
               const std::vector<RangeImage>& images);

}  // namespace bin_scenes
