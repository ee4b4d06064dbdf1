/// Corners first, then points along sharp edges, then farthest points of the faces. What lies in closed cavities or
/// inside other shells is left out.
#include "bin_scenes/part/samples.hpp"

#include "shells.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/part/features.hpp"
#include "bin_scenes/part/mesh_query.hpp"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <string>

namespace bin_scenes {
namespace {

// Samples along sharp edges lie this much closer than those on faces: edge-edge contacts fall between samples.
constexpr double edge_spacing_share = 0.5;
// Of two edge or corner samples with the same direction, one goes if they are closer than this / edge spacing.
constexpr double crowded_share = 0.7;
// Sharp features may use this share of the aim; the spacing grows until they do.
constexpr double feature_share = 0.7;
// Candidates a face sample: the even cover is as good as the choice it has.
constexpr int candidates_per_sample = 16;

/// Points in a hash-free uniform grid, for "all points near here".
class PointGrid {
 public:
  PointGrid(const Aabb& box, double cell) : lower_(box.lower), cell_(cell) {
    // At most 64 cells an axis: the grid only has to be fine enough, not finer than the samples.
    cell_ = std::max(cell_, box.size().maxCoeff() / 64);
    BIN_SCENES_ASSERT(cell_ > 0.0 && !box.empty());
    for (int axis = 0; axis < 3; ++axis) count_[axis] = static_cast<int>(box.size()[axis] / cell_) + 1;
    cells_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
  }

  void insert(const Vec3& point, std::uint32_t id) {
    const auto c = cell_of(point);
    cells_[index(c[0], c[1], c[2])].push_back(id);
  }

  template <class Visit>
  void near(const Vec3& point, double radius, Visit&& visit) const {
    const auto lower = cell_of(point - Vec3::Constant(radius)), upper = cell_of(point + Vec3::Constant(radius));
    for (int z = lower[2]; z <= upper[2]; ++z)
      for (int y = lower[1]; y <= upper[1]; ++y)
        for (int x = lower[0]; x <= upper[0]; ++x)
          for (const std::uint32_t id : cells_[index(x, y, z)]) visit(id);
  }

 private:
  std::array<int, 3> cell_of(const Vec3& point) const {
    std::array<int, 3> c;
    for (int axis = 0; axis < 3; ++axis) {
      c[axis] = static_cast<int>(std::clamp((point[axis] - lower_[axis]) / cell_, 0.0, count_[axis] - 1.0));
    }
    return c;
  }
  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           count_[0] * (static_cast<std::size_t>(y) + static_cast<std::size_t>(count_[1]) * z);
  }

  Vec3 lower_;
  double cell_;
  std::array<int, 3> count_;
  std::vector<std::vector<std::uint32_t>> cells_;
};

/// What of the surface can touch another part at all.
class Touchable {
 public:
  explicit Touchable(const MeshQuery& query) : query_(query) {
    const Mesh& mesh = query.mesh();
    reach_ = 1e-5 * mesh.bounds().diagonal();
    label_shells();
  }

  /// Not the wall of a closed cavity.
  bool triangle(std::size_t t) const { return shell_volume_[shell_[t]] > 0; }

  /// Not inside another shell of the same part.
  bool point(const Vec3& p, const Vec3& normal) const {
    return shell_volume_.size() == 1 || !query_.inside(p + reach_ * normal);
  }

 private:
  void label_shells() {
    const Mesh& mesh = query_.mesh();
    const Shells labels = shells_of(mesh);
    shell_ = labels.of_triangle;
    shell_volume_.assign(labels.count, 0.0);
    BIN_SCENES_ASSERT(shell_.size() == mesh.triangles.size());
    const Vec3 center = mesh.bounds().center();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      shell_volume_[shell_[t]] += (mesh.vertices[mesh.triangles[t][0]] - center).dot(mesh.area_vector(t));
    // An open mesh has no volume by which walls of cavities could be recognized.
    if (shell_volume_.size() == 1) shell_volume_[0] = 1.0;
  }

  const MeshQuery& query_;
  double reach_;
  std::vector<std::uint32_t> shell_;
  std::vector<double> shell_volume_;
};

/// Points along a curve at even distances of about `step`, its ends (the corners) left out.
std::vector<SurfaceSample> along_curve(const FeatureCurve& curve, double step) {
  std::vector<SurfaceSample> samples;
  const double length = curve.length();
  const int pieces = std::max(curve.closed ? 3 : 1, static_cast<int>(std::lround(length / step)));
  const double spacing = length / pieces;
  BIN_SCENES_ASSERT(step > 0.0 && pieces > 0 && curve.normals.size() + 1 == curve.points.size());
  double walked = 0;
  int next = curve.closed ? 0 : 1;
  const int last = pieces - 1;
  for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
    const Vec3 segment = curve.points[i + 1] - curve.points[i];
    const double segment_length = segment.norm();
    for (; next <= last && next * spacing <= walked + segment_length; ++next) {
      const double part = segment_length > 0 ? (next * spacing - walked) / segment_length : 0.0;
      samples.push_back({curve.points[i] + part * segment, curve.normals[i], spacing});
    }
    walked += segment_length;
  }
  return samples;
}

