/// One heap of a BOP set under the measures of an audit.
#pragma once

#include "bin_scenes/generate/generator.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "dataset/bop_reader.hpp"

#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

/// A figure of every part.
struct AuditMeasure {
  const char* name;
  const char* unit;
  double limit;  ///< parts above it are counted
  std::vector<double> values;
};

struct AuditFigures {
  AuditMeasure overlap{"overlap with another part", "% of diagonal", 1.0, {}};
  AuditMeasure overlap_mm{"overlap with another part", "mm", 0.1, {}};
  AuditMeasure into_bin{"overlap with bin or table", "mm", 0.1, {}};
  AuditMeasure gap{"free fall", "% of diagonal", 0.5, {}};
  AuditMeasure gap_mm{"free fall", "mm", 0.1, {}};
  AuditMeasure drift{"drift in 0.5 s", "% of diagonal", 1.0, {}};
  AuditMeasure drift_mm{"drift in 0.5 s", "mm", 0.5, {}};
  AuditMeasure turn{"turn in 0.5 s", "degree", 1.0, {}};
  AuditMeasure visible{"visible fraction told, off from own rays", "", 0.05, {}};
  AuditMeasure mask{"pixels of mask_visib told, off from the mask", "%", 1.0, {}};
  AuditMeasure apart_mm{"views disagree on a part's place", "mm", 1.0, {}};
  AuditMeasure apart_degree{"views disagree on a part's turn", "degree", 1.0, {}};
  std::size_t scenes = 0, heaps = 0, parts = 0, escaped = 0;

  std::vector<AuditMeasure*> all();
};

/// Views of one heap: several images of the same parts in the same places.
struct AuditHeap {
  std::vector<const BopView*> views;
};
std::vector<AuditHeap> heaps_of(const BopSet& set, AuditFigures& figures);

/// What the parts lie in.
struct AuditBin {
  std::optional<Vec3> inner_size;  ///< m; a box around the world's origin, with its floor at z = 0
  std::optional<double> floor;     ///< m; a table at this height
  bool fitted = false;  ///< a box as wide as the parts of each heap. None of all: a table where the lowest end
};

class Auditor {
 public:
  explicit Auditor(const BopSet& set);
  void audit(const AuditHeap& heap, const AuditBin& bin, AuditFigures& figures);

 private:
  struct Placed;
  Placed place(const BopView& view, const AuditBin& bin) const;
  void audit_quality(const Placed& placed, AuditFigures& figures) const;
  void audit_drift(const Placed& placed, AuditFigures& figures);
  void audit_image(const BopView& view, const Placed& placed, AuditFigures& figures);

  const BopSet& set_;
  std::map<int, PartModelPtr> models_;
  Generator generator_;
  SensorRig rig_;
};

}  // namespace bin_scenes
