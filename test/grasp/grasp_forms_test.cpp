/// The table of grasps beside closed forms in docs/lab/accuracy.md.
#include "part/closed_forms.hpp"
#include "quality/pieces.hpp"
#include "single_part.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <optional>

namespace bin_scenes {
namespace {

using test::approach, test::closing, test::cup, test::grasps_of, test::mean_distance, test::two_fingers;

struct Form {
  const char *part, *quantity;
  double found, expected;  ///< mm, or a coefficient
  double tolerance;
};

/// Mean of a figure of those grasps that have it, mm; NaN without any.
template <class Figure>
double mean_mm(const PartGrasps& found, const Figure& figure) {
  double sum = 0.0, count = 0.0;
  for (const Grasp& grasp : found.grasps)
    if (const std::optional<double> value = figure(grasp)) {
      sum += 1e3 * *value;
      ++count;
    }
  return sum / count;
}

std::vector<Form> forms_of_fingers() {
  using Figure = std::optional<double>;
  const PartGrasps cube = grasps_of(test::box_mesh({0.04, 0.04, 0.04}), two_fingers());
  const PartGrasps cylinder = grasps_of(test::prism_mesh(0.012, 0.03, 64), two_fingers());
  const PartGrasps sphere = grasps_of(test::sphere_mesh(0.02, 5), two_fingers());
  const PartGrasps ring = grasps_of(test::ring(0.03, 0.022, 0.01, 48).mesh, two_fingers());
  const PartGrasps plate = grasps_of(test::box_mesh({0.16, 0.12, 0.002}), two_fingers());
  const auto body = test::prism(
      {{-0.012, 0}, {0.012, 0}, {0.012 - 0.03 * std::tan(0.15), 0.03}, {-0.012 + 0.03 * std::tan(0.15), 0.03}},
      {{0, 1, 2, 3}}, 0.07);
  const PartGrasps wedge = grasps_of(body.mesh, two_fingers());
  const auto width = [](const Grasp& g) { return Figure(g.width); };
  const auto whole_pad = [](const Grasp& g) { return g.share > 1.0 - 1e-9 ? Figure(g.radius) : std::nullopt; };
  const auto along = [](const Grasp& g) {
    return std::abs(closing(g.pose).z()) > 0.5 ? Figure(g.width) : std::nullopt;
  };
  const auto across = [](const Grasp& g) {
    const bool level = std::abs((g.pose.orientation * Vec3::UnitY()).z()) < 0.01 && std::abs(closing(g.pose).z()) < 0.5;
    return level && std::abs(g.pose.position.z()) < 0.01 ? Figure(0.012 * g.share) : std::nullopt;
  };
  const auto centred = [](const Grasp& g) { return g.lever < 1e-4 ? Figure(g.radius) : std::nullopt; };
  const auto leaning = [](const Grasp& g) {
    return std::abs(closing(g.pose).x()) > 0.9 ? Figure(1e-3 * g.friction) : std::nullopt;
  };
  return {{"cube, 40 mm", "width = edge", mean_mm(cube, width), 40.0, 1e-6},
          {"cube, 40 mm", "moment arm = mean distance in the pad", mean_mm(cube, whole_pad),
           1e3 * mean_distance(0.012, 0.010), 1e-6},
          {"cylinder, R = 12 mm", "width along it = height, 30", mean_mm(cylinder, along), 30.0, 1e-6},
          {"the same", "contact across = 2 sqrt(2 g R)", mean_mm(cylinder, across), 2e3 * std::sqrt(2.0 * 2e-4 * 0.012),
           0.05},
          {"sphere, R = 20 mm", "width = 2 R", mean_mm(sphere, width), 40.0, 0.05},
          {"sphere, R = 20 mm", "moment arm = 2/3 sqrt(2 g R)", mean_mm(sphere, centred),
           2e3 / 3.0 * std::sqrt(2.0 * 2e-4 * 0.02), 0.08},
          {"wedge, sides lean by 0.15 rad", "least friction = tan 0.15", mean_mm(wedge, leaning), std::tan(0.15), 1e-9},
          {"ring, 10 mm high", "width = height", mean_mm(ring, along), 10.0, 1e-6},
          {"plate, 2 mm", "width = thickness", mean_mm(plate, width), 2.0, 1e-6}};
}

std::vector<Form> forms_of_cups() {
  using Figure = std::optional<double>;
  Gripper soft = cup();
  soft.lip = 0.004;
  const PartGrasps cylinder = grasps_of(test::prism_mesh(0.02, 0.06, 128), soft);
  const PartGrasps sphere = grasps_of(test::sphere_mesh(0.02, 5), cup());
  const double deep = std::sqrt(0.02 * 0.02 - 0.01 * 0.01);
  const auto on_side = [](const Grasp& g) {
    return std::abs(approach(g.pose).z()) < 0.5 ? Figure(g.gap) : std::nullopt;
  };
  const auto distance = [](const Grasp& g) { return Figure(g.pose.position.norm()); };
  return {{"cup, r = 10 mm, on cylinder, 20 mm", "gap = R - sqrt(R^2 - r^2)", mean_mm(cylinder, on_side),
           1e3 * (0.02 - deep), 0.005},
          {"the same on a sphere", "ring to centre = sqrt(R^2 - r^2)", mean_mm(sphere, distance), 1e3 * deep, 0.03}};
}

TEST(ClosedForms, AreFound) {
  std::vector<Form> forms = forms_of_fingers();
  for (const Form& form : forms_of_cups()) forms.push_back(form);
  for (const Form& form : forms) {
    std::printf("| %s | %s | %.4g | %.4g |\n", form.part, form.quantity, form.found, form.expected);
    EXPECT_NEAR(form.found, form.expected, form.tolerance) << form.part << ": " << form.quantity;
  }
}

}  // namespace
}  // namespace bin_scenes