/// Corner and edge samples for one spacing, the crowded ones thinned out. Corners go first and are kept first.
std::vector<SurfaceSample> feature_samples(const Features& features, double edge_spacing, const Aabb& box,
                                           const Touchable& touchable) {
  std::vector<SurfaceSample> samples;
  const double crowded = crowded_share * edge_spacing;
  PointGrid grid(box, crowded);
  const auto add = [&](const SurfaceSample& sample) {
    bool free = true;
    grid.near(sample.point, crowded, [&](std::uint32_t id) {
      const SurfaceSample& other = samples[id];
      free = free && ((other.point - sample.point).norm() >= crowded || other.normal.dot(sample.normal) < 0.5);
    });
    if (!free || !touchable.point(sample.point, sample.normal)) return;
    grid.insert(sample.point, static_cast<std::uint32_t>(samples.size()));
    samples.push_back(sample);
  };
  for (const FeatureCorner& corner : features.corners) add({corner.point, corner.normal, edge_spacing});
  for (const FeatureCurve& curve : features.curves) {
    for (const SurfaceSample& sample : along_curve(curve, edge_spacing)) add(sample);
  }
  return samples;
}

double touchable_area(const Mesh& mesh, const Touchable& touchable) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (touchable.triangle(t)) area += 0.5 * mesh.area_vector(t).norm();
  }
  return area;
}

/// Points spread over the faces by area: systematic sampling picks the triangle, the R2 sequence (Roberts 2018, "The
/// unreasonable effectiveness of quasirandom sequences") the place in it.
std::vector<SurfaceSample> face_candidates(const Mesh& mesh, const Touchable& touchable, double area, int count) {
  std::vector<SurfaceSample> candidates;
  candidates.reserve(count);
  double passed = 0;
  int next = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!touchable.triangle(t)) continue;
    const Vec3 area_vector = mesh.area_vector(t);
    const double twice_area = area_vector.norm();
    passed += 0.5 * twice_area;
    const auto& [a, b, c] = mesh.triangles[t];
    for (; next < count && (next + 0.5) * area < passed * count; ++next) {
      double whole;
      double u = std::modf(0.5 + next * 0.7548776662466927, &whole),
             v = std::modf(0.5 + next * 0.5698402909980532, &whole);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 p =
          mesh.vertices[a] + u * (mesh.vertices[b] - mesh.vertices[a]) + v * (mesh.vertices[c] - mesh.vertices[a]);
      const Vec3 normal = area_vector / twice_area;
      if (touchable.point(p, normal)) candidates.push_back({p, normal, 0.0});
    }
  }
  return candidates;
}

/// Farthest point sampling (Eldar et al. 1997, "The farthest point strategy for progressive image sampling"): adds the
/// candidate that is farthest from all samples, again and again. A sample covers only what faces the same direction as
/// it does, so both sides of a sheet get their own.
void add_farthest(std::vector<SurfaceSample>& samples, const std::vector<SurfaceSample>& candidates, std::size_t count,
                  double spacing, const Aabb& box) {
  PointGrid grid(box, spacing);
  for (std::uint32_t i = 0; i < candidates.size(); ++i) grid.insert(candidates[i].point, i);
  std::vector<double> distance(candidates.size(), 2 * box.diagonal());
  const auto cover = [&](const SurfaceSample& sample, double radius) {
    grid.near(sample.point, radius, [&](std::uint32_t i) {
      if (sample.normal.dot(candidates[i].normal) <= 0) return;
      distance[i] = std::min(distance[i], (sample.point - candidates[i].point).norm());
    });
  };
  for (const SurfaceSample& sample : samples) cover(sample, 2 * spacing);

  // Distances only fall: the top of the heap is the farthest if its entry is still true. Ties go to the lower index.
  using Entry = std::pair<double, std::int64_t>;
  std::vector<Entry> entries;
  entries.reserve(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) entries.emplace_back(distance[i], -static_cast<std::int64_t>(i));
  std::priority_queue<Entry> heap(std::less<Entry>(), std::move(entries));
  const std::size_t first_face = samples.size();
  double farthest = spacing;
  while (samples.size() < count && !heap.empty()) {
    stop_if_cancelled();
    const auto [key, minus_index] = heap.top();
    heap.pop();
    const std::size_t i = static_cast<std::size_t>(-minus_index);
    if (distance[i] < key) {
      heap.emplace(distance[i], minus_index);
      continue;
    }
    if (key <= 0) break;
    farthest = std::min(key, box.diagonal());
    samples.push_back(candidates[i]);
    cover(candidates[i], farthest);
  }
  // On average neighbours lie further apart than the covering radius: 1.77 farthest^2 of surface a sample (measured on
  // a sphere) is a hexagonal pattern of pitch 1.43 farthest.
  for (std::size_t i = first_face; i < samples.size(); ++i) samples[i].spacing = 1.43 * farthest;
}

