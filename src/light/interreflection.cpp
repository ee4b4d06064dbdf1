/// Casts rays from a point, looks how the projector lights what they hit, and carries that light back. A second bounce
/// is one more ray from there.
#include "light/interreflection.hpp"

#include "light/lobe.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace bin_scenes {

namespace {

/// Points of the unit square that fill it evenly, any number of them (Hammersley's, shifted and scrambled by a key).
class Net {
 public:
  Net(int count, Random key)
      : count_(count), shift_(key.uniform()), scramble_(static_cast<std::uint32_t>(key.next())) {}
  Eigen::Vector2d at(int i) const {
    const double u = (i + shift_) / count_;
    std::uint32_t bits = static_cast<std::uint32_t>(i), reversed = 0;
    for (int k = 0; k < 32; ++k, bits >>= 1) reversed = (reversed << 1) | (bits & 1u);
    return {u, (reversed ^ scramble_) * 0x1p-32};
  }

 private:
  int count_;
  double shift_;
  std::uint32_t scramble_;
};

std::vector<int> shuffled(int count, Random random) {
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

/// Rays, what they meet and how it is lit.
struct Batch {
  std::vector<SeenPoint> from;
  std::vector<Lobe::Sample> samples;   ///< factor: of the whole path so far
  std::vector<std::size_t> onward_of;  ///< ray of the batch before
  std::vector<double> angles;          ///< rad, width of the cone that a sample stands for
  std::vector<SeenPoint> met;
  std::vector<Vec3> eyes;
  std::vector<double> distances;
  std::vector<Lit> lit;

  void clear() {
    from.clear();
    samples.clear();
    onward_of.clear();
    angles.clear();
    met.clear();
    eyes.clear();
    distances.clear();
    lit.clear();
  }
  /// Rays that fill the lobe of what an eye sees of a point.
  void spread(const Surfaces& surfaces, const SeenPoint& point, const Vec3& eye, int count, Random key) {
    Surface own;
    const Lobe lobe(surfaces.at(point.line, point.label, point.position, own), point.normal,
                    (eye - point.position).normalized());
    const Net net(count, key);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d at = net.at(i);
      samples.push_back(lobe.at(at.x(), at.y()));
      samples.back().factor /= count;
      from.push_back(point);
      angles.push_back(1.0 / std::sqrt(count * samples.back().density));
    }
  }
  double nearness() const {
    double sum = 0.0;
    for (const double distance : distances) {
      if (!std::isnan(distance)) sum += 1.0 / std::max(distance, 1e-5);
    }
    return sum / static_cast<double>(distances.size());
  }

  void trace(const Scenery& scenery) {
    std::vector<Ray> rays(from.size());
    std::vector<Hit> hits(from.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      rays[i] = ray_along(from[i].position, from[i].normal, samples[i].direction);
      if (samples[i].factor <= 0.0) rays[i].direction = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    }
    scenery.first_hits(rays.data(), hits.data(), rays.size(), Scenery::Rays::scattered);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      met.push_back(point_of(rays[i], hits[i]));
      eyes.push_back(from[i].position);
      distances.push_back(hits[i].distance);
    }
  }
  void light(const Lamp& lamp) {
    lit.resize(met.size());
    lamp.light(met.data(), eyes.data(), lit.data(), lit.size());
  }
};

/// Sends one ray on from each place that those of a batch met; together they fill the hemisphere as evenly. In another
/// order, or where they go would depend on where they came from.
void go_on(const Surfaces& surfaces, const Batch& first, Random key, Batch& second) {
  const auto samples = static_cast<int>(first.met.size());
  const Net onward(samples, key.of_piece(1));
  const std::vector<int> order = shuffled(samples, key.of_piece(2));
  for (std::size_t i = 0; i < first.met.size(); ++i) {
    const SeenPoint& met = first.met[i];
    const Lobe::Sample& before = first.samples[i];
    if (!met.hit) continue;
    const Eigen::Vector2d at = onward.at(order[i]);
    Surface own;
    const Surface& surface = surfaces.at(met.line, met.label, met.position, own);
    second.samples.push_back(Lobe(surface, met.normal, -before.direction).at(at.x(), at.y()));
    second.angles.push_back(1.0 / std::sqrt(std::sqrt(samples) * second.samples.back().density));
    second.samples.back().factor *= before.factor;
    second.from.push_back(met);
    second.onward_of.push_back(i);
  }
}

