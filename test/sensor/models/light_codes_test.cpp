/// Shadows of a projector and the border of its field, pixel by pixel, against rays in double precision.
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "raster/stage.hpp"
#include "sensor/models/of_sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace bin_scenes {
namespace {

using test::BruteCast;
using test::Stage;

/// Boxes, a long bar, balls and rings in all poses above a plate.
void scatter(Stage& stage, int parts) {
  const std::size_t lines[] = {stage.model(test::box_mesh({0.06, 0.04, 0.03})), stage.model(test::sphere_mesh(0.03, 2)),
                               stage.model(test::box_mesh({0.12, 0.01, 0.02}, {0.03, 0.01, 0})),
                               stage.model(test::torus_mesh(0.03, 0.01, 16, 8))};
  Random random(3, 0, Stream::probe);
  for (int i = 0; i < parts; ++i)
    stage.place(lines[i % 4],
                {Vec3(random.uniform(-0.15, 0.15), random.uniform(-0.12, 0.12), random.uniform(0.92, 1.08)),
                 random.orientation()});
  stage.place(stage.model(test::box_mesh({2.0, 2.0, 0.02})), test::at(0, 0, 1.15));
}

/// Its projector covers a part of the image.
Sensor sensor_of(Fidelity fidelity, const Bin& bin) {
  Sensor sensor;
  sensor.model = "structured_light";
  sensor.fidelity = fidelity;
  sensor.width = 200, sensor.height = 160;
  sensor.fov = 0.4;
  sensor.near = 0.5, sensor.far = 2.0;  // without a bin, light is aimed at sqrt(near far)
  sensor.pose = Pose();
  sensor.bounces = 0;
  sensor.noise = false;
  sensor.projector.fov = 0.35;
  return resolved(sensor, bin);
}

/// What a pixel should say: nothing, valid, shadow or outside.
struct Seen {
  test::BruteHit hit;
  Validity light = Validity::nothing;
};

Seen seen_by(const BruteCast& cast, const Sensor& sensor, const Vec3& ray) {
  Seen seen{cast.hit(Vec3::Zero(), ray, sensor.near, sensor.far)};
  if (std::isnan(seen.hit.distance)) return seen;
  const Projector& projector = sensor.projector;
  const Vec3 point = seen.hit.distance * ray, at = projector.pose->inverse() * point;
  const double half_x = std::tan(0.5 * projector.fov), half_y = half_x * projector.height / projector.width;
  const bool inside = at.z() > 0.0 && std::abs(at.x()) <= half_x * at.z() && std::abs(at.y()) <= half_y * at.z();
  const bool blocked = !std::isnan(cast.hit(point, projector.pose->position - point, 1e-6, 1.0).distance);
  seen.light = !inside ? Validity::outside : blocked ? Validity::shadow : Validity::valid;
  return seen;
}

TEST(LightCodes, AreThoseOfARayCast) {
  Stage stage;
  scatter(stage, 16);
  const BruteCast cast(stage);
  const Scenery scenery = stage.scenery();
  for (const Fidelity fidelity : {Fidelity::analytic, Fidelity::decoded}) {
    const Sensor sensor = sensor_of(fidelity, stage.request.bin);
    const Lens lens = lens_of(sensor);
    const RangeImage image = measure(scenery, render(scenery, lens, Pose(), sensor.near, sensor.far), sensor,
                                     surfaces_of(stage.request), {});
    std::vector<Seen> truth;
    for (int y = 0; y < lens.height; ++y)
      for (int x = 0; x < lens.width; ++x) truth.push_back(seen_by(cast, sensor, lens.ray(x, y)));
    // Beside a border of parts, of depths by more than 5 mm, or of light the two may round to different sides.
    const auto near_border = [&](int x, int y) {
      const Seen& here = truth[static_cast<std::size_t>(y * lens.width + x)];
      for (int v = y - 1; v <= y + 1; ++v)
        for (int u = x - 1; u <= x + 1; ++u) {
          const Seen& there = truth[static_cast<std::size_t>(v * lens.width + u)];
          if (there.hit.label != here.hit.label || there.light != here.light) return true;
          if (std::abs(there.hit.distance - here.hit.distance) > 0.005) return true;
        }
      return false;
    };
    std::size_t wrong = 0, compared = 0, shadows = 0, outside = 0;
    for (int y = 1; y + 1 < lens.height; ++y)
      for (int x = 1; x + 1 < lens.width; ++x) {
        if (near_border(x, y)) continue;
        const auto i = static_cast<std::size_t>(y * lens.width + x);
        const auto code = static_cast<Validity>(image.validity[i]);
        const bool unlit = code == Validity::nothing || code == Validity::shadow || code == Validity::outside;
        wrong += (unlit ? code : Validity::valid) != truth[i].light;
        shadows += truth[i].light == Validity::shadow;
        outside += truth[i].light == Validity::outside;
        ++compared;
      }
    EXPECT_EQ(wrong, 0u) << static_cast<int>(fidelity);
    EXPECT_GT(compared, truth.size() / 2);
    EXPECT_GT(shadows, 1000u);
    EXPECT_GT(outside, 1000u);
  }
}

}  // namespace
}  // namespace bin_scenes
