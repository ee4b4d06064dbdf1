#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "sensor/groove_device.hpp"
#include "sensor/shot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace bin_scenes {
namespace {

constexpr double step = 3e-4;  // m

StructuredLight::Setup device(double period, double largest) {
  StructuredLight::Setup setup = test::groove_device(period, 1);
  setup.reflection.step = largest;
  return setup;
}

Targets plate(double albedo = 0.9) {
  Targets targets;
  targets.add(box_target({8.0, 8.0, 0.02}), {Vec3(0, 0, 0.76), Quat::Identity()}, {albedo, 0.0, 0.4});
  return targets;
}

/// Shares of the pixels valid without the filter that it takes: of those that err by more than the step, of the others.
/// What it leaves has the bits that it had.
struct Taken {
  double wrong = 0.0, right = 0.0;
};
Taken taken(Targets targets, double period, bool decoded) {
  const auto off = test::shoot<StructuredLight>(targets, test::groove_camera(), device(period, 0.0), decoded);
  const auto on = test::shoot<StructuredLight>(targets, test::groove_camera(), device(period, step), decoded);
  double wrong = 0.0, right = 0.0;
  Taken out;
  for (std::size_t i = 0; i < off.view.depth.size(); ++i) {
    if (off.measured.validity[i] != Validity::valid) {
      EXPECT_EQ(on.measured.validity[i], off.measured.validity[i]) << i;
      continue;
    }
    const bool errs = std::abs(off.measured.depth[i] - off.view.depth[i]) > step;
    const bool gone = on.measured.validity[i] != Validity::valid;
    (errs ? wrong : right) += 1.0;
    (errs ? out.wrong : out.right) += gone;
    if (gone) {
      EXPECT_EQ(on.measured.validity[i], Validity::reflection) << i;
      EXPECT_TRUE(std::isnan(on.measured.depth[i])) << i;
    } else {
      EXPECT_EQ(on.measured.depth[i], off.measured.depth[i]) << i;
    }
  }
  out.wrong /= std::max(1.0, wrong);
  out.right /= std::max(1.0, right);
  return out;
}

TEST(Reflection, AGrooveLosesWhatErrs) {
  const struct {
    Surface surface;
    double period;
  } grooves[] = {{{0.9, 0.0, 0.4}, 16.0},
                 {{0.45, 0.0, 0.4}, 16.0},
                 {{0.9, 0.0, 0.4}, 64.0},
                 {{0.8, 0.7, 0.4}, 16.0},
                 {{0.8, 0.9, 0.3}, 16.0}};
  for (const bool decoded : {false, true}) {
    for (const auto& [surface, period] : grooves) {
      const Taken share = taken(test::groove(surface, 0.75, 0.057, 0.3), period, decoded);
      EXPECT_GT(share.wrong, 0.82) << decoded << ' ' << surface.albedo << ' ' << surface.gloss << ' ' << period;
      EXPECT_LT(share.right, 0.06) << decoded << ' ' << surface.albedo << ' ' << surface.gloss << ' ' << period;
    }
  }
}

TEST(Reflection, AFlatPlateStays) {
  for (const bool decoded : {false, true})
    for (const double albedo : {0.9, 0.45})
      EXPECT_LT(taken(plate(albedo), 16.0, decoded).right, 0.005) << decoded << ' ' << albedo;
}

TEST(Reflection, NoiseOfBothFringesCounts) {
  // Of the difference of two normally distributed numbers 31.7 % lie beyond one sigma.
  Targets targets = plate();
  const Scenery scenery = targets.scenery();
  const View view = render(scenery, test::groove_camera(), Pose(), 0.3, 1.3);
  const auto sigma = [&](double period) {
    return StructuredLight(scenery, view, targets.surfaces(), device(period, 0.0)).depth_sigma(20 * 202 + 101);
  };
  const double both = std::hypot(sigma(16.0), sigma(ReflectionFilter().period));
  ASSERT_GT(both, 1.05 * sigma(16.0));
  for (const bool decoded : {false, true}) {
    const auto shot = test::shoot<StructuredLight>(targets, test::groove_camera(), device(16.0, both), decoded);
    double gone = 0.0;
    for (const Validity code : shot.measured.validity) gone += code == Validity::reflection;
    // Four standard deviations of the share.
    EXPECT_NEAR(gone / static_cast<double>(view.depth.size()), std::erfc(M_SQRT1_2), 0.021) << decoded;
  }
}

TEST(Reflection, WithoutNoiseAPlateLosesNothing) {
  // At the border of the plate, too, and where it is steep.
  for (const double tilt : {0.0, 1.0}) {
    Targets targets;
    targets.add(box_target({0.06, 0.012, 0.02}), {Vec3(0, 0, 0.76), Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()))},
                {0.9, 0.0, 0.4});
    StructuredLight::Setup setup = device(16.0, 5e-5);
    setup.noise = false;
    const auto shot = test::shoot<StructuredLight>(targets, test::groove_camera(), setup, false);
    int valid = 0, gone = 0;
    for (const Validity code : shot.measured.validity) {
      valid += code == Validity::valid;
      gone += code == Validity::reflection;
    }
    EXPECT_GT(valid, 500) << tilt;
    EXPECT_EQ(gone, 0) << tilt;
  }
}

TEST(Reflection, MistakesAreTold) {
  const auto error = [](const ReflectionFilter& filter, const char* model = "structured_light",
                        double defocus = 0.7) -> std::string {
    Sensor sensor;
    sensor.model = model;
    sensor.settings.of<FilterSettings>().reflection = filter;
    sensor.settings.of<StructuredLightSettings>().defocus = defocus;
    try {
      check_sensors({sensor});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error({step, 5.0}), "");
  EXPECT_EQ(error({0.0, 16.0}, "stereo"), "") << "off";
  for (const char* model : {"ideal", "laser_line", "stereo", "time_of_flight", "image"}) {
    const std::string text = error({step, 5.0}, model);
    EXPECT_NE(text.find("sensors[0].filter.reflection"), std::string::npos) << model;
    EXPECT_NE(text.find(model), std::string::npos);
  }
  EXPECT_NE(error({step, 15.0}).find("sensors[0].filter.reflection.period"), std::string::npos);
  EXPECT_NE(error({step, 5.0}, "structured_light", 3.0).find("sensors[0].filter.reflection.period"), std::string::npos);
  EXPECT_NE(error({-step, 5.0}).find("sensors[0].filter.reflection.step"), std::string::npos);
  EXPECT_NE(error({step, 2.0}).find("sensors[0].filter.reflection.period"), std::string::npos);
}

}  // namespace
}  // namespace bin_scenes
