/// Images without noise against a ray cast of the tests in double precision: depth, labels, shadows, visible fractions.
/// Pixels at borders are left out, where the two may round to different sides.
#include "sensors/rows.hpp"
#include "sensors/stage.hpp"

#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "core/in_parallel.hpp"
#include "sensor/stage.hpp"

#include <algorithm>
#include <cmath>

namespace bin_scenes::bench {
namespace {

/// Boxes, a long bar, balls and rings in all poses about the point (0, 0, z), some hidden by others.
void add_heap(test::Stage& stage, double z, int parts, std::uint64_t seed) {
  const std::size_t lines[] = {stage.model(test::box_mesh({0.06, 0.04, 0.03})), stage.model(test::sphere_mesh(0.03, 2)),
                               stage.model(test::box_mesh({0.12, 0.01, 0.02}, {0.03, 0.01, 0})),
                               stage.model(test::torus_mesh(0.03, 0.01, 16, 8))};
  Random random(seed, 0, Stream::probe);
  for (int i = 0; i < parts; ++i) {
    const Vec3 where(random.uniform(-0.15, 0.15), random.uniform(-0.12, 0.12), z + random.uniform(-0.08, 0.08));
    stage.place(lines[i % 4], {where, random.orientation()});
  }
}

/// What the reference sees of one pixel.
struct Seen {
  test::BruteHit hit;
  Validity light = Validity::nothing;  ///< nothing, valid, shadow or outside
};

class Reference {
 public:
  Reference(const Lens& lens, double near, double far, const test::BruteCast& cast)
      : width_(lens.width), height_(lens.height), pixels_(static_cast<std::size_t>(lens.width) * lens.height) {
    in_parallel(static_cast<std::size_t>(height_), [&](std::size_t row) {
      for (int x = 0; x < width_; ++x)
        pixels_[row * width_ + x].hit = cast.hit(Vec3::Zero(), lens.ray(x, static_cast<double>(row)), near, far);
    });
  }
  /// Field and shadow of a projector by the tangents of its field of view and one more ray a pixel.
  void light_by(const Sensor& sensor, const Lens& lens, const test::BruteCast& cast) {
    const Projector& projector = sensor.projector;
    const Pose in_projector = projector.pose->inverse();
    const double half_x = std::tan(0.5 * projector.fov), half_y = half_x * projector.height / projector.width;
    in_parallel(static_cast<std::size_t>(height_), [&](std::size_t row) {
      for (int x = 0; x < width_; ++x) {
        Seen& seen = pixels_[row * width_ + x];
        if (std::isnan(seen.hit.distance)) continue;
        const Vec3 point = seen.hit.distance * lens.ray(x, static_cast<double>(row)), at = in_projector * point;
        const bool inside = at.z() > 0.0 && std::abs(at.x()) <= half_x * at.z() && std::abs(at.y()) <= half_y * at.z();
        const bool blocked = !std::isnan(cast.hit(point, projector.pose->position - point, 1e-6, 1.0).distance);
        seen.light = !inside ? Validity::outside : blocked ? Validity::shadow : Validity::valid;
      }
    });
  }
  const Seen& at(std::size_t pixel) const { return pixels_[pixel]; }
  /// Whether a neighbour shows another part, another depth by more than 5 mm, or other light.
  bool near_border(std::size_t pixel) const {
    const int x = static_cast<int>(pixel) % width_, y = static_cast<int>(pixel) / width_;
    if (x == 0 || y == 0 || x + 1 == width_ || y + 1 == height_) return true;
    const Seen& here = pixels_[pixel];
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        const Seen& there = pixels_[static_cast<std::size_t>(v) * width_ + u];
        if (there.hit.label != here.hit.label || there.light != here.light) return true;
        if (std::abs(there.hit.distance - here.hit.distance) > 0.005) return true;
      }
    }
    return false;
  }
  std::size_t size() const { return pixels_.size(); }

 private:
  int width_, height_;
  std::vector<Seen> pixels_;
};

void ideal_depth(Run& out, double z) {
  const Figure depth{"ideal: depth against a double-precision ray cast, largest error", z}, ids{"ideal: wrong ids", z};
  if (!out.wanted(depth.key()) && !out.wanted(ids.key())) return;
  test::Stage stage;
  add_heap(stage, z, out.quick() ? 6 : 20, static_cast<std::uint64_t>(10 * z));
  const Lens lens = Lens::from_fov(out.quick() ? 160 : 400, out.quick() ? 128 : 320, 0.4 / z);
  const View view = render(stage.scenery(), lens, Pose(), 0.05, 10.0);
  const Reference truth(lens, 0.05, 10.0, test::BruteCast(stage));
  double worst = 0.0, wrong = 0.0, compared = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth.near_border(i)) continue;
    ++compared;
    wrong += view.label[i] != truth.at(i).hit.label;
    if (truth.at(i).hit.label)
      worst = std::max(worst, std::abs(static_cast<float>(view.depth[i]) - truth.at(i).hit.distance));
  }
  out.row(row_of(depth, 1e6 * worst, "um", z == 1.0 ? "at most 2" : "").info("samples", compared));
  out.row(row_of(ids, wrong, "pixels", "0").info("samples", compared));
}

