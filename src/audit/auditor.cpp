/// Puts the parts of a BOP scene into a request and measures overlap, gap and drift by the library's own judge and
/// solver.
#include "audit/auditor.hpp"

#include "bin_scenes/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr double degrees_per_radian = 180.0 / M_PI;
constexpr double drift_seconds = 0.5;

double turn_between(const Pose& a, const Pose& b) {
  return degrees_per_radian * a.orientation.angularDistance(b.orientation);
}

/// Further views of a heap show the same parts, up to what calibration and annotation err.
bool same_heap(const BopView& a, const BopView& b) {
  constexpr double most_apart = 0.005, most_turned = 5.0;  // m, degree
  if (a.scene != b.scene || a.parts.size() != b.parts.size() || a.parts.empty()) return false;
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    if (a.parts[i].object != b.parts[i].object) return false;
    if ((a.parts[i].in_world.position - b.parts[i].in_world.position).norm() > most_apart) return false;
    if (turn_between(a.parts[i].in_world, b.parts[i].in_world) > most_turned) return false;
  }
  return true;
}

/// Where parts that lie on the table end: the centre of what ends near the lowest point.
double fitted_floor(const std::vector<double>& ends, double diagonal) {
  const double lowest = *std::min_element(ends.begin(), ends.end());
  std::vector<double> near;
  for (const double end : ends)
    if (end - lowest < 0.02 * diagonal) near.push_back(end);
  std::sort(near.begin(), near.end());
  return near[near.size() / 2];
}

}  // namespace

std::vector<AuditMeasure*> AuditFigures::all() {
  return {&overlap, &overlap_mm, &into_bin,     &gap,  &gap_mm,       &drift, &drift_mm, &turn,   &visible,
          &counted, &apart_mm,   &apart_degree, &mask, &mask_visible, &shift, &depth,    &camera, &depth_common};
}

std::vector<AuditHeap> heaps_of(const BopSet& set, AuditFigures& figures) {
  std::vector<AuditHeap> heaps;
  for (const BopView& view : set.views) {
    if (!heaps.empty() && set.world_stated && same_heap(*heaps.back().views.front(), view)) {
      const BopView& first = *heaps.back().views.front();
      for (std::size_t i = 0; i < view.parts.size(); ++i) {
        const Pose &a = first.parts[i].in_world, &b = view.parts[i].in_world;
        const AuditPlace place{static_cast<std::size_t>(&view - set.views.data()), i};
        figures.apart_mm.add(mm_per_metre * (a.position - b.position).norm(), place);
        figures.apart_degree.add(turn_between(a, b), place);
      }
      heaps.back().views.push_back(&view);
    } else {
      heaps.push_back({{&view}});
    }
  }
  return heaps;
}

/// A heap as a request that goes on from it.
struct Auditor::Placed {
  std::size_t view = 0;
  LoadedRequest loaded;
  Scene scene;
  std::vector<std::size_t> entry;  ///< of the view, by id
  Pose shift;                      ///< from the set's world to the bin frame
  AuditPlace place(int id) const { return {view, entry[static_cast<std::size_t>(id)]}; }
};

Auditor::Auditor(const BopSet& set) : set_(set) {
  LoadOptions options;
  options.unit = Unit::millimetre;
  for (const auto& [object, path] : set.models) models_[object] = PartModel::load(path, options);
}

Auditor::Placed Auditor::place(const BopView& view, const AuditBin& bin) const {
  Placed placed;
  placed.view = static_cast<std::size_t>(&view - set_.views.data());
  std::vector<double> ends;
  double diagonal = 0.0;
  Aabb around;
  for (const BopPart& part : view.parts) {
    const PartModel& model = *models_.at(part.object);
    double end = 1e300;
    for (const Vec3& corner : model.corners()) {
      around.extend(part.in_world * corner);
      end = std::min(end, (part.in_world * corner).z());
    }
    ends.push_back(end);
    diagonal = std::max(diagonal, model.diagonal());
  }
  Request& request = placed.loaded.request;
  if (!bin.inner_size) placed.shift.position.z() = -bin.floor.value_or(fitted_floor(ends, diagonal));
  if (bin.inner_size) {
    request.bin.inner_size = *bin.inner_size;
  } else if (bin.fitted) {
    placed.shift.position.head<2>() = -around.center().head<2>();
    request.bin.inner_size = around.size() + Vec3(0.0, 0.0, diagonal);
  } else {
    request.bin.kind = Bin::Kind::floor;
  }
  request.pour.pattern = Pour::Pattern::given;
  request.seconds = drift_seconds;
  for (const auto& [object, model] : models_) {
    PartLine line;
    line.model = line.path = set_.models.at(object);
    line.unit = Unit::millimetre;
    for (std::size_t i = 0; i < view.parts.size(); ++i) {
      if (view.parts[i].object != object) continue;
      ScenePart part;
      part.id = static_cast<int>(placed.scene.parts.size());
      part.line = request.parts.size();
      part.model = line.model;
      part.pose = placed.shift * view.parts[i].in_world;
      part.state = PartState::resting;
      line.poses.push_back(part.pose);
      placed.scene.parts.push_back(part);
      placed.entry.push_back(i);
    }
    line.count = line.poses.size();
    if (line.count == 0) continue;
    request.parts.push_back(line);
    placed.loaded.parts.push_back(model);
  }
  add_others(bin, placed);
  return placed;
}

