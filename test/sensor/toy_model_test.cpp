/// A sensor model in one file, as docs/develop/architecture.md says: everything that asks for models knows it.
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/sensor/metrics.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_model.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "raster/stage.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace bin_scenes {
namespace {

struct ToySettings {
  double offset = 0.01;  ///< m
  enum class Sign { plus, minus } sign = Sign::plus;
};

void visit_keys(KeyVisitor& v, ModelSettings& settings) {
  auto& s = settings.of<ToySettings>();
  v.field({"offset", "m", "Added to the true depth.", at_least(0.0, 0.5)}, s.offset);
  v.field({"sign", "", "Sign of the offset."}, s.sign,
          {{"plus", ToySettings::Sign::plus}, {"minus", ToySettings::Sign::minus}});
}

void check_toy(const Sensor& sensor, const std::string& key) {
  if (sensor.settings.of<ToySettings>().offset == 0.25) throw input_error("is odd", key + ".toy.offset", "not 0.25");
}

RangeImage measure_toy(const Scenery& scenery, View&& view, const Sensor& sensor, const Surfaces& surfaces,
                       const Draw& draw) {
  const auto& s = sensor.settings.of<ToySettings>();
  RangeImage image = sensor_model("ideal").measure(scenery, std::move(view), sensor, surfaces, draw);
  image.truth_depth = image.depth;
  for (float& depth : image.depth)
    depth += static_cast<float>(s.sign == ToySettings::Sign::plus ? s.offset : -s.offset);
  return image;
}

double sigma_of_toy(const Sensor&, double distance, double, double) {
  return 0.125 * distance;
}

constexpr SensorModel toy{"toy",        "A constant error of depth.", visit_keys, check_toy, nullptr, measure_toy,
                          sigma_of_toy, SensorModel::Image::profiles};
const bool toy_is_there = register_sensor_model(toy);

Request read(const std::string& sensor, const std::vector<Override>& overrides = {}) {
  return read_request_text("parts: [{model: bolt_hex.stl, unit: mm}]\nsensors:\n - " + sensor,
                           std::getenv("BIN_SCENES_MODELS"), overrides);
}

std::string error_of(const std::string& sensor) {
  try {
    read(sensor);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ToyModel, IsReadFromRequestsAndBySet) {
  const Sensor sensor = read("{model: toy, toy: {sign: minus}}", {{"sensors[0].toy.offset=0.02"}}).sensors.at(0);
  EXPECT_EQ(sensor.model, "toy");
  EXPECT_EQ(sensor.settings.of<ToySettings>().offset, 0.02);
  EXPECT_EQ(sensor.settings.of<ToySettings>().sign, ToySettings::Sign::minus);
}

TEST(ToyModel, IsWrittenBackAndCounts) {
  const Request request = read("{model: toy, toy: {offset: 0.03, sign: minus}}");
  const std::string text = write_request(request);
  EXPECT_NE(text.find("    toy:\n      offset: 0.03\n      sign: minus\n"), std::string::npos) << text;
  EXPECT_NE(request_hash(request), request_hash(read("{model: toy}")));
}

TEST(ToyModel, MistakesAreTold) {
  EXPECT_NE(error_of("{model: toi}").find("did you mean 'toy'"), std::string::npos) << error_of("{model: toi}");
  EXPECT_NE(error_of("{toy: {ofset: 1}}").find("did you mean 'offset'"), std::string::npos);
  EXPECT_NE(error_of("{toy: {sign: mines}}").find("did you mean 'minus'"), std::string::npos);
  const std::string far = error_of("{toy: {offset: 0.7}}");
  EXPECT_NE(far.find("request:3"), std::string::npos) << far;
  EXPECT_NE(far.find("'sensors[0].toy.offset': must be at least 0 and at most 0.5, is 0.7"), std::string::npos) << far;
  EXPECT_NE(far.find("Unit: m. Added to the true depth."), std::string::npos) << far;
  EXPECT_NE(error_of("{toy: {offset: 0.25}}").find("is odd"), std::string::npos);
}

TEST(ToyModel, StandsInTheReference) {
  const std::string page = request_reference();
  EXPECT_NE(page.find("image \\| toy | `ideal` |"), std::string::npos);
  EXPECT_NE(page.find("### `sensors[].toy`\nA constant error of depth."), std::string::npos);
  EXPECT_NE(page.find("| `offset` | number in [0, 0.5] | `0.01` | m | Added to the true depth. |"), std::string::npos);
}

TEST(ToyModel, Measures) {
  test::Stage stage;
  stage.place(stage.model(test::box_mesh({0.1, 0.1, 0.02})), test::at(0, 0, 0.5));
  Sensor sensor;
  sensor.model = "toy";
  sensor.pose = Pose();
  stage.scene.sensors = {resolved(sensor, stage.request.bin)};
  const RangeImage image = SensorRig().render(stage.scene, {stage.request, stage.models}).at(0);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    if (std::isnan(image.depth[i])) continue;
    ++seen;
    ASSERT_NEAR(image.depth[i] - image.truth_depth[i], 0.01, 1e-6);
  }
  EXPECT_GT(seen, 1000u);
  EXPECT_EQ(stage.scene.report.profile.counters.at("noisy_images"), 1u);
}

TEST(ToyModel, HasFiguresAndIsRefusedByBop) {
  Sensor sensor;
  sensor.model = "toy";
  sensor.width = 160;
  sensor.height = 128;
  for (const PredictedSigma& p : measure_sensor(sensor).predicted) EXPECT_EQ(p.sigma, 0.125 * p.distance);
  EXPECT_EQ(bop_misfit(sensor), "BOP holds pinhole images, and the profiles of a toy sensor are none");
}

TEST(ToyModel, NamesAreTakenOnce) {
  EXPECT_THROW(register_sensor_model(toy), Error);
  EXPECT_THROW(sensor_model("toi"), Error);
}

}  // namespace
}  // namespace bin_scenes
