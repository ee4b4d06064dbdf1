#include "bin_scenes/sensor/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bin_scenes {
namespace {

Sensor small(const std::string& model) {
  Sensor sensor;
  sensor.model = model;
  sensor.width = 200;
  sensor.height = 160;
  sensor.fov = 0.4;
  sensor.near = 0.7;
  sensor.far = 1.43;
  sensor.scan.step = 0.004;
  sensor.scan.profiles = 100;
  return sensor;
}

TEST(SensorMetrics, OfAnIdealSensorAreThoseOfTheTargets) {
  const SensorMetrics m = measure_sensor(small("ideal"));
  EXPECT_NEAR(m.distances[1], 1.0, 1e-3);
  for (int i = 0; i < 7; ++i) {
    EXPECT_LT(m.probing_form[i], 1e-3 * m.ball_radius) << i;  // the ball's facets
    EXPECT_LT(std::abs(m.probing_size[i]), 1e-3 * m.ball_radius) << i;
    EXPECT_LT(m.flatness[i], 1e-6) << i;
  }
  EXPECT_LT(m.sphere_spacing, 1e-5);
  EXPECT_LT(m.temporal_noise, 1e-7);
  for (const PredictedSigma& p : m.predicted) EXPECT_EQ(p.sigma, 0.0);
}

TEST(SensorMetrics, FlatnessIsThatOfThePlatesFace) {
  // A scan that passes a tilted plate's sides too. Without noise its face is flat but for the converter's steps.
  Sensor laser = small("laser_line");
  laser.noise = false;
  laser.fov = 0.825;
  laser.near = 0.35;
  laser.far = 0.72;
  laser.laser.baseline = 0.25;
  laser.scan.step = 0.005;
  const SensorMetrics m = measure_sensor(laser);
  for (int i = 0; i < 7; ++i) EXPECT_LT(m.flatness[i], 1e-5) << i;
}

/// Each ball is measured alone: what it sends to another one would be measured as an error of the sensor.
TEST(SensorMetrics, BallsDoNotLightEachOther) {
  for (const char* model : {"structured_light", "time_of_flight"}) {
    Sensor sensor = small(model);
    sensor.bounces = 0;
    const SensorMetrics once = measure_sensor(sensor);
    sensor.bounces = 1;
    const SensorMetrics twice = measure_sensor(sensor);
    EXPECT_EQ(once.probing_form, twice.probing_form) << model;
    EXPECT_EQ(once.sphere_spacing, twice.sphere_spacing) << model;
  }
}

/// Predicted for the middle distance, facing.
double predicted(const SensorMetrics& m, double albedo) {
  for (const PredictedSigma& p : m.predicted) {
    if (p.distance == m.distances[1] && p.incidence == 0.0 && p.albedo == albedo) return p.sigma;
  }
  return 0.0;
}

TEST(SensorMetrics, NoiseIsNearTheOnePredicted) {
  // Measured at an albedo of 0.8 over the whole image, predicted at 0.9 in its middle.
  for (const char* model : {"structured_light", "stereo", "time_of_flight", "laser_line"}) {
    const SensorMetrics m = measure_sensor(small(model));
    EXPECT_GT(m.valid_points, 3000u) << model;
    EXPECT_GT(m.temporal_noise / predicted(m, 0.9), 0.6) << model;
    EXPECT_LT(m.temporal_noise / predicted(m, 0.9), 1.7) << model;
    EXPECT_GE(m.point_precision, m.temporal_noise) << model;
    EXPECT_GT(predicted(m, 0.05), predicted(m, 0.9)) << model;
    EXPECT_LT(m.dimension_trueness, 0.05) << model;
  }
}

TEST(SensorMetrics, WhatIsNotMeasuredHasNoFigure) {
  Sensor blind = small("structured_light");
  blind.width = 64, blind.height = 48;
  blind.settings.of<StructuredLightSettings>().min_modulation = 0.99;
  const SensorMetrics m = measure_sensor(blind);
  EXPECT_EQ(m.valid_points, 0u);
  for (const double figure : {m.sphere_spacing, m.dimension_trueness, m.point_precision, m.temporal_noise,
                              m.local_planarity, m.global_planarity, m.probing_form[0], m.flatness[0]})
    EXPECT_TRUE(std::isnan(figure)) << figure;
}

}  // namespace
}  // namespace bin_scenes
