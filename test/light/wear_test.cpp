#include "light/wear.hpp"

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/light/surfaces.hpp"
#include "light/illumination.hpp"
#include "raster/stage.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

Surface even() {
  Surface surface{0.9, 0.8, 0.3};
  surface.colour = Vec3(1.0, 0.9, 0.8);
  return surface;
}

/// Mean over parts and points of a plane through them.
template <class Value>
double mean_of(const Texture& texture, const Value& value) {
  Surface surface = even();
  surface.texture = texture;
  constexpr int parts = 3000, points = 8;
  double sum = 0.0;
  Random draw(1, 2, Stream::noise);
  for (std::uint64_t part = 0; part < parts; ++part)
    for (int i = 0; i < points; ++i)
      sum += value(worn(surface, Vec3(draw.uniform(-0.02, 0.02), draw.uniform(-0.02, 0.02), 0.01), part));
  return sum / (parts * points);
}

/// Albedo as told: of each wear the share times its factor; the three know nothing of each other.
TEST(Wear, MeanAlbedoIsThatOfTheShares) {
  const auto albedo = [](const Surface& s) { return s.albedo; };
  const auto expect = [&](const Texture& t, double told) {
    // Four standard errors: shares of parts differ by 0.58 of the mean, and so few points of one are not independent.
    EXPECT_NEAR(mean_of(t, albedo), told, 0.015) << t.scratches << " " << t.oil << " " << t.rust;
  };
  EXPECT_NEAR(mean_of({}, albedo), 0.9, 1e-9);
  expect({0.3, 0.0, 0.0}, 0.9 * (1.0 - 0.3 * 0.2));
  expect({0.0, 0.5, 0.0}, 0.9 * (1.0 - 0.5 * 0.15));
  expect({0.0, 0.0, 0.4}, 0.9 * (1.0 - 0.4 * 0.6));
  expect({0.2, 0.3, 0.4}, 0.9 * (1.0 - 0.2 * 0.2) * (1.0 - 0.3 * 0.15) * (1.0 - 0.4 * 0.6));
  EXPECT_NEAR(mean_of({0.0, 0.0, 1.0}, albedo), 0.9 * 0.4, 1e-9) << "all of it";
  // The share itself, without factors that hide it.
  EXPECT_NEAR(mean_of({0.3, 0.0, 0.0}, [](const Surface& s) { return s.roughness > 0.31 ? 1.0 : 0.0; }), 0.3, 0.025);
  EXPECT_NEAR(mean_of({0.0, 0.3, 0.0}, [](const Surface& s) { return s.roughness < 0.29 ? 1.0 : 0.0; }), 0.3, 0.025);
  EXPECT_NEAR(mean_of({0.0, 0.0, 0.3}, [](const Surface& s) { return s.gloss < 0.79 ? 1.0 : 0.0; }), 0.3, 0.025);
}

TEST(Wear, SendsBackNoMoreThanBefore) {
  Surface surface = even();
  surface.refraction = 2.9114, surface.extinction = 3.0893;
  const auto share = [](const Surface& s, double incidence) {
    constexpr int rings = 200, sectors = 200;
    const Vec3 to_light(std::sin(incidence), 0.0, std::cos(incidence));
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
      const double t = (i + 0.5) / rings * 0.5 * M_PI;
      for (int k = 0; k < sectors; ++k) {
        const double p = (k + 0.5) / sectors * M_PI;
        const Vec3 to_eye(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
        sum += reflected(s, Vec3::UnitZ(), to_light, to_eye) * std::cos(t) * std::sin(t);
      }
    }
    return 2.0 * sum * (0.5 * M_PI / rings) * (M_PI / sectors) / (M_PI * std::cos(incidence));
  };
  for (const Texture& texture :
       {Texture{1.0, 0.0, 0.0}, Texture{0.0, 1.0, 0.0}, Texture{0.0, 0.0, 1.0}, Texture{1.0, 1.0, 1.0}}) {
    surface.texture = texture;
    const Surface all = worn(surface, Vec3::Zero(), 1);
    EXPECT_LT(all.albedo, surface.albedo);
    EXPECT_TRUE((all.colour.array() <= surface.colour.array()).all());
    for (const double degrees : {0.0, 45.0, 80.0})
      EXPECT_LT(share(all, degrees * M_PI / 180.0), share(surface, degrees * M_PI / 180.0)) << degrees;
  }
}

/// Two plates of one model: the texture goes with the part, differs between parts and scenes, and not between sensors.
TEST(Wear, GoesWithThePartAndDiffersBetweenParts) {
  test::Stage stage;
  const std::size_t line = stage.model(test::box_mesh({0.2, 0.1, 0.01}));
  stage.request.parts[line].surface = even();
  stage.request.parts[line].surface.texture.rust = 0.5;
  const Quat turn = test::turned(0.8, Vec3(1, 2, 3));
  stage.place(line, test::at(0, 0, 1));
  stage.place(line, test::at(0.3, 0.2, 0.8, turn));
  const auto of = [&](const Surfaces& surfaces, std::uint16_t label, const Vec3& local) {
    Surface own;
    return surfaces.at(0, label, stage.scene.parts[label - 1u].pose * local, own).albedo;
  };
  const Surfaces before = surfaces_of(stage.scene, {stage.request, stage.models});
  stage.scene.parts[0].pose = test::at(-0.1, 0.3, 0.7, turn);
  const Surfaces moved = surfaces_of(stage.scene, {stage.request, stage.models});
  stage.scene.index = 1;
  const Surfaces other = surfaces_of(stage.scene, {stage.request, stage.models});
  int went_along = 0, as_neighbour = 0, as_scene = 0, count = 0;
  for (double x = -0.0951; x < 0.1; x += 0.004) {
    for (double y = -0.0453; y < 0.05; y += 0.004, ++count) {
      const Vec3 local(x, y, 0.005);
      const double here = of(moved, 1, local);
      as_scene += here == of(other, 1, local);
      as_neighbour += here == of(moved, 2, local);
      stage.scene.parts[0].pose = test::at(0, 0, 1);
      went_along += here == of(before, 1, local);
      stage.scene.parts[0].pose = test::at(-0.1, 0.3, 0.7, turn);
    }
  }
  EXPECT_GE(went_along, count - 2);  // a border may round to the other side
  EXPECT_LT(as_neighbour, count * 9 / 10);
  EXPECT_LT(as_scene, count * 9 / 10);
}

TEST(Wear, LinesRunAlongTheLongestAxisOrAsGiven) {
  test::Stage stage;
  const std::size_t line = stage.model(test::box_mesh({0.02, 0.1, 0.01}));
  Surface& surface = stage.request.parts[line].surface;
  surface = even();
  const Quat turn = test::turned(0.8, Vec3(1, 2, 3));
  stage.place(line, test::at(0, 0, 1, turn));
  Surface own;
  const auto along = [&] {
    return surfaces_of(stage.scene, {stage.request, stage.models}).at(0, 1, Vec3(0, 0, 1), own).along;
  };
  EXPECT_EQ(along(), Vec3::Zero()) << "no lines";
  surface.anisotropy = 0.5;
  EXPECT_NEAR(std::abs(along().dot(turn * Vec3::UnitY())), 1.0, 1e-9);
  surface.along = Vec3(2, 0, 0);
  EXPECT_LT((along() - turn * Vec3(2, 0, 0)).norm(), 1e-12);
}

}  // namespace
}  // namespace bin_scenes
