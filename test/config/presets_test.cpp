/// Values by name: presets of the solver and of sensors, the pose of another sensor, materials.
#include "bin_scenes/config/presets.hpp"
#include "config/config_fixture.hpp"

#include <cstdlib>

namespace bin_scenes {
namespace {

/// An image where another sensor stands, of each of its views.
TEST_F(ConfigTest, PoseOfTakesLensPlaceAndViews) {
  const std::string camera =
      bolts +
      "sensors:\n  - {name: grey, model: image, pose_of: range}\n"
      "  - {name: range, model: structured_light, width: 320, height: 200, fov: 0.6, near: 0.3, far: 2,\n"
      "     distortion: [0.1, 0, 0, 0, 0], projector: {baseline: 0.3}, ";
  const Request one = read(camera + "pose: [0, 0, 1, 1, 0, 0, 0]}\n");
  ASSERT_EQ(one.sensors.size(), 2u);
  const Sensor& grey = one.sensors[0];
  EXPECT_EQ(grey.model, "image");
  EXPECT_EQ(grey.width, 320);
  EXPECT_EQ(grey.height, 200);
  EXPECT_EQ(grey.fov, 0.6);
  EXPECT_EQ(grey.distortion[0], 0.1);
  EXPECT_EQ(grey.near, 0.3);
  EXPECT_EQ(grey.far, 2.0);
  EXPECT_EQ(grey.projector.baseline, 0.3);
  EXPECT_EQ(grey.pose->position.z(), 1.0);
  EXPECT_EQ(write_request(read(write_request(one))), write_request(one));
  const Request two = read(camera + "views: {count: 2}}\n");
  ASSERT_EQ(two.sensors.size(), 4u);
  EXPECT_EQ(two.sensors[1].name, "grey_1");
  EXPECT_EQ(two.sensors[1].pose->position, two.sensors[3].pose->position);
  expect_refused(bolts + "sensors: [{name: grey, pose_of: rang}, {name: range}]\n",
                 {"'rang' is no other sensor", "range"});
  expect_refused(bolts + "sensors: [{name: grey, pose_of: grey}]\n", {"'grey' is no other sensor", "give a pose"});
  expect_refused(bolts + "sensors: [{name: grey, pose_of: range, width: 9}, {name: range}]\n",
                 {"the sensor has width of its own"});
}

TEST_F(ConfigTest, APresetSetsWhatIsNotGiven) {
  const Request quick = read("solver: {preset: quick, sphere: {sub_steps: 3}}\n" + bolts);
  Request meant = read(bolts);
  apply(SolverSettings::Preset::quick, meant);
  EXPECT_NE(write_request(meant), write_request(read(bolts)));
  meant.solver.sphere.sub_steps = 3;
  EXPECT_EQ(write_request(quick), write_request(meant)) << "what is given stays";
  EXPECT_EQ(read(bolts, {"solver.preset=quick", "pour.finish=probed"}).pour.finish, Pour::Finish::probed);
  EXPECT_EQ(write_request(read(write_request(quick))), write_request(quick)) << "written back, it stands on its own";
}

class SensorPresets : public ConfigTest {
 protected:
  SensorPresets() {
    put("presets/close_fringes.yaml",
        "model: structured_light\nwidth: 800\nfov: 0.5\nprojector: {pose: [0.2, 0, 1], fov: 0.6}\n");
    put("presets/calibrated.yaml", "k: [900, 0, 400, 0, 900, 300, 0, 0, 1]\n");
    put("presets/wrong.yaml", "model: ideal\nwidht: 3\n");
    ::setenv("BIN_SCENES_SENSORS", (dir / "presets").c_str(), 1);
  }
  ~SensorPresets() override { ::unsetenv("BIN_SCENES_SENSORS"); }