/// Parts without an entry carry and hide others, and are not judged.
void Auditor::add_others(const AuditBin& bin, Placed& placed) const {
  for (const AuditBin::Other& other : bin.others) {
    ScenePart part;
    part.id = static_cast<int>(placed.scene.parts.size());
    part.line = placed.loaded.parts.size();
    part.model = other.line.model;
    part.pose = placed.shift * other.in_world;
    part.state = PartState::fixed;
    PartLine line = other.line;
    line.count = 1;
    line.fixed = true;
    line.poses = {part.pose};
    placed.scene.parts.push_back(part);
    placed.loaded.parts.push_back(PartModel::load(line.path, load_options(line)));
    placed.loaded.request.parts.push_back(line);
  }
}

void Auditor::audit(const AuditHeap& heap, const AuditBin& bin, AuditFigures& figures) {
  const BopView& first = *heap.views.front();
  ++figures.heaps;
  figures.parts += first.parts.size();
  if (first.parts.empty()) return;
  Placed placed = place(first, bin);
  for (ScenePart& part : placed.scene.parts) {
    if (part.state == PartState::fixed) continue;
    const Vec3 center = part.pose * placed.loaded.parts[part.line]->mass().center;
    const bool beside =
        bin.inner_size && (center.head<2>().array().abs() > 0.5 * bin.inner_size->head<2>().array()).any();
    if (!beside && center.z() > 0.0) continue;
    part.state = PartState::escaped;
    ++figures.escaped;
  }
  audit_quality(placed, figures);
  audit_drift(placed, figures);
  Surroundings around{placed.loaded.request.bin, placed.shift};
  const std::size_t own = placed.entry.size();
  for (std::size_t i = 0; i < bin.others.size(); ++i)
    around.others.push_back({placed.loaded.parts[placed.scene.parts[own + i].line], bin.others[i].in_world});
  if (bin.fitted) around.bin.kind = Bin::Kind::none;  // walls that nobody stated must not hide parts
  for (const BopView* view : heap.views) around_[static_cast<std::size_t>(view - set_.views.data())] = around;
}

void Auditor::audit_quality(const Placed& placed, AuditFigures& figures) const {
  for (const PartQuality& part : part_quality(placed.scene, placed.loaded)) {
    if (static_cast<std::size_t>(part.id) >= placed.entry.size()) continue;
    const double diagonal = placed.loaded.parts[placed.scene.parts[static_cast<std::size_t>(part.id)].line]->diagonal();
    const AuditPlace place = placed.place(part.id);
    figures.overlap.add(100.0 * part.overlap_relative, place);
    figures.overlap_mm.add(mm_per_metre * part.overlap, place);
    figures.into_bin.add(mm_per_metre * part.into_bin, place);
    if (!std::isfinite(part.gap)) continue;
    figures.gap.add(100.0 * part.gap / diagonal, place);
    figures.gap_mm.add(mm_per_metre * part.gap, place);
  }
}

void Auditor::audit_drift(const Placed& placed, AuditFigures& figures) {
  Heap heap = generator_.heap(placed.loaded.request);
  heap.settle();
  const Scene after = heap.scene();
  for (const ScenePart& start : placed.scene.parts) {
    if (start.state == PartState::escaped || start.state == PartState::fixed) continue;
    const ScenePart& end = after.parts.at(static_cast<std::size_t>(start.id));
    if (!end.pose.finite()) continue;
    const PartModel& model = *placed.loaded.parts[start.line];
    const double move = (end.pose * model.mass().center - start.pose * model.mass().center).norm();
    const AuditPlace place = placed.place(start.id);
    figures.drift.add(100.0 * move / model.diagonal(), place);
    figures.drift_mm.add(mm_per_metre * move, place);
    figures.turn.add(turn_between(start.pose, end.pose), place);
  }
}

}  // namespace bin_scenes
