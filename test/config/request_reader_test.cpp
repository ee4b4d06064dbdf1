#include "bin_scenes/config/materials.hpp"
#include "bin_scenes/config/sensor_presets.hpp"
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "config/config_fixture.hpp"
#include "config/reference.hpp"
#include "config/suggest.hpp"

#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>

namespace bin_scenes {
namespace {

/// Every key of the table with a value that is not its default, except those that exclude each other.
const char* const everything = R"(
seed: 18446744073709551615
scenes: 3
first: 12
bin:
  inner_size: [0.6, 0.5, 0.25]
  wall_thickness: 0.004
  friction: 0.4
  restitution: 0.2
  motion: {times: [1, 2.5], poses: [[0, 0, 0.1], [0.2, 0, 0]], shake: [0.01, 0, 0], tilt: [0, 0.1, 0], frequency: 4,
           seconds: 3}
gravity: [0.1, 0, -9.80665]
parts:
  - model: bolt.stl
    unit: mm
    scale: 1.5
    count: 2
    density: 7850
    friction: 0.3
    restitution: 0.05
    thickness: 0.001
    tessellation: {chord: 0.0001, angle: 0.3}
    solid: "pin#2"
    poses:
      - [0.1, 0.2, 0.3, 0, 0, 0, 1]
      - {position: [0, 0, 0.1], orientation_xyzw: [0.6, 0, 0, 0.8]}
    velocities: [[1, 2, 3, 4, 5, 6], [0.1, 0, 0, 0, 0, 0]]
  - model: nut.stl
    count: 1
    mass: 0.02
    poses: [[0, 0, 0.5]]
    fixed: true
    motion: {belt: [0.3, 0, 0]}
pour:
  pattern: given
  drop_height: 0.03
  grid_spacing: 1.25
  limit: 12
  rest_window: 0.5
  rest_move: 0.002
  rest_turn: 0.02
solver:
  type: bullet
  preset: thesis
  bullet: {time_step: 0.005, iterations: 30, margin: 0.01, sleeping: false, hull_error: 0.02, max_hulls: 16,
           hull_volume_error: 0.2}
  thesis: {time_step: 0.02, sub_steps: 2, iterations: 5, bias: 0.3, slop: 0.02, rest_velocity: 0.1, voxels: 12,
           tightness: 0.75, radii: [0.1, 0.04], modified_normals: false, grid_size: 64, cell_size: 2, contacts_per_sphere: 8}
  sphere: {time_step: 0.002, sub_steps: 8, coarse_samples: 64, fine_samples: 500, field_cell: 0.02, device: cpu}
sensors:
  - {name: left, width: 320, height: 240, fov: 0.9, pose: [0, 0, 1, 1, 0, 0, 0], near: 0.1, far: 5}
  - name: right
    view_of: left
    model: time_of_flight
    k: [500, 0, 320, 0, 500, 240, 0, 0, 1]
    bounces: 0
    indirect_samples: 48
    imager: {exposure: 0.6, reference_distance: 1.5, ambient: 0.1, full_well: 20000, read_noise: 3, bits: 10}
    calibration: {focal: 0.4, center: 0.3, baseline: 1e-4, position: 2e-4, rotation: 5e-4, range: 3e-3}
    filter: {snr: 8, outlier: {neighbours: 6, window: 7, step: 0.01}}
    lamps: [{type: ring, pose: [0, 0, 1, 1, 0, 0, 0], radiance: 2, colour: [1, 0.9, 0.8], outer: 0.1, inner: 0.08},
            {type: area, width: 0.4, height: 0.2}, {type: dome, horizon: 0.7}]
    image: {samples: 64, colour: true, bits: 16}
    structured_light: {steps: 5, period: 20, gray_bits: 9, contrast: 0.8, defocus: 1, gamma: 1.1, min_modulation: 0.01,
                       mixed: keep, edge_step: 0.002}
    laser_line: {fan: 0.7, power: 0.4, blur: 0.9, speckle: 0.1, min_signal: 0.03, peak: nearest}
    stereo: {baseline: 0.2, disparities: 256, window: 9, dots: 0.2, uniqueness: 5, max_difference: 2, min_texture: 2, speckle_size: 50,
             disparity_noise: 0.1, min_signal: 0.05}
    time_of_flight: {axial: 0.002, axial_growth: 0.003, axial_distance: 0.5, axial_angle: 0.0002, lateral: 0.7,
                     lateral_angle: 0.03, albedo: 0.6, min_signal: 0.02, mixed: remove, edge_step: 0.03}
grippers: [{name: two, stroke: 0.07}]
prove: 5
accept: {penetration: 0.03, gap: 0.04, escaped: true}
seconds: 1.5
drift_check: true
memory_budget: 1e9
)";

TEST_F(ConfigTest, ReadsEveryKeyIntoItsField) {
  const Request r = read(everything);
  EXPECT_EQ(r.seed, 18446744073709551615u);
  EXPECT_EQ(r.scenes, 3u);
  EXPECT_EQ(r.first, 12u);
  EXPECT_EQ(r.bin.kind, Bin::Kind::box);
  EXPECT_EQ(r.bin.inner_size, Vec3(0.6, 0.5, 0.25));
  EXPECT_EQ(r.bin.wall_thickness, 0.004);
  EXPECT_EQ(r.bin.friction, 0.4);
  EXPECT_EQ(r.bin.restitution, 0.2);
  EXPECT_EQ(r.bin.motion.times, (std::vector<double>{1.0, 2.5}));
  EXPECT_EQ(r.bin.motion.poses.at(1).position, Vec3(0.2, 0, 0));
  EXPECT_EQ(r.bin.motion.shake, Vec3(0.01, 0, 0));
  EXPECT_EQ(r.bin.motion.tilt, Vec3(0, 0.1, 0));
  EXPECT_EQ(r.bin.motion.frequency, 4.0);
  EXPECT_EQ(r.bin.motion.seconds, 3.0);
  EXPECT_EQ(r.gravity, Vec3(0.1, 0, -9.80665));
  ASSERT_EQ(r.parts.size(), 2u);
  const PartLine& p = r.parts[0];
  EXPECT_EQ(p.model, "bolt.stl");
  EXPECT_EQ(p.path, (dir / "bolt.stl").string());
  EXPECT_EQ(p.unit, Unit::millimetre);
  EXPECT_EQ(p.scale, 1.5);
  EXPECT_EQ(p.count, 2u);
  EXPECT_EQ(p.density, 7850.0);
  EXPECT_FALSE(p.mass);
  EXPECT_EQ(p.friction, 0.3);
  EXPECT_EQ(p.restitution, 0.05);
  EXPECT_EQ(p.thickness, 0.001);
  EXPECT_EQ(p.tessellation.chord, 1e-4);
  EXPECT_EQ(p.tessellation.angle, 0.3);
  EXPECT_EQ(p.solid, "pin#2");
  ASSERT_EQ(p.poses.size(), 2u);
  EXPECT_EQ(p.poses[0].position, Vec3(0.1, 0.2, 0.3));
  EXPECT_NEAR(p.poses[1].orientation.x(), 0.6, 1e-15);
  EXPECT_EQ(p.velocities[0].angular, Vec3(4, 5, 6));
  EXPECT_FALSE(p.fixed);
  EXPECT_FALSE(r.parts[1].unit);
  EXPECT_EQ(r.parts[1].mass, 0.02);
  EXPECT_TRUE(r.parts[1].fixed);
  EXPECT_EQ(r.parts[1].motion.belt, Vec3(0.3, 0, 0));
  EXPECT_EQ(r.pour.pattern, Pour::Pattern::given);
  EXPECT_EQ(r.pour.drop_height, 0.03);
  EXPECT_EQ(r.pour.grid_spacing, 1.25);
  EXPECT_EQ(r.pour.limit, 12.0);
  EXPECT_EQ(r.pour.rest_window, 0.5);
  EXPECT_EQ(r.pour.rest_move, 0.002);
  EXPECT_EQ(r.pour.rest_turn, 0.02);
  EXPECT_EQ(r.solver.type, SolverType::bullet);
  EXPECT_EQ(r.solver.preset, SolverSettings::Preset::thesis);
  EXPECT_EQ(r.solver.bullet.time_step, 0.005);
  EXPECT_EQ(r.solver.bullet.iterations, 30);
  EXPECT_EQ(r.solver.bullet.margin, 0.01);
  EXPECT_FALSE(r.solver.bullet.sleeping);
  EXPECT_EQ(r.solver.bullet.hull_error, 0.02);
  EXPECT_EQ(r.solver.bullet.hull_volume_error, 0.2);
  EXPECT_EQ(r.solver.bullet.max_hulls, 16);
  EXPECT_EQ(r.solver.sphere.device, SphereSettings::Device::cpu);
  EXPECT_EQ(r.solver.thesis.time_step, 0.02);
  EXPECT_EQ(r.solver.thesis.sub_steps, 2);
  EXPECT_EQ(r.solver.thesis.iterations, 5);
  EXPECT_EQ(r.solver.thesis.bias, 0.3);
  EXPECT_EQ(r.solver.thesis.slop, 0.02);
  EXPECT_EQ(r.solver.thesis.rest_velocity, 0.1);
  EXPECT_EQ(r.solver.thesis.voxels, 12);
  EXPECT_EQ(r.solver.thesis.tightness, 0.75);
  EXPECT_FALSE(r.solver.thesis.modified_normals);
  EXPECT_EQ(r.solver.thesis.grid_size, 64);
  EXPECT_EQ(r.solver.thesis.cell_size, 2.0);
  EXPECT_EQ(r.solver.thesis.contacts_per_sphere, 8);
  EXPECT_EQ(r.solver.sphere.time_step, 0.002);
  EXPECT_EQ(r.solver.sphere.sub_steps, 8);
  EXPECT_EQ(r.solver.sphere.coarse_samples, 64);
  EXPECT_EQ(r.solver.sphere.fine_samples, 500);
  EXPECT_EQ(r.solver.sphere.field_cell, 0.02);
  ASSERT_EQ(r.sensors.size(), 2u);
  EXPECT_EQ(r.sensors[0].name, "left");
  EXPECT_EQ(r.sensors[0].width, 320);
  EXPECT_EQ(r.sensors[0].height, 240);
  EXPECT_EQ(r.sensors[0].fov, 0.9);
  EXPECT_EQ(r.sensors[0].pose->orientation.x(), 1.0);
  EXPECT_EQ(r.sensors[0].near, 0.1);
  EXPECT_EQ(r.sensors[0].far, 5.0);
  EXPECT_FALSE(r.sensors[1].pose);
  EXPECT_EQ(r.sensors[1].k[4], 500.0);
  const auto& errors = r.sensors[1].settings.of<CalibrationSettings>();
  EXPECT_EQ(errors.focal, 0.4);
  EXPECT_EQ(errors.center, 0.3);
  EXPECT_EQ(errors.baseline, 1e-4);
  EXPECT_EQ(errors.position, 2e-4);
  EXPECT_EQ(errors.rotation, 5e-4);
  EXPECT_EQ(errors.range, 3e-3);
  const auto& image = r.sensors[1].settings.of<ImageSettings>();
  EXPECT_EQ(image.samples, 64);
  EXPECT_TRUE(image.colour);
  EXPECT_EQ(image.bits, 16);
  ASSERT_EQ(image.lamps.size(), 3u);
  EXPECT_EQ(image.lamps[0].type, ImageLamp::Type::ring);
  EXPECT_EQ(image.lamps[0].pose->position.z(), 1.0);
  EXPECT_EQ(image.lamps[0].radiance, 2.0);
  EXPECT_EQ(image.lamps[0].colour, Vec3(1, 0.9, 0.8));
  EXPECT_EQ(image.lamps[0].outer, 0.1);
  EXPECT_EQ(image.lamps[0].inner, 0.08);
  EXPECT_EQ(image.lamps[1].width, 0.4);
  EXPECT_EQ(image.lamps[1].height, 0.2);
  EXPECT_EQ(image.lamps[2].horizon, 0.7);
  const auto& filter = r.sensors[1].settings.of<FilterSettings>();
  EXPECT_EQ(filter.snr, 8.0);
  EXPECT_EQ(filter.outlier.neighbours, 6);
  EXPECT_EQ(filter.outlier.window, 7);
  EXPECT_EQ(filter.outlier.step, 0.01);
  EXPECT_EQ(r.accept.penetration, 0.03);
  EXPECT_EQ(r.accept.gap, 0.04);
  EXPECT_TRUE(r.accept.escaped);
  EXPECT_EQ(r.seconds, 1.5);
  EXPECT_TRUE(r.drift_check);
  EXPECT_EQ(r.memory_budget, 1e9);
}

TEST_F(ConfigTest, TheReferenceTellsTheRangeThatIsTaken) {
  std::map<std::string, std::string> kinds;
  for (const config::Entry& entry : config::reference()) kinds[entry.path] = entry.kind;
  EXPECT_EQ(kinds["parts[].count"], "whole number in [1, 1000000]");
  EXPECT_EQ(kinds["parts[].scale"], "number in (0, 1000000]");
  EXPECT_EQ(kinds["seed"], "whole number, 0 or more");
  EXPECT_EQ(kinds["sensors[].near"], "number above 0");
  EXPECT_EQ(kinds["bin.inner_size"], "[x, y, z], each in (0, 1000]");
  EXPECT_EQ(kinds["solver.type"], "auto | sphere | bullet");
}

TEST_F(ConfigTest, EveryKeyOfTheTableIsInTheRequestOfTheTestAbove) {
  const Request all = read(everything);
  const std::string written = write_request(all);
  for (const config::Entry& entry : config::reference()) {
    const std::string name = entry.path.substr(entry.path.find_last_of('.') + 1);
    const bool excluded = entry.path == "bin.mesh" || entry.path == "bin.unit" || entry.path == "bin.pose" ||
                          entry.path == "bin.floor" || entry.path == "bin.none" || entry.path == "pour.scene" ||
                          entry.path == "rig" || name == "material" || name == "pose_of" ||
                          entry.path.rfind("sensors[].views", 0) == 0;
    EXPECT_TRUE(excluded || written.find(name + ":") != std::string::npos) << entry.path;
  }
}

TEST_F(ConfigTest, WhatIsWrittenReadsBackTheSame) {
  const Request once = read(everything);
  const std::string written = write_request(once);
  const Request twice = read(written);
  EXPECT_EQ(write_request(twice), written);
  EXPECT_EQ(twice.text_sha256, once.text_sha256);
  EXPECT_EQ(twice.parts[0].poses[1].orientation.coeffs(), once.parts[0].poses[1].orientation.coeffs());
}

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

TEST_F(ConfigTest, BinsOfEveryKindReadBackTheSame) {
  put("crate.stl", "solid crate");
  const struct {
    const char* yaml;
    Bin::Kind kind;
  } bins[] = {{"bin: {mesh: crate.stl, unit: mm, pose: [0, 0, 0.1, 0, 0, 1, 0]}\n", Bin::Kind::mesh},
              {"bin: {floor: true, friction: 0.9}\n", Bin::Kind::floor},
              {"bin: {none: true}\n", Bin::Kind::none},
              {"bin: {friction: 0.2}\n", Bin::Kind::box}};
  for (const auto& [yaml, kind] : bins) {
    const Request once = read(yaml + bolts);
    EXPECT_EQ(once.bin.kind, kind) << yaml;
    const Request twice = read(write_request(once));
    EXPECT_EQ(twice.bin.kind, kind) << yaml;
    EXPECT_EQ(twice.text_sha256, once.text_sha256) << yaml;
  }
}

TEST_F(ConfigTest, DefaultsAreThoseOfTheStructs) {
  const Request r = read(bolts);
  Request defaults;
  defaults.parts.emplace_back();
  defaults.parts[0].model = "bolt.stl";
  EXPECT_EQ(write_request(r), write_request(defaults));
}

TEST_F(ConfigTest, SetOverridesAnyKeyByItsPath) {
  const Request r = read(bolts, {"solver.type=bullet", "parts[0].count=7", "parts.0.friction=0.25", "seed=0",
                                 "bin.inner_size=[1, 2, 3]", "solver.bullet.iterations=99", "sensors=[{name: top}]"});
  EXPECT_EQ(r.solver.type, SolverType::bullet);
  EXPECT_EQ(r.parts[0].count, 7u);
  EXPECT_EQ(r.parts[0].friction, 0.25);
  EXPECT_EQ(r.bin.inner_size, Vec3(1, 2, 3));
  EXPECT_EQ(r.solver.bullet.iterations, 99);
  EXPECT_EQ(r.sensors.at(0).name, "top");
  EXPECT_EQ(read_request_text("{}", dir.string(), {"parts=[{model: nut.stl}]"}).parts[0].model, "nut.stl");
}

TEST_F(ConfigTest, UnknownKeysSuggestTheNearestKnownOne) {
  expect_refused("sede: 1\n" + bolts, {"request.yaml:1", "'sede'", "did you mean 'seed'"});
  expect_refused(bolts + "    cuont: 5\n", {"request.yaml:3", "'parts[0].cuont'", "did you mean 'count'"});
  expect_refused(bolts + "solver: {iterations: 5}\n", {"'solver.iterations'", "'solver.bullet.iterations'"});
  expect_refused(bolts + "time_step: 0.1\n", {"'solver.bullet.time_step'"});
  expect_refused(bolts + "zzzzzzzzzz: 1\n", {"unknown key 'zzzzzzzzzz'", "known here: seed"});
  expect_refused("scenes: 3\noutputs: [json]\nrequest: {}\n", {"request.yaml: this is a plan", "bin_scenes dataset"});
  expect_refused(bolts, {"--set solver.typ", "did you mean 'type'"}, {"solver.typ=bullet"});
  expect_refused(bolts, {"--set parts[0].cuont", "'count'"}, {"parts.0.cuont=5"});
}

TEST_F(ConfigTest, WrongTypesSayWhatWasExpectedAndWhatWasFound) {
  expect_refused(bolts + "    count: many\n", {"request.yaml:3", "'parts[0].count'", "whole number", "'many'"});
  expect_refused(bolts + "    count: -5\n", {"whole number, 0 or more", "'-5'"});
  expect_refused(bolts + "    count: 2.5\n", {"whole number", "'2.5'"});
  expect_refused(bolts + "    count: 99999999999999999999999\n", {"whole number"});
  expect_refused(bolts + "    friction: .nan\n", {"number", "'.nan'"});
  expect_refused(bolts + "    friction: [1]\n", {"expected number", "found [1]"});
  expect_refused(bolts + "    fixed: yes\n", {"true or false", "'yes'"});
  expect_refused(bolts + "    unit: meter\n", {"m | cm | mm | inch", "'meter'"});
  expect_refused(bolts + "gravity: [0, 0]\n", {"request.yaml:3", "[x, y, z]", "found [0, 0]"});
  expect_refused(bolts + "gravity: -9.81\n", {"[x, y, z]", "'-9.81'"});
  expect_refused(bolts + "solver: bullet\n", {"'solver'", "a map of keys", "'bullet'"});
  expect_refused(bolts + "sensors: {name: a}\n", {"'sensors'", "a list"});
  expect_refused("parts: bolt.stl\n", {"'parts'", "a list"});
  expect_refused(bolts + "sensors:\n  - pose: [0, 0, 1, 0, 0, 0, 0.1]\n", {"quaternion", "length 1"});
  expect_refused(bolts + "sensors:\n  - pose: {position: [0, 0, 1], rotation: [0, 0, 0, 1]}\n", {"orientation_xyzw"});
  expect_refused(bolts + "seed:\n", {"'seed'", "found nothing"});
  expect_refused(bolts, {"--set seed", "'x'"}, {"seed=x"});
}

TEST_F(ConfigTest, WhatIsNoRequestIsSaidSo) {
  expect_refused("", {"empty"});
  expect_refused("- 1\n- 2\n", {"no map"});
  expect_refused("just words\n", {"no map"});
  expect_refused("a: [1, 2\nb: 3\n", {"request.yaml:", "not YAML"});
  expect_refused(bolts + "---\n" + bolts, {"behind the end of the request"});
  expect_refused("seed: 1\nseed: 2\n" + bolts, {"request.yaml:2", "'seed' is given twice"});
  expect_refused("seed: 1\n", {"'parts'", "missing or empty"});
  expect_refused("parts:\n  - count: 3\n", {"request.yaml:2", "'parts[0].model' is missing"});
  EXPECT_THROW(read_request((dir / "nowhere.yaml").string()), Error);
  EXPECT_THROW(read_request(dir.string()), Error);
}

TEST_F(ConfigTest, MalformedSetsAreRefused) {
  expect_refused(bolts, {"key=value"}, {"seed"});
  expect_refused(bolts, {"key=value"}, {"=5"});
  expect_refused(bolts, {"no item of a list of 1"}, {"parts[3].count=5"});
  expect_refused("seed: 1\n" + bolts, {"'seed' is a value"}, {"seed.deep=5"});
  expect_refused(bolts, {"not YAML"}, {"bin.inner_size=[1, 2"});
}

TEST_F(ConfigTest, KindsOfBinExcludeEachOther) {
  expect_refused("bin: {inner_size: [1, 1, 1], floor: true}\n" + bolts, {"'bin.inner_size' and 'bin.floor'"});
  expect_refused("bin: {floor: true, wall_thickness: 0.1}\n" + bolts, {"'bin.wall_thickness'", "no meaning"});
  expect_refused("bin: {unit: mm}\n" + bolts, {"'bin.unit'", "bin.mesh"});
}

TEST_F(ConfigTest, ModelsAreFoundByRelativeAbsoluteAndPackagePaths) {
  put("space/deep/my_parts/package.xml", "<package><name>my_parts</name></package>");
  put("space/deep/my_parts/meshes/ring.stl", "solid ring");
  ::setenv("ROS_PACKAGE_PATH", ("/nonexistent:" + (dir / "space").string()).c_str(), 1);
  EXPECT_EQ(read("parts: [{model: package://my_parts/meshes/ring.stl}]").parts[0].path,
            (dir / "space/deep/my_parts/meshes/ring.stl").string());
  EXPECT_EQ(read("parts: [{model: " + (dir / "nut.stl").string() + "}]").parts[0].path, (dir / "nut.stl").string());
  PathRules rules;
  rules.find_package = [&](const std::string& name) { return name == "mine" ? dir.string() : std::string(); };
  EXPECT_EQ(read("parts: [{model: package://mine/nut.stl}]", {}, rules).parts[0].path, (dir / "nut.stl").string());
  expect_refused("parts: [{model: package://absent/ring.stl}]", {"no package 'absent'", "ROS_PACKAGE_PATH"});
  expect_refused("parts: [{model: package://my_parts}]", {"names no file"});
  ::unsetenv("ROS_PACKAGE_PATH");
}

TEST_F(ConfigTest, MissingModelsAreNamedWithALikelyFile) {
  expect_refused("parts:\n  - model: blot.stl\n", {"request.yaml:2", "blot.stl", "did you mean 'bolt.stl'"});
  expect_refused("parts: [{model: .}]", {"not a file"});
  expect_refused("bin: {mesh: crate.stl}\n" + bolts, {"request.yaml:1", "crate.stl"});
}

TEST_F(ConfigTest, ModelsOutsideTheRootsAreRefusedThroughLinksToo) {
  put("inside/part.stl", "solid");
  put("inside-not/part.stl", "solid");
  std::filesystem::create_symlink(dir / "nut.stl", dir / "inside/link.stl");
  PathRules rules;
  rules.roots = {(dir / "inside").string() + "/"};
  rules.roots_name = "~model_roots";
  EXPECT_NO_THROW(read("parts: [{model: inside/part.stl}]", {}, rules));
  for (const char* model : {"nut.stl", "inside/../nut.stl", "inside/link.stl", "inside-not/part.stl", "absent.stl"}) {
    const std::string message = refusal("parts: [{model: " + std::string(model) + "}]", {}, rules);
    EXPECT_NE(message.find("outside of ~model_roots"), std::string::npos) << message;
  }
}

TEST_F(ConfigTest, RelativeModelsAreSearchedInEachRootAfterTheRequestsFolder) {
  put("first/other.stl", "solid");
  put("second/part.stl", "solid");
  put("second/bolt.stl", "solid");
  PathRules rules;
  rules.roots = {(dir / "first").string(), (dir / "second").string(), dir.string()};
  EXPECT_EQ(read("parts: [{model: part.stl}]", {}, rules).parts[0].path, (dir / "second/part.stl").string());
  EXPECT_EQ(read("parts: [{model: bolt.stl}]", {}, rules).parts[0].path, (dir / "bolt.stl").string());
  rules.roots_name = "~model_roots";
  EXPECT_NE(refusal("parts: [{model: absent.stl}]", {}, rules).find("~model_roots"), std::string::npos);
}

TEST_F(ConfigTest, GoesOnFromAnEarlierScene) {
  const auto part = [](int id, const char* model, int line, const char* state, double z) {
    return std::string(R"({"id": )") + std::to_string(id) + R"(, "line": )" + std::to_string(line) + R"(, "model": ")" +
           model + R"(", "pose": {"position": [0, 0, )" + std::to_string(z) +
           R"(], "orientation_xyzw": [0, 0, 0, 1]}, "state": ")" + state + R"("})";
  };
  put("scene.json", R"({"format": "bin_scenes/1", "seed": 1, "index": 0, "parts": [)" +
                        part(0, "bolt.stl", 0, "resting", 0.01) + "," + part(1, "bolt.stl", 0, "escaped", -1) + "," +
                        part(2, "nut.stl", 1, "moving", 0.03) + "]}");
  const std::string given = "pour: {pattern: given, scene: scene.json}\n";
  const Request r = read(given + "parts: [{model: bolt.stl}, {model: nut.stl}]");
  ASSERT_EQ(r.parts[0].poses.size(), 1u);
  EXPECT_EQ(r.parts[0].count, 1u);
  EXPECT_EQ(r.parts[0].poses[0].position.z(), 0.01);
  EXPECT_EQ(r.parts[1].poses[0].position.z(), 0.03);
  EXPECT_EQ(read(write_request(r)).text_sha256, r.text_sha256) << "written back, it stands on its own";
  expect_refused(given + "parts: [{model: bolt.stl, count: 2}, {model: nut.stl}]", {"is 2", "has 1"});
  expect_refused(given + "parts: [{model: nut.stl}, {model: bolt.stl}]", {"'bolt.stl' of part line 0"});
  expect_refused("pour: {scene: scene.json}\n" + bolts, {"pattern: given"});
  put("scene.json", "{}");
  expect_refused(given + bolts, {"scene.json", "format"});
}

TEST_F(ConfigTest, APartOfAnEarlierSceneIsKnownByItsBytesWhereverItLies) {
  Scene scene;
  scene.model_sha256 = {sha256_hex("solid bolt")};
  scene.parts.emplace_back();
  scene.parts[0].model = "bolt.stl";
  scene.parts[0].state = PartState::resting;
  Request made;
  made.parts.emplace_back();
  made.parts[0].model = "bolt.stl";
  put("scene.json", scene_json(scene, made));
  const std::string given = "pour: {pattern: given, scene: " + (dir / "scene.json").string() + "}\n";
  put("deeper/twin.stl", "solid bolt");
  EXPECT_EQ(read(given + "parts: [{model: deeper/twin.stl}]").parts[0].poses.size(), 1u);
  std::ofstream(dir / "deeper/request.yaml") << given << "parts: [{model: ../bolt.stl}]";
  EXPECT_EQ(read_request((dir / "deeper/request.yaml").string()).parts[0].poses.size(), 1u);
  put("bolt.stl", "solid other");
  expect_refused(given + "parts: [{model: bolt.stl}]", {"'bolt.stl' of part line 0"});

  // A scene of somebody else tells no bytes: its names have to do.
  scene.model_sha256.clear();
  put("scene.json", scene_json(scene, made));
  EXPECT_EQ(read_request((dir / "deeper/request.yaml").string()).parts[0].poses.size(), 1u);
}

TEST_F(ConfigTest, PartsThatWereNeverPouredHaveNothingToGoOnFrom) {
  Scene scene;
  for (int id = 0; id < 2; ++id) {
    scene.parts.emplace_back();
    scene.parts[id].id = id;
    scene.parts[id].model = "bolt.stl";
    scene.parts[id].state = id == 0 ? PartState::not_poured : PartState::resting;
  }
  scene.parts[0].pose = Pose::none();
  scene.parts[1].pose.position.z() = 0.5;
  put("scene.json", scene_json(scene, {}));
  const Request r = read("pour: {pattern: given, scene: scene.json}\nparts: [{model: bolt.stl}]");
  ASSERT_EQ(r.parts[0].poses.size(), 1u);
  EXPECT_EQ(r.parts[0].poses[0].position.z(), 0.5);
}

TEST_F(ConfigTest, MessagesNameWhatTheUserWrote) {
  expect_refused(bolts, {"--seconds", "above 0", "-1"}, {{"seconds=-1", "--seconds"}});
  expect_refused(bolts, {"--seed", "whole number", "1.5"}, {{"seed=1.5", "--seed"}});
  expect_refused(bolts, {"--scenes", "at least 1"}, {{"scenes=0", "--scenes"}});
  expect_refused(bolts, {"--set seconds"}, {"seconds=-1"});
  for (const Override& item : {Override("seconds=-1", "--seconds"), Override("parts=[{model: 5}]", "the message")})
    EXPECT_EQ(refusal(bolts, {item}).find("--set"), std::string::npos);
}

TEST_F(ConfigTest, ABadItemOfAListIsNamed) {
  expect_refused("parts: [{model: bolt.stl, count: 2, poses: [[0, 0, 1], [0, 0, 2, 0, 0, 0, 0]]}]\n",
                 {"'parts[0].poses[1]'", "length 1", "[0, 0, 2, 0, 0, 0, 0]"});
  expect_refused("parts: [{model: bolt.stl, poses: [[0, 0, 1]], velocities: [[1, 2]]}]\n",
                 {"'parts[0].velocities[0]'", "[1, 2]"});
}

TEST_F(ConfigTest, ModelsAreNotTakenForDirectories) {
  std::filesystem::create_directories(dir / "out");
  std::filesystem::create_directories(dir / "bolt.st");
  const std::string number = refusal("parts: [{model: 5}]\n");
  EXPECT_EQ(number.find("did you mean"), std::string::npos) << number;
  expect_refused("parts: [{model: bolt.sl}]\n", {"did you mean 'bolt.stl'"});
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

TEST_F(ConfigTest, RadiiOfSpheresFall) {
  const auto radii = [](const std::string& list) { return Override("solver.thesis.radii=" + list); };
  EXPECT_EQ(read(bolts, {radii("[0.1, 0.04]")}).solver.thesis.radii, (std::vector<double>{0.1, 0.04}));
  expect_refused(bolts, {"radii[1]", "largest first"}, {radii("[0.04, 0.1]")});
  expect_refused(bolts, {"radii[0]", "at most 0.5"}, {radii("[0.6]")});
  expect_refused(bolts, {"radii[0]", "at least"}, {radii("[0]")});
}

TEST_F(ConfigTest, TheHashCoversWhatDecidesTheScenesAndNothingElse) {
  const std::string hash = read(bolts).text_sha256;
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_EQ(read("scenes: 100\nfirst: 5\n" + bolts).text_sha256, hash);
  EXPECT_EQ(read("# a remark\n" + bolts + "pour: {pattern: rain}\n").text_sha256, hash);
  EXPECT_NE(read("seed: 1\n" + bolts).text_sha256, hash);
  EXPECT_NE(read(bolts, {"solver.type=bullet"}).text_sha256, hash);
  EXPECT_NE(read(bolts, {"solver.thesis.radii=[0.1]"}).text_sha256, hash);
  put("bolt.stl", "solid other");
  EXPECT_NE(read(bolts).text_sha256, hash) << "the model itself has changed";
}

TEST(Reference, TheDocumentedKeysAreThoseOfTheTable) {
  std::ifstream file(std::string(BIN_SCENES_DOCS) + "/use/request.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  char holes[64];
  std::snprintf(holes, sizeof holes, "holes of at most %g %% of its diagonal around", 100.0 * LoadOptions().max_hole);
  EXPECT_NE(text.find(holes), std::string::npos);
  EXPECT_EQ(text, request_reference()) << "run: bin_scenes reference > docs/use/request.md";
}

TEST_F(ConfigTest, ARefusedValueIsToldWithItsLine) {
  expect_refused(bolts + "    friction: -0.5\n", {"request.yaml:3", "'parts[0].friction'", "at least 0", "is -0.5"});
  expect_refused(bolts, {"--set parts[0].friction", "is -1"}, {"parts[0].friction=-1"});
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
