/// Keys of a request: read into their fields, refused with words, written back, documented.
#include "bin_scenes/sensor/calibration.hpp"
#include "bin_scenes/sensor/filter.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "config/config_fixture.hpp"
#include "config/reference.hpp"

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
    surface: {anisotropy: 0.6, along: [0, 1, 0], texture: {scratches: 0.1, oil: 0.2, rust: 0.3}}
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
  - {model: nut.stl, count: 4, distractor: true, on_table: 0.2}
table: {height: -0.01, mottle: 0.2, patch: 0.08}
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
            {type: area, width: 0.4, height: 0.2}, {type: dome, horizon: 0.7, picture: sky.hdr, turn: 0.8}]
    image: {samples: 64, colour: true, bits: 16}
    structured_light: {steps: 5, period: 20, gray_bits: 9, contrast: 0.8, defocus: 1, gamma: 1.1, min_modulation: 0.01,
                       mixed: keep, edge_step: 0.002}
    laser_line: {fan: 0.7, power: 0.4, blur: 0.9, speckle: 0.1, min_signal: 0.03, peak: nearest}
    stereo: {baseline: 0.2, disparities: 256, window: 9, dots: 0.2, uniqueness: 5, max_difference: 2, min_texture: 2, speckle_size: 50,
             disparity_noise: 0.1, min_signal: 0.05}
    time_of_flight: {axial: 0.002, axial_growth: 0.003, axial_distance: 0.5, axial_angle: 0.0002, lateral: 0.7,
                     lateral_angle: 0.03, albedo: 0.6, min_signal: 0.02, mixed: remove, edge_step: 0.03, modulation: 80}
grippers: [{name: two, stroke: 0.07, score: {bias: -0.5, holding: 1.5, sliding: 2.5}}]
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
  ASSERT_EQ(r.parts.size(), 3u);
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
  EXPECT_FALSE(r.parts[1].distractor);
  EXPECT_TRUE(r.parts[2].distractor);
  EXPECT_EQ(r.parts[2].on_table, 0.2);
  EXPECT_EQ(r.table.height, -0.01);
  EXPECT_EQ(r.table.mottle, 0.2);
  EXPECT_EQ(r.table.patch, 0.08);
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
  EXPECT_EQ(image.lamps[2].picture, (dir / "sky.hdr").string());
  EXPECT_EQ(image.lamps[2].turn, 0.8);
  const Surface& surface = r.parts[0].surface;
  EXPECT_EQ(surface.anisotropy, 0.6);
  EXPECT_EQ(surface.along, Vec3(0, 1, 0));
  EXPECT_EQ(surface.texture.scratches, 0.1);
  EXPECT_EQ(surface.texture.oil, 0.2);
  EXPECT_EQ(surface.texture.rust, 0.3);
  const auto& filter = r.sensors[1].settings.of<FilterSettings>();
  EXPECT_EQ(filter.snr, 8.0);
  EXPECT_EQ(filter.outlier.neighbours, 6);
  EXPECT_EQ(filter.outlier.window, 7);
  EXPECT_EQ(filter.outlier.step, 0.01);
  EXPECT_EQ(r.grippers.at(0).score.bias, -0.5);
  EXPECT_EQ(r.grippers.at(0).score.holding, 1.5);
  EXPECT_EQ(r.grippers.at(0).score.sliding, 2.5);
  EXPECT_EQ(r.accept.penetration, 0.03);
  EXPECT_EQ(r.accept.gap, 0.04);
  EXPECT_TRUE(r.accept.escaped);
  EXPECT_EQ(r.seconds, 1.5);
  EXPECT_TRUE(r.drift_check);
  EXPECT_EQ(r.memory_budget, 1e9);
}

TEST_F(ConfigTest, EveryKeyOfTheTableIsInTheRequestOfTheTestAbove) {
  const Request all = read(everything);
  const std::string written = write_request(all);
  for (const config::Entry& entry : config::reference()) {
    const std::string name = entry.path.substr(entry.path.find_last_of('.') + 1);
    const bool excluded = entry.path == "bin.mesh" || entry.path == "bin.unit" || entry.path == "bin.pose" ||
                          entry.path == "bin.floor" || entry.path == "bin.none" || entry.path == "pour.scene" ||
                          entry.path == "rig" || name == "material" || name == "pose_of" ||
                          entry.path.rfind("grippers[].finger_mesh", 0) == 0 ||
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
  expect_refused("- 1\n- 2\n", {"not a map of keys"});
  expect_refused("just words\n", {"not a map of keys"});
  expect_refused("a: [1, 2\nb: 3\n", {"request.yaml:", "not YAML"});
  expect_refused(bolts + "---\n" + bolts, {"after the end of the request"});
  expect_refused("seed: 1\nseed: 2\n" + bolts, {"request.yaml:2", "'seed' is given twice"});
  expect_refused("seed: 1\n", {"'parts'", "missing or empty"});
  expect_refused("parts:\n  - count: 3\n", {"request.yaml:2", "'parts[0].model' is missing"});
  EXPECT_THROW(read_request((dir / "nowhere.yaml").string()), Error);
  EXPECT_THROW(read_request(dir.string()), Error);
}

TEST_F(ConfigTest, MalformedSetsAreRefused) {
  expect_refused(bolts, {"key=value"}, {"seed"});
  expect_refused(bolts, {"key=value"}, {"=5"});
  expect_refused(bolts, {"not an index of a list with the length 1"}, {"parts[3].count=5"});
  expect_refused("seed: 1\n" + bolts, {"'seed' is a single value"}, {"seed.deep=5"});
  expect_refused(bolts, {"not YAML"}, {"bin.inner_size=[1, 2"});
}

TEST_F(ConfigTest, KindsOfBinExcludeEachOther) {
  expect_refused("bin: {inner_size: [1, 1, 1], floor: true}\n" + bolts, {"'bin.inner_size' and 'bin.floor'"});
  expect_refused("bin: {floor: true, wall_thickness: 0.1}\n" + bolts, {"'bin.wall_thickness'", "no meaning"});
  expect_refused("bin: {unit: mm}\n" + bolts, {"'bin.unit'", "bin.mesh"});
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

TEST_F(ConfigTest, ARefusedValueIsToldWithItsLine) {
  expect_refused(bolts + "    friction: -0.5\n", {"request.yaml:3", "'parts[0].friction'", "at least 0", "is -0.5"});
  expect_refused(bolts, {"--set parts[0].friction", "is -1"}, {"parts[0].friction=-1"});
}

}  // namespace
}  // namespace bin_scenes
