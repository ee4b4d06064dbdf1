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
  std::vector<Vec3> vertices;  ///< mm
};
/// The folders models and models_eval. Returns the models by object.
std::map<int, BopModel> verify_models(const BopFolder& folder, Findings& findings);

/// A scene in both of its folders.
struct BopScene {
  std::filesystem::path bop;  ///< in BOP's layout
  std::filesystem::path own;  ///< with scene.json, request.yaml and images
  std::string split;
  const SceneFile& file;    ///< scene.json
  bool has_labels = false;  ///< true labels are among the images
};
void verify_bop(const BopFolder& folder, const BopScene& scene, const std::map<int, BopModel>& models,
                Findings& findings);
void verify_bop_root(const BopFolder& folder, Findings& findings);

}  // namespace bin_scenes