/// Sorts order[begin, end) so that every run of `cluster` samples is compact: halves the set across its longest side,
/// at a multiple of the run, down to single runs. Ties go by index: nothing depends on how the library sorts.
void cluster_order(const std::vector<SurfaceSample>& samples, std::vector<std::uint32_t>& order, std::size_t begin,
                   std::size_t end, std::size_t cluster) {
  const std::size_t runs = (end - begin + cluster - 1) / cluster;
  if (runs < 2) {
    std::sort(order.begin() + begin, order.begin() + end);
    return;
  }
  Aabb box;
  for (std::size_t i = begin; i < end; ++i) box.extend(samples[order[i]].point);
  int axis;
  box.size().maxCoeff(&axis);
  const std::size_t mid = begin + runs / 2 * cluster;
  std::nth_element(order.begin() + begin, order.begin() + mid, order.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double pa = samples[a].point[axis], pb = samples[b].point[axis];
                     return pa != pb ? pa < pb : a < b;
                   });
  cluster_order(samples, order, begin, mid, cluster);
  cluster_order(samples, order, mid, end, cluster);
}

std::vector<SurfaceSample> clustered(const std::vector<SurfaceSample>& samples, std::size_t cluster) {
  std::vector<std::uint32_t> order(samples.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  cluster_order(samples, order, 0, order.size(), cluster);
  BIN_SCENES_ASSERT(order.size() == samples.size());
  BIN_SCENES_ASSERT(each_is(order, [&](std::uint32_t i) { return i < samples.size(); }));
  std::vector<SurfaceSample> sorted;
  sorted.reserve(samples.size());
  for (const std::uint32_t i : order) sorted.push_back(samples[i]);
  return sorted;
}

}  // namespace

SampleSet surface_samples(const MeshQuery& query, const SampleOptions& options) {
  const Mesh& mesh = query.mesh();
  if (mesh.empty()) {
    throw input_error("a mesh without triangles has no surface to sample", "surface_samples", "give a closed mesh");
  }
  if (options.count < 1 || options.count > 1000000) {
    throw input_error("sample count " + std::to_string(options.count), "SampleOptions", "use 1 to 1000000");
  }
  const Aabb box = mesh.bounds();
  const Touchable touchable(query);
  const Features features = sharp_features(mesh, options.sharp_angle);
  const double area = touchable_area(mesh, touchable);
  double edges = 0;
  for (const FeatureCurve& curve : features.curves) edges += curve.length();

  // Spacing h from count = corners + edges / (h / 2) + (area - strips) / (0.87 h^2): the samples of an edge cover a
  // strip of 0.7 h on both of its faces, so the terms in the edges nearly cancel until the strips cover the whole part.
  const double left = std::max(0.5 * options.count, options.count - static_cast<double>(features.corners.size()));
  double spacing = std::max(std::sqrt(area / (0.87 * left)), edges / (edge_spacing_share * left));
  BIN_SCENES_ASSERT(area >= 0.0 && edges >= 0.0 && left > 0.0);
  SampleSet set;
  for (;; spacing *= 1.2) {
    set.samples = feature_samples(features, edge_spacing_share * spacing, box, touchable);
    if (set.samples.size() <= feature_share * options.count || spacing > box.diagonal()) break;
  }
  const auto wanted = static_cast<std::size_t>(options.count);
  if (set.samples.size() < wanted) {
    const int count = candidates_per_sample * static_cast<int>(wanted - set.samples.size());
    add_farthest(set.samples, face_candidates(mesh, touchable, area, count), wanted, spacing, box);
  }
  set.samples = clustered(set.samples, static_cast<std::size_t>(set.cluster));
  BIN_SCENES_ASSERT(
      each_is(set.samples, [](const SurfaceSample& s) { return s.point.allFinite() && is_unit(s.normal); }));
  return set;
}

SampleSet surface_samples(const Mesh& mesh, const SampleOptions& options) {
  return surface_samples(MeshQuery(mesh), options);
}

}  // namespace bin_scenes
