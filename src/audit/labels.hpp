/// Compares the labels of a BOP image with the models at their stated poses: masks, depth, missing files, and exchanged
/// parts. The silhouettes and the depth of the models are drawn by the raster layer; the camera is corrected first by
/// the error that was found over the whole set.
#pragma once

#include "audit/camera_error.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "bop/files.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace bin_scenes {

constexpr double mm_per_metre = 1e3;

/// The deviations of the labels of a part in an image. A value is none if the data set does not state it, or if too
/// little of the part is visible.
struct LabelFigures {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< px, centre of the model's silhouette
  std::optional<double> iou;                     ///< intersection over union of mask and silhouette, see tolerant_iou()
  std::optional<double> iou_visible;     ///< intersection over union of mask_visib and the visible region, which is
                                         ///< found by rays or by bop_toolkit's rule
  std::optional<Eigen::Vector2d> shift;  ///< px, of the mask against the silhouette: x right, y down
  std::optional<double> depth;           ///< mm, median of measured depth minus depth of the model
  double depth_spread = 0.0;             ///< mm, robust standard deviation of this difference over the pixels
  double depth_error = 0.0;              ///< mm, standard error of `depth` according to depth_spread
  double model_depth = 0.0;              ///< m, mean depth of the model over these pixels
  double obliqueness = 0.0;              ///< mean of distance / depth - 1 of these pixels
  std::optional<double> visible;         ///< visib_fract minus the fraction that the audit finds by the same rule
  std::optional<double> counted;         ///< %, deviation of px_count_visib from the pixels of mask_visib
  std::vector<std::string> faults;       ///< faults of the part's labels, as text: missing masks, exchanged labels
};

struct LabelledImage {
  int width = 0, height = 0;
  std::vector<LabelFigures> parts;  ///< by entry of scene_gt
  std::vector<std::string> faults;  ///< files that are missing, as text
  CameraError camera;               ///< error of the stated camera, including that of the whole set
  double depth_offset = 0.0;        ///< mm, median over the parts of measured depth minus depth of the model
};

/// The bin and further parts, which may hide the parts of the ground truth.
struct Surroundings {
  Bin bin;
  Pose shift;  ///< transform from the world frame of the data set to the bin frame
  struct Other {
    PartModelPtr model;
    Pose in_world;
  };
  std::vector<Other> others = {};  ///< parts without an entry in the ground truth
};

class LabelAuditor {
 public:
  LabelAuditor(const BopSet& set, const std::map<int, PartModelPtr>& models, SensorRig& rig);
  /// Compares the labels of an image with the models. The camera is corrected by `error` before.
  LabelledImage compare(const BopView& view, const Surroundings& around, const CameraError& error) const;

 private:
  struct Rendered;
  struct Stored;
  LabelledImage missing_files(const BopView& view) const;
  Rendered render(const BopView& view, const Surroundings& around, const CameraError& error, int width,
                  int height) const;
  LabelFigures figures(const BopView& view, std::size_t entry, const Rendered& own, const Stored& stored) const;
  void compare_visible(const BopView& view, std::size_t entry, const Rendered& own, const Stored& stored,
                       LabelFigures& figures) const;
  void name_exchanged(const BopView& view, const Rendered& own, const Stored& stored, LabelledImage& image) const;

  const std::map<int, PartModelPtr>& models_;
  SensorRig& rig_;
  std::map<std::string, std::set<std::string>> kinds_;  ///< kinds of images and masks in the data set, by suffix
};

}  // namespace bin_scenes