void light_codes(Run& out, Fidelity fidelity) {
  const std::string setting = fidelity == Fidelity::decoded ? "decoded" : "analytic";
  Figure figure{"wrong shadow or outside the projector's field"};
  figure.setting = setting;
  if (!out.wanted(figure.key())) return;
  test::Stage stage;
  add_heap(stage, 1.0, out.quick() ? 6 : 20, 3);
  stage.place(stage.model(test::box_mesh({2.0, 2.0, 0.02})), test::at(0, 0, 1.15));
  Sensor sensor = sensor_of("structured_light", 1.0);
  sensor.width = 400, sensor.height = 320;
  sensor.k.clear();
  sensor.projector.fov = 0.35;  // covers a part of the image
  sensor.fidelity = fidelity;
  sensor.noise = false;
  sensor = resolved(sensor, stage.request.bin);
  const Lens lens = lens_of(sensor);
  const Scenery scenery = stage.scenery();
  const RangeImage image =
      measure(scenery, render(scenery, lens, Pose(), sensor.near, sensor.far), sensor, surfaces_of(stage.request), {});
  const test::BruteCast cast(stage);
  Reference truth(lens, sensor.near, sensor.far, cast);
  truth.light_by(sensor, lens, cast);
  double wrong = 0.0, compared = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth.near_border(i)) continue;
    const auto code = static_cast<Validity>(image.validity[i]);
    const bool unlit = code == Validity::nothing || code == Validity::shadow || code == Validity::outside;
    ++compared;
    wrong += (unlit ? code : Validity::valid) != truth.at(i).light;
  }
  out.row(row_of(figure, wrong, "pixels", "0").info("samples", compared));
}

/// A projector at +b sees past the left edge of a block of height h on a plate at z to where the ray of that edge meets
/// the plate; the camera sees the plate from where its own ray of the edge meets it. Between them lies the shadow.
void shadow_width(Run& out, double height) {
  Figure figure{"width of the shadow behind a step against the closed form"};
  figure.setting = "h = " + Row::text(height) + " m";
  if (!out.wanted(figure.key())) return;
  constexpr double z = 1.0, half = 0.02;
  Sensor sensor = sensor_of("structured_light", z);
  sensor.noise = false;
  Targets targets = plate(z, 0.0, 0.5);
  targets.add(box_target({2 * half, 0.5, height}), {Vec3(0, 0, z - 0.5 * height), Quat::Identity()});
  const double end = -half - (half + sensor.projector.pose->position.x()) * height / (z - height);
  const double begin = -half * z / (z - height);
  const Lens lens = lens_of(sensor);
  const double expected = (begin - end) / z * lens.fx - 1.0;  // pixels wholly in it: at each end one is halved
  double worst = 0.0;
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    sensor.fidelity = fidelity;
    const Shot shot = shoot(targets, sensor, 0);
    for (int row = lens.height / 2 - 50; row < lens.height / 2 + 50; ++row) {
      const auto first = shot.measured.validity.begin() + static_cast<std::ptrdiff_t>(row) * lens.width;
      const auto pixels = std::count(first, first + lens.width, Validity::shadow);
      worst = std::max(worst, std::abs(static_cast<double>(pixels) - expected));
    }
  }
  out.row(row_of(figure, worst, "pixels", "at most 1").info("expected", expected));
}

void visible_fraction(Run& out, bool distorted) {
  Figure figure{"visible fraction against a ray cast, largest error", 0.8};
  figure.setting = distorted ? "distorted lens" : "pinhole";
  if (!out.wanted(figure.key())) return;
  const int parts = out.quick() ? 6 : 30;
  test::Stage stage;
  add_heap(stage, 0.8, parts, 7);
  Sensor sensor;
  sensor.width = out.quick() ? 160 : 320;
  sensor.height = out.quick() ? 120 : 240;
  sensor.fov = 0.5;
  sensor.pose = Pose();
  if (distorted) sensor.distortion = {-0.25, 0.1, 0.002, -0.001, 0.0};
  stage.scene.sensors = {resolved(sensor, stage.request.bin)};
  SensorRig().render(stage.scene, {stage.request, stage.models});
  const Lens lens = lens_of(stage.scene.sensors[0]);
  const test::BruteCast cast(stage);
  const Reference all(lens, 0.05, 10.0, cast);
  std::vector<double> errors(static_cast<std::size_t>(parts));
  in_parallel(errors.size(), [&](std::size_t id) {
    const int label = static_cast<int>(id) + 1;
    double seen = 0.0, alone = 0.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto width = static_cast<std::size_t>(lens.width);
      const Vec3 ray = lens.ray(static_cast<double>(i % width), static_cast<double>(i / width));
      if (std::isnan(cast.hit(Vec3::Zero(), ray, 0.05, 10.0, label).distance)) continue;
      ++alone;
      seen += all.at(i).hit.label == label;
    }
    const double truth = alone > 0.0 ? seen / alone : 0.0;
    errors[id] = std::abs(stage.scene.parts[id].visible_fraction.at(sensor.name) - truth);
  });
  out.row(row_of(figure, *std::max_element(errors.begin(), errors.end()), "", "at most 0.005"));
}

}  // namespace

void truth_rows(Run& out) {
  for (const double z : {0.5, 1.0, 2.0}) ideal_depth(out, z);
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) light_codes(out, fidelity);
  for (const double height : {0.02, 0.05, 0.1}) shadow_width(out, height);
  for (const bool distorted : {false, true}) visible_fraction(out, distorted);
}

}  // namespace bin_scenes::bench