/// By which a quantity that grows by `slope` with the place of what a ray meets, on its plane, grows with the place
/// where the ray begins.
Vec3 carried_back(const Vec3& slope, const SeenPoint& met, const Vec3& direction) {
  return slope - slope.dot(direction) / met.normal.dot(direction) * met.normal;
}

/// The same for the length of a path that goes on from where the ray ends.
Vec3 longer_by(const Vec3& slope, const SeenPoint& met, const Vec3& direction) {
  return carried_back(slope, met, direction) - met.normal / met.normal.dot(direction);
}

/// @param before  the batch whose rays ended where those of `batch` begin; none: they begin at the point that is seen
void add_paths(const Lamp& lamp, const Batch& batch, const Batch* before, std::vector<Path>& paths) {
  for (std::size_t i = 0; i < batch.lit.size(); ++i) {
    const Lit& lit = batch.lit[i];
    if (lit.code != Validity::valid || !(lit.reflected > 0.0)) continue;
    const SeenPoint& met = batch.met[i];
    const Vec3& direction = batch.samples[i].direction;
    Path path;
    path.column = lit.column;
    path.weight = batch.samples[i].factor * lit.reflected / (lit.distance * lit.distance);
    path.slope = carried_back(lamp.slope(met.position, lit.column), met, direction);
    // A cone about the ray covers as much of the plane as a step beside the ray's origin does.
    path.spread = batch.angles[i] * batch.distances[i] * (path.slope - path.slope.dot(direction) * direction).norm();
    path.length = lit.distance + batch.distances[i];
    path.longer = longer_by(lamp.direction_at(met.position), met, direction);
    if (before) {
      const std::size_t k = batch.onward_of[i];
      const SeenPoint& first = before->met[k];
      path.slope = carried_back(path.slope, first, before->samples[k].direction);
      path.length += before->distances[k];
      path.longer = longer_by(path.longer, first, before->samples[k].direction);
    }
    paths.push_back(path);
  }
}

}  // namespace

ProjectorLamp::ProjectorLamp(const Scenery& scenery, const Lens& projector, const Pose& pose, const Surfaces& surfaces)
    : scenery_(scenery), projector_(projector), pose_(pose), surfaces_(surfaces) {
  share_ = pose.orientation * Vec3(projector.fx, projector.skew, projector.cx);
  ahead_ = pose.orientation * Vec3::UnitZ();
}

void ProjectorLamp::light(const SeenPoint* points, const Vec3* eyes, Lit* lit, std::size_t count) const {
  bin_scenes::light({scenery_, projector_, pose_, surfaces_}, eyes, points, lit, count);
}

Vec3 ProjectorLamp::slope(const Vec3& point, double column) const {
  return (share_ - column * ahead_) / ahead_.dot(point - pose_.position);
}

bool gather(const LitScene& scene, const SeenPoint& point, const Vec3& eye, const Search& search, Random key,
            Gathered& out) {
  out.paths.clear();
  thread_local Batch first;  // keeps its memory: it is asked for each node
  first.clear();
  first.spread(scene.surfaces, point, eye, search.samples, key.of_piece(0));
  first.trace(scene.scenery);
  out.nearness = first.nearness();
  if (out.nearness >= search.too_near) return false;
  first.light(scene.lamp);
  add_paths(scene.lamp, first, nullptr, out.paths);
  if (search.bounces < 2) return true;
  Batch second;
  go_on(scene.surfaces, first, key, second);
  second.trace(scene.scenery);
  second.light(scene.lamp);
  add_paths(scene.lamp, second, &first, out.paths);
  return true;
}

}  // namespace bin_scenes
