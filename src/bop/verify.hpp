/// Checks the files that this project wrote in BOP's layout: each file against scene.json, and the files against each
/// other. Faults are added to the list of findings, and the check continues. Data sets of other origin, which have no
/// scene.json, are measured by the audit (src/audit) instead.
#pragma once

#include "bin_scenes/config/scene_file.hpp"
#include "bop/root.hpp"
#include "core/findings.hpp"

#include <map>

namespace bin_scenes {

struct BopModel {
  std::vector<Vec3> vertices;  ///< vertices of the mesh (mm)
};
/// Checks the folders models and models_eval; returns the models by obj_id.
std::map<int, BopModel> verify_models(const BopFolder& folder, Findings& findings);

/// A scene to be checked, with its folder in BOP's layout and its folder in this project's layout.
struct BopScene {
  std::filesystem::path bop;  ///< folder in BOP's layout
  std::filesystem::path own;  ///< folder with scene.json, request.yaml and images
  std::string split;
  const SceneFile& file;    ///< contents of scene.json
  bool has_labels = false;  ///< whether true labels are among the images
};
void verify_bop(const BopFolder& folder, const BopScene& scene, const std::map<int, BopModel>& models,
                Findings& findings);
void verify_bop_root(const BopFolder& folder, Findings& findings);

}  // namespace bin_scenes
