/// Applies the measures of an audit to one heap of a BOP data set: overlap, gap and drift. It needs poses and models,
/// but no images; labels.hpp judges images, and judge.hpp compares all values with the limits.
#pragma once

#include "audit/labels.hpp"
#include "bin_scenes/generate/generator.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "bop/reader.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// Identifies a part in an image, or an image as a whole.
struct AuditPlace {
  static constexpr std::size_t image = SIZE_MAX;
  std::size_t view = 0;       ///< index of the image in BopSet::views
  std::size_t entry = image;  ///< index of the part in the image's scene_gt; `image`: the whole image
};

/// A quantity that is measured for every part or for every image.
struct AuditMeasure {
  const char* key;  ///< name of the measure in the option --limit
  const char* name;
  const char* unit;
  double limit;  ///< largest acceptable value; larger values are counted
  bool strict;   ///< true: no value may exceed the limit; false: a share of the values may
  std::vector<double> values = {};
  std::vector<AuditPlace> places = {};  ///< where each value was measured
  void add(double value, const AuditPlace& place) {
    values.push_back(value);
    places.push_back(place);
  }
};

struct AuditFigures {
  AuditMeasure overlap{"overlap", "overlap with another part", "% of diagonal", 1.0, false};
  AuditMeasure overlap_mm{"overlap_mm", "overlap with another part", "mm", 0.1, false};
  AuditMeasure into_bin{"into_bin", "overlap with bin or table", "mm", 0.1, false};
  AuditMeasure gap{"gap", "free fall", "% of diagonal", 0.5, false};
  AuditMeasure gap_mm{"gap_mm", "free fall", "mm", 0.1, false};
  AuditMeasure drift{"drift", "drift in 0.5 s", "% of diagonal", 1.0, false};
  AuditMeasure drift_mm{"drift_mm", "drift in 0.5 s", "mm", 0.5, false};
  AuditMeasure turn{"turn", "turn in 0.5 s", "degree", 1.0, false};
  AuditMeasure visible{"visible", "visible fraction stated, off from own", "", 0.05, false};
  AuditMeasure counted{"counted", "pixels of mask_visib stated, off from it", "%", 1.0, true};
  AuditMeasure apart_mm{"views_mm", "views disagree on a part's place", "mm", 1.0, true};
  AuditMeasure apart_degree{"views_degree", "views disagree on a part's turn", "degree", 1.0, true};
  AuditMeasure mask{"mask", "mask off from the model's silhouette", "1 - IoU", 0.1, true};
  AuditMeasure mask_visible{"mask_visib", "mask_visib off from what is visible", "1 - IoU", 0.2, true};
  AuditMeasure shift{"shift", "mask shifted against the silhouette", "px", 0.75, true};
  AuditMeasure depth{"depth", "depth off from the model's, beyond noise", "mm", 1.0, true};
  AuditMeasure camera{"camera", "images shifted against K", "px", 0.75, true};
  AuditMeasure depth_common{"depth_common", "depth of whole images off from the models'", "mm", 5.0, true};
  std::size_t scenes = 0, heaps = 0, parts = 0, escaped = 0;
  std::map<std::size_t, LabelledImage> images;  ///< labels of each image, by index into BopSet::views
  std::vector<std::string> faults;              ///< errors that concern the whole data set

  std::vector<AuditMeasure*> all();
};

/// The images of one heap: they show the same parts at the same poses.
struct AuditHeap {
  std::vector<const BopView*> views;
};
std::vector<AuditHeap> heaps_of(const BopSet& set, AuditFigures& figures);

/// The surroundings of the parts in a heap: bin or table, and parts that are not in the ground truth.
struct AuditBin {
  /// A part that is in the heap without being in the ground truth.
  struct Other {
    PartLine line;  ///< path and loading options of its model
    Pose in_world;
  };
  std::vector<Other> others;
  std::optional<Vec3> inner_size;  ///< m; the bin is a box around the world's origin, its floor at z = 0
  std::optional<double> floor;     ///< m; the parts are on a table at this height
  bool fitted = false;             ///< the bin is a box around each heap. If none is set: a table at the lowest parts
};

class Auditor {
 public:
  explicit Auditor(const BopSet& set);
  /// Measures overlap, gap and drift of the parts of one heap, and adds the values to `figures`.
  void audit(const AuditHeap& heap, const AuditBin& bin, AuditFigures& figures);
  /// Compares the labels of all images of the audited heaps with the models (camera_error.hpp, labels.hpp).
  /// @param progress  is called with the completed share, 0 to 1
  void audit_labels(AuditFigures& figures, const std::function<void(double)>& progress);

 private:
  struct Placed;
  Placed place(const BopView& view, const AuditBin& bin) const;
  void add_others(const AuditBin& bin, Placed& placed) const;
  void audit_quality(const Placed& placed, AuditFigures& figures) const;
  void audit_drift(const Placed& placed, AuditFigures& figures);
  void correct_camera(std::size_t number, const CameraError& error, const LabelAuditor& auditor,
                      AuditFigures& figures) const;
  void correct_depth(const std::string& camera, const std::vector<std::size_t>& views, AuditFigures& figures) const;
  static void add_labels(std::size_t number, const LabelledImage& image, AuditFigures& figures);

  const BopSet& set_;
  std::map<int, PartModelPtr> models_;
  Generator generator_;
  std::map<std::size_t, Surroundings> around_;  ///< surroundings of the audited images, by index into BopSet::views
};

}  // namespace bin_scenes