  Sensor sensor(const std::string& keys) {
    return read("parts: [{model: bolt.stl}]\nsensors: [{" + keys + "}]\n").sensors.at(0);
  }
};

TEST_F(SensorPresets, ValuesOfThePresetYieldToThoseOfTheRequest) {
  const Sensor s = sensor("name: left, preset: close_fringes, width: 640, projector: {width: 912}");
  EXPECT_EQ(s.name, "left");
  EXPECT_EQ(s.model, "structured_light");
  EXPECT_EQ(s.preset, "close_fringes");
  EXPECT_EQ(s.width, 640);
  EXPECT_EQ(s.height, 480);
  EXPECT_EQ(s.fov, 0.5);
  EXPECT_EQ(s.projector.width, 912);
  EXPECT_EQ(s.projector.fov, 0.6);
  EXPECT_TRUE(s.projector.pose);
}

TEST_F(SensorPresets, KeysThatSayTheSameInOtherWordsReplaceEachOther) {
  EXPECT_FALSE(sensor("preset: calibrated").k.empty());
  EXPECT_TRUE(sensor("preset: calibrated, fov: 0.4").k.empty());
  EXPECT_FALSE(sensor("preset: close_fringes, projector: {baseline: 0.1}").projector.pose);
}

TEST_F(SensorPresets, MistakesAreNamedWhereTheyStand) {
  const std::string bolts = "parts: [{model: bolt.stl}]\n";
  expect_refused(bolts + "sensors: [{preset: close_fringe}]\n", {"close_fringes", "request.yaml:2"});
  expect_refused(bolts + "sensors: [{preset: ../request}]\n", {"no sensor preset"});
  expect_refused(bolts + "sensors: [{preset: wrong}]\n", {"widht", "width", "wrong.yaml:2"});
  expect_refused(bolts + "sensors: [{model: laser_lin}]\n", {"did you mean 'laser_line'?"});
}

TEST_F(SensorPresets, ThoseThatAreInstalledCanBeRead) {
  ::unsetenv("BIN_SCENES_SENSORS");
  EXPECT_FALSE(sensor_presets().empty());
  for (const std::string& name : sensor_presets()) {
    SCOPED_TRACE(name);
    const Sensor s = sensor("preset: " + name);
    EXPECT_EQ(s.preset, name);
  }
}

TEST_F(ConfigTest, PicturesOfDomesAreFilesBesideTheRequest) {
  const auto with = [](const std::string& lamp) {
    return "parts: [{model: bolt.stl}]\nsensors: [{model: image, lamps: [" + lamp + "]}]\n";
  };
  expect_refused(with("{type: dome, picture: sk.hdr}"), {"sk.hdr", "did you mean 'sky.hdr'?", "request.yaml:2"});
  expect_refused(with("{type: dome, picture: bolt.stl}"), {"bolt.stl", "no Radiance picture", "request.yaml:2"});
  expect_refused(with("{type: area, picture: sky.hdr}"), {"applies only to lamps of type dome"});
}

TEST_F(ConfigTest, MaterialsAreSurfacesByName) {
  const std::string bolts = "parts: [{model: bolt.stl, surface: ";
  const Surface brass = material("brass");
  EXPECT_TRUE(brass.metal());
  const Surface s = read(bolts + "{material: brass, roughness: 0.7}}]\n").parts[0].surface;
  EXPECT_EQ(s.refraction, brass.refraction);
  EXPECT_EQ(s.extinction, brass.extinction);
  EXPECT_EQ(s.albedo, brass.albedo);
  EXPECT_EQ(s.gloss, brass.gloss);
  EXPECT_EQ(s.roughness, 0.7);
  EXPECT_EQ(read("bin: {surface: {material: cardboard}}\nparts: [{model: bolt.stl}]\n").bin.surface.gloss, 0.0);
  EXPECT_EQ(read(bolts + "{albedo: 0.5}}]\n", {"parts[0].surface.material=rubber_black"}).parts[0].surface.gloss,
            material("rubber_black").gloss);
  expect_refused(bolts + "{material: steel_brushd}}]\n", {"did you mean 'steel_brushed'?", "request.yaml:1"});
  EXPECT_EQ(materials().size(), 12u);
  EXPECT_GT(material("steel_brushed").anisotropy, 0.0);
  EXPECT_GT(material("aluminium_milled").anisotropy, 0.0);
  for (const std::string& name : materials()) {
    SCOPED_TRACE(name);
    const Surface known = material(name);
    EXPECT_GT(known.albedo, 0.0);
    EXPECT_LE(known.albedo, 1.0);
    EXPECT_LE(known.gloss, 1.0);
  }
}

}  // namespace
}  // namespace bin_scenes
