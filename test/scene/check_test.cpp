#include "bin_scenes/core/error.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace bin_scenes {
namespace {

Request good() {
  Request request;
  request.parts.emplace_back();
  request.parts[0].model = "bolt.stl";
  request.parts[0].count = 2;
  request.sensors.emplace_back();
  return request;
}

/// The key check() refuses after `spoil`; "" if it accepts.
template <class Spoil>
std::string refused(Spoil spoil) {
  Request request = good();
  spoil(request);
  try {
    check(request);
    check_sensors(request.sensors);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.remedy().empty());
    return error.where();
  }
  return "";
}

const double na_n = std::numeric_limits<double>::quiet_NaN();
const double inf = std::numeric_limits<double>::infinity();

TEST(Check, AcceptsDefaultsAndTheEdgesOfWhatMakesSense) {
  EXPECT_EQ(refused([](Request&) {}), "");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].friction = 0.0; }), "");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].restitution = 1.0; }), "");
  EXPECT_EQ(refused([](Request& r) { r.gravity.setZero(); }), "");
  EXPECT_EQ(refused([](Request& r) {
              r.bin.kind = Bin::Kind::none;
              r.bin.inner_size.setZero();
            }),
            "");
}

TEST(Check, RefusesEachAbsurdValueByItsKey) {
  EXPECT_EQ(refused([](Request& r) { r.parts.clear(); }), "parts");
  EXPECT_EQ(refused([](Request& r) { r.scenes = 0; }), "scenes");
  EXPECT_EQ(refused([](Request& r) { r.bin.inner_size.y() = 0.0; }), "bin.inner_size");
  EXPECT_EQ(refused([](Request& r) { r.bin.inner_size.z() = na_n; }), "bin.inner_size");
  EXPECT_EQ(refused([](Request& r) { r.bin.friction = -0.1; }), "bin.friction");
  EXPECT_EQ(refused([](Request& r) { r.bin.restitution = 1.1; }), "bin.restitution");
  EXPECT_EQ(refused([](Request& r) { r.bin.kind = Bin::Kind::mesh; }), "bin.mesh");
  EXPECT_EQ(refused([](Request& r) { r.gravity.x() = inf; }), "gravity");
  EXPECT_EQ(refused([](Request& r) { r.gravity.x() = 1e5; }), "gravity");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].count = 0; }), "parts[0].count");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].count = std::size_t(-3); }), "parts[0].count");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].count = 70000; }), "parts") << "16-bit labels";
  EXPECT_EQ(refused([](Request& r) { r.parts[0].scale = 0.0; }), "parts[0].scale");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].density = -1.0; }), "parts[0].density");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].mass = 0.0; }), "parts[0].mass");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].density = r.parts[0].mass = 1.0; }), "parts[0].mass");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].friction = na_n; }), "parts[0].friction");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].restitution = 1.5; }), "parts[0].restitution");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].thickness = 0.0; }), "parts[0].thickness");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].fixed = true; }), "parts[0].poses");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].poses.resize(2); }), "parts[0].poses") << "rain would not use them";
  EXPECT_EQ(refused([](Request& r) { r.pour.pattern = Pour::Pattern::given; }), "parts[0].poses");
  const auto given = [](auto change) {
    return [change](Request& r) {
      r.pour.pattern = Pour::Pattern::given;
      r.parts[0].poses.resize(2);
      change(r.parts[0]);
    };
  };
  EXPECT_EQ(refused(given([](PartLine&) {})), "");
  EXPECT_EQ(refused(given([](PartLine& p) { p.poses.resize(3); })), "parts[0].poses");
  EXPECT_EQ(refused(given([](PartLine& p) { p.poses[1].position.x() = na_n; })), "parts[0].poses[1]");
  EXPECT_EQ(refused(given([](PartLine& p) { p.poses[1].orientation.coeffs().setZero(); })), "parts[0].poses[1]");
  EXPECT_EQ(refused(given([](PartLine& p) { p.velocities.resize(1); })), "parts[0].velocities");
  EXPECT_EQ(refused(given([](PartLine& p) {
              p.velocities.resize(2);
              p.velocities[0].angular.x() = inf;
            })),
            "parts[0].velocities[0]");
  EXPECT_EQ(refused([](Request& r) { r.pour.drop_height = -1; }), "pour.drop_height");
  EXPECT_EQ(refused([](Request& r) { r.pour.grid_spacing = 0.5; }), "pour.grid_spacing");
  EXPECT_EQ(refused([](Request& r) { r.pour.limit = 0; }), "pour.limit");
  EXPECT_EQ(refused([](Request& r) { r.pour.rest_window = 30; }), "pour.rest_window");
  EXPECT_EQ(refused([](Request& r) { r.pour.rest_move = 0; }), "pour.rest_move");
  EXPECT_EQ(refused([](Request& r) { r.pour.rest_turn = -1; }), "pour.rest_turn");
  EXPECT_EQ(refused([](Request& r) { r.solver.bullet.time_step = 0; }), "solver.bullet.time_step");
  EXPECT_EQ(refused([](Request& r) { r.solver.bullet.iterations = 0; }), "solver.bullet.iterations");
  EXPECT_EQ(refused([](Request& r) { r.solver.thesis.bias = 2; }), "solver.thesis.bias");
  EXPECT_EQ(refused([](Request& r) { r.solver.thesis.cell_size = 0.5; }), "solver.thesis.cell_size");
  EXPECT_EQ(refused([](Request& r) { r.solver.sphere.sub_steps = -4; }), "solver.sphere.sub_steps");
  EXPECT_EQ(refused([](Request& r) { r.solver.sphere.field_cell = 0; }), "solver.sphere.field_cell");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].name = "../evil"; }), "sensors[0].name");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].name = ""; }), "sensors[0].name");
  EXPECT_EQ(refused([](Request& r) { r.sensors.emplace_back(); }), "sensors[1].name");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].width = 0; }), "sensors[0].width");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].height = 100000; }), "sensors[0].height");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].fov = 3.2; }), "sensors[0].fov");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].k = {1, 2, 3}; }), "sensors[0].k");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].k = {0, 0, 1, 0, 1, 1, 0, 0, 1}; }), "sensors[0].k");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].far = 0.01; }), "sensors[0].far");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].imager.read_noise = -1; }), "sensors[0].imager.read_noise");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].imager.bits = 17; }), "sensors[0].imager.bits");
  EXPECT_EQ(refused([](Request& r) {
              r.sensors[0].model = "structured_light";
              r.sensors[0].bounces = 3;
            }),
            "sensors[0].bounces");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].imager.exposures = {0.8, 0.2}; }), "sensors[0].imager.exposures");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].imager.exposures = {0.0, 0.2}; }), "sensors[0].imager.exposures[0]");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].bounces = 1; }), "sensors[0].bounces");  // ideal
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].indirect_samples = 0; }), "sensors[0].indirect_samples");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<StructuredLightSettings>().steps = 2; }),
            "sensors[0].structured_light.steps");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<LaserLineSettings>().speckle = na_n; }),
            "sensors[0].laser_line.speckle");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<StereoSettings>().baseline = 0; }),
            "sensors[0].stereo.baseline");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<StereoSettings>().disparities = 100; }),
            "sensors[0].stereo.disparities");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<StereoSettings>().disparities = 2048; }),
            "sensors[0].stereo.disparities");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<StereoSettings>().window = 8; }),
            "sensors[0].stereo.window");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].settings.of<TimeOfFlightSettings>().axial = -0.1; }),
            "sensors[0].time_of_flight.axial");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].distortion[2] = NAN; }), "sensors[0].distortion");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].projector.baseline = 0.0; }), "sensors[0].projector.baseline");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].projector.fov = -1.0; }), "sensors[0].projector.fov");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].projector.width = 0; }), "sensors[0].projector.width");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].laser.baseline = 0.0; }), "sensors[0].laser.baseline");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].laser.width_mm = 0.0; }), "sensors[0].laser.width_mm");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].scan.direction = Vec3::Zero(); }), "sensors[0].scan.direction");
  EXPECT_EQ(refused([](Request& r) { r.sensors[0].scan.step = -0.1; }), "sensors[0].scan.step");
  EXPECT_EQ(refused([](Request& r) { r.parts[0].surface.albedo = 1.5; }), "parts[0].surface.albedo");
  EXPECT_EQ(refused([](Request& r) { r.bin.surface.gloss = -0.1; }), "bin.surface.gloss");
  EXPECT_EQ(refused([](Request& r) { r.accept.penetration = -1; }), "accept.penetration");
  EXPECT_EQ(refused([](Request& r) { r.accept.gap = std::nan(""); }), "accept.gap");
  EXPECT_EQ(refused([](Request& r) { r.solver.bullet.hull_volume_error = 0; }), "solver.bullet.hull_volume_error");
  EXPECT_EQ(refused([](Request& r) { r.seconds = 0.0; }), "seconds");
  EXPECT_EQ(refused([](Request& r) { r.memory_budget = 0.0; }), "memory_budget");
}

TEST(Check, PatternsMustTellAllOfTheProjectorsColumnsApart) {
  const auto with = [](int bits, const std::string& model) {
    return refused([&](Request& r) {
      r.sensors[0].model = model;
      r.sensors[0].projector.width = 1280;  // 80 fringes of 16 columns
      r.sensors[0].settings.of<StructuredLightSettings>().gray_bits = bits;
    });
  };
  EXPECT_EQ(with(8, "structured_light"), "");
  EXPECT_EQ(with(7, "structured_light"), "sensors[0].structured_light.gray_bits");
  EXPECT_EQ(with(7, "ideal"), "");
}

TEST(Check, AStereoCameraIsRectified) {
  EXPECT_EQ(refused([](Request& r) {
              r.sensors[0].model = "stereo";
              r.sensors[0].distortion[0] = 0.1;
            }),
            "sensors[0].distortion");
}

}  // namespace
}  // namespace bin_scenes
