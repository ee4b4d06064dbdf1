/// The real binary, as a user calls it: exit code, messages, and what it leaves in files.
#include "tool/command_line_fixture.hpp"

#include <cmath>
#include <set>
#include <sstream>

namespace bin_scenes {
namespace {

TEST_F(CommandLine, BadRequestsEndWithCodeTwoAndNothingWritten) {
  expect_failure("", 2, {"--help"});
  expect_failure("generate request.yaml", 2, {"--out"});
  expect_failure("generate request.yaml --out out --colour red", 2, {"--colour"});
  expect_failure("generate nowhere.yaml --out out", 2, {"nowhere.yaml"});
  expect_failure("generate request.yaml --out request.yaml/deeper", 2, {"not a directory"});
  expect_failure("generate request.yaml --out out --formats json,exr", 2, {"exr", "json, pcd"});
  expect_failure("generate request.yaml --out out --formats png", 2, {"sensors"});
  expect_failure("generate request.yaml --out out --set solver.typ=bullet", 2, {"solver.typ", "'type'"});
  expect_failure("generate request.yaml --out out --solver fast", 2, {"auto | sphere | bullet", "fast"});
  expect_failure("generate request.yaml --out out --seed -1", 2, {"seed"});
  expect_failure("generate request.yaml --out out --scenes 0", 2, {"scenes"});
  expect_failure("generate request.yaml --out out --scenes 2 --trace t.csv", 2, {"--trace", "--scenes 1"});
  for (const char* rate : {"nan", "inf", "1e-300", "0", "-3"}) {
    expect_failure(std::string("generate request.yaml --out out --trace t.csv --trace-rate ") + rate, 2,
                   {"--trace-rate", "0.001"});
  }
  expect_failure("generate request.yaml --out out --set parts[0].count=100000000000", 2, {"count"});
  expect_failure("generate request.yaml --out out --set memory_budget=1000", 2, {"MB", "memory_budget"});
  expect_failure("generate request.yaml --out out --set parts[0].unit=inch --set parts[0].scale=1e5", 2, {"box.stl"});
  put("bad.yaml", "parts:\n  - model: box.stl\n    cuont: 4\n");
  expect_failure("generate bad.yaml --out out", 2, {"bad.yaml:3", "did you mean 'count'"});
  put("bad.yaml", "parts: [{model: empty.stl}]\n");
  put("empty.stl", "");
  expect_failure("generate bad.yaml --out out", 2, {"empty.stl"});
  put("open.stl", box_stl(0.04, 10));
  expect_failure("generate request.yaml --out out --set parts[0].model=open.stl", 2, {"open.stl", "open edges"});
  expect_failure("inspect nowhere.stl", 2, {"nowhere.stl"});
  expect_failure("inspect box.stl --unit parsec", 2, {"parsec"});
}

TEST_F(CommandLine, OptionsAreNamedAsTheyWereTyped) {
  expect_failure("generate request.yaml --out out --seconds -1", 2, {"--seconds: 'seconds': must be above 0"});
  expect_failure("generate request.yaml --out out --scenes 0", 2, {"--scenes: "});
  expect_failure("generate request.yaml --out out --seed 1.5", 2, {"--seed: "});
  expect_failure("generate request.yaml --out out --solver fast", 2, {"--solver: "});
}

TEST_F(CommandLine, ABinThatIsAMeshIsMeasuredAgainstItsParts) {
  put("crate.stl", box_stl(80));  // in mm, as the nuts
  put("nut.stl", box_stl(15));
  const std::string bin = "bin: {mesh: crate.stl}\nsolver: {type: bullet}\nparts: [{model: nut.stl, count: 3}]\n";
  put("bad.yaml", bin);
  expect_failure("generate bad.yaml --out out", 2, {"crate.stl: the bin is 80 x 80 x 80 m", "unit: mm"});
  expect_failure("generate bad.yaml --out out --set parts[0].unit=mm", 2, {"crate.stl", "unit: mm"});
  expect_failure("generate bad.yaml --out out --set bin.unit=mm", 2, {"nut.stl: the part is 26 m", "unit: mm"});
}

TEST_F(CommandLine, AnOverfullBinIsTheSameInEveryOutput) {
  const Outcome outcome =
      run("generate request.yaml --out out --formats json,png,bop --set parts[0].count=40 "
          "--set bin.inner_size=[0.1,0.09,0.06] --set accept.escaped=true "
          "--set 'sensors=[{name: top, width: 96, height: 72}]'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json scene = json("out/scene_000000/scene.json");
  std::set<int> there, missing;
  for (const Json& part : scene.at("parts")) {
    EXPECT_EQ(part.at("id"), there.size() + missing.size());
    const bool poured = part.at("state") != "not_poured";
    EXPECT_EQ(part.at("pose").is_null(), !poured) << part;
    (poured ? there : missing).insert(part.at("id").get<int>());
  }
  EXPECT_EQ(scene.at("report").at("not_poured").get<std::set<int>>(), missing);
  ASSERT_FALSE(missing.empty());
  ASSERT_FALSE(there.empty());

  const fs::path bop = "out/bop/train/000000";
  const Json truth = json(bop / "scene_gt.json").at("0");
  std::set<int> told;
  for (std::size_t place = 0; place < truth.size(); ++place) {
    const int id = truth.at(place).at("id");
    told.insert(id);
    if (static_cast<std::size_t>(id) < truth.size()) {
      EXPECT_EQ(place, static_cast<std::size_t>(id));
    }
    for (const char* folder : {"mask", "mask_visib"}) {
      const auto mask = [&](std::size_t number) {
        char name[32];
        std::snprintf(name, sizeof(name), "000000_%06zu.png", number);
        return text(bop / folder / name);
      };
      EXPECT_FALSE(mask(place).empty());
      EXPECT_EQ(mask(place), mask(static_cast<std::size_t>(id))) << "found by its place and by its id";
    }
  }
  EXPECT_EQ(told, there);
  EXPECT_EQ(truth.size(), there.size());

  // A scene to go on from has the parts that are there.
  put("next.yaml",
      "bin: {inner_size: [0.1, 0.09, 0.06]}\nsolver: {type: bullet}\n"
      "pour: {pattern: given, scene: out/scene_000000/scene.json}\nparts: [{model: ./box.stl}]\n");
  EXPECT_LE(run("generate next.yaml --out next --seconds 0.1").code, 1);
  EXPECT_EQ(json("next/scene_000000/scene.json").at("parts").size(),
            there.size() - scene.at("report").at("escaped").size());
}

TEST_F(CommandLine, ASceneInWhichNothingWasPouredIsSetApart) {
  const Outcome outcome = run("generate request.yaml --out out --set bin.inner_size=[0.0401,0.0401,0.2]");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("nothing was poured"), std::string::npos) << outcome.err;
}

TEST_F(CommandLine, MakesScenesQuietlyAndTheSameAgain) {
  const Outcome outcome = run("generate request.yaml --out out --scenes 2");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "");
  const Json scene = json("out/scene_000001/scene.json");
  EXPECT_EQ(scene.at("index"), 1);
  EXPECT_EQ(scene.at("parts").size(), 3u);
  EXPECT_EQ(scene.at("report").at("accepted"), true);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir / "out"), {}), 2);

  // The same scene alone, in another place: byte for byte, apart from wall time.
  EXPECT_EQ(run("generate request.yaml --out alone --first 1").code, 0);
  EXPECT_FALSE(fs::exists(dir / "alone/scene_000000"));
  EXPECT_EQ(lasting("alone/scene_000001/scene.json").dump(), lasting("out/scene_000001/scene.json").dump());
  EXPECT_EQ(run("generate request.yaml --out other --first 1 --seed 4").code, 0);
  EXPECT_NE(json("other/scene_000001/scene.json")["report"]["state_hash"], scene["report"]["state_hash"]);
}

// Threads of llvmpipe are the one thing that a process says for all of its scenes.
TEST_F(CommandLine, ProcessesThatShareAJobMakeTheScenesOfOne) {
  for (const std::string device : {"cpu", "gpu"}) {
    const std::string request =
        "generate request.yaml --solver sphere --set solver.sphere.device=" + device + " --out ";
    EXPECT_EQ(run(request + device + " --scenes 4", "LP_NUM_THREADS=0").code, 0);
    EXPECT_EQ(run(request + device + "_shared --scenes 2", "LP_NUM_THREADS=2").code, 0);
    EXPECT_EQ(run(request + device + "_shared --first 2 --scenes 2", "LP_NUM_THREADS=2").code, 0);
    for (int i = 0; i < 4; ++i) {
      const std::string scene = "/scene_00000" + std::to_string(i) + "/scene.json";
      EXPECT_EQ(lasting(device + "_shared" + scene).dump(), lasting(device + scene).dump()) << device << " " << i;
    }
  }
  EXPECT_NE(json("cpu/scene_000000/scene.json")["report"]["device"],
            json("gpu/scene_000000/scene.json")["report"]["device"]);
}

TEST_F(CommandLine, ScenesThatAreNotAcceptedAreSetApartWithTheirReasons) {
  const Outcome outcome = run("generate request.yaml --out out --set pour.limit=0.26");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("1 of 1 scenes set apart"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("scene_000000: "), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(dir / "out/scene_000000"));
  const Json report = json("out/set_apart/scene_000000/scene.json").at("report");
  EXPECT_EQ(report.at("accepted"), false);
  EXPECT_FALSE(report.at("reasons").empty());
  EXPECT_EQ(run("generate request.yaml --out out --set pour.limit=0.26").code, 1) << "still set apart when resumed";
}

TEST_F(CommandLine, ATraceFollowsFreeFall) {
  put("fall.yaml",
      "bin: {none: true}\nsolver: {type: bullet}\npour: {pattern: given}\nparts:\n"
      "  - {model: box.stl, poses: [[0, 0, 2]], velocities: [[1, 0, 0, 0, 0, 0]]}\n");
  const Outcome outcome = run("generate fall.yaml --out out --seconds 0.5 --trace fall.csv --trace-rate 20");
  EXPECT_LE(outcome.code, 1) << outcome.err;
  std::istringstream lines(text("fall.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz");
  int rows = 0;
  double time = 0;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    double v[15];
    for (double& value : v) ASSERT_TRUE(in >> value) << line;
    time = v[0];
    EXPECT_EQ(v[1], 0.0);
    EXPECT_NEAR(v[2], time, 1e-6);
    EXPECT_NEAR(v[4], 2.0 - 0.5 * 9.81 * time * time, 9.81 * time / 240.0) << "within one step of semi-implicit Euler";
    EXPECT_NEAR(v[11], -9.81 * time, 1e-5);
    ++rows;
  }
  EXPECT_NEAR(time, 0.5, 1e-9);
  EXPECT_GE(rows, 10);
  EXPECT_LE(rows, 12);
}

TEST_F(CommandLine, ATraceIsRefusedBeforeAnythingIsSimulated) {
  fs::create_directories(dir / "folder");
  const std::string endless = " --set pour.limit=1e5 --seconds 1e5";
  expect_failure("generate request.yaml --out out --trace folder" + endless, 3, {"folder", "is a directory"});
  EXPECT_TRUE(fs::is_directory(dir / "folder"));
  expect_failure("generate request.yaml --out out --trace nowhere/t.csv" + endless, 3, {"nowhere/t.csv"});

  EXPECT_EQ(run("generate request.yaml --out kept").code, 0);
  const std::string before = text("kept/scene_000000/scene.json");
  const Outcome other = run("generate request.yaml --out kept --seed 4 --trace t.csv");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("another request"), std::string::npos) << other.err;
  EXPECT_EQ(text("kept/scene_000000/scene.json"), before);
  EXPECT_FALSE(fs::exists(dir / "t.csv"));
  EXPECT_EQ(run("generate request.yaml --out kept --trace t.csv").code, 0) << "the same scene may be traced";
  EXPECT_TRUE(fs::exists(dir / "t.csv"));
}

TEST_F(CommandLine, ABagNeedsNoSensor) {
  const Outcome outcome = run("generate request.yaml --out out --formats bag");
  EXPECT_EQ(outcome.code, with_ros() ? 0 : 3) << outcome.err;
  EXPECT_EQ(fs::exists(dir / "out/scene_000000/scene.bag"), with_ros());
}

TEST_F(CommandLine, AnMcapFileIsMadeAnewForTheOtherRos) {
  expect_failure("generate request.yaml --out out --mcap ros2", 2, {"--mcap", "--formats"});
  expect_failure("generate request.yaml --out out --formats mcap --mcap ros3", 2, {"ros3", "ros1 or ros2"});
  const std::string job = "generate request.yaml --out out --formats mcap";
  if (!with_ros()) return expect_failure(job, 3, {"no ROS", "BIN_SCENES_ROS", "json, pcd, ply, png or bop"});
  const std::string file = "out/scene_000000/scene.mcap";
  const auto profile = [&] { return text(file).substr(21, 4); };  // behind magic, head of the record and length
  EXPECT_EQ(run(job).code, 0);
  EXPECT_EQ(profile(), "ros1");
  EXPECT_NE(run(job).err.find("there already"), std::string::npos);
  EXPECT_EQ(run(job + " --mcap ros2").code, 0);
  EXPECT_EQ(profile(), "ros2");
  EXPECT_NE(run(job + " --mcap ros2").err.find("there already"), std::string::npos);
}

TEST_F(CommandLine, VerboseTellsStagesAndCounters) {
  const Outcome outcome = run("generate request.yaml --out out --verbose");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("scene 0: accepted, 3 parts"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("quality"), std::string::npos) << outcome.out;
}

TEST_F(CommandLine, VerboseTellsWhatTheDefaultSolverWasSparedAndWhatItDid) {
  const char* models = std::getenv("BIN_SCENES_MODELS");
  if (!models) GTEST_SKIP() << "BIN_SCENES_MODELS is not set";
  put("heap.yaml", "bin: {inner_size: [0.16, 0.14, 0.1]}\nparts:\n  - {model: " + std::string(models) +
                       "/channel_u.stl, unit: mm, count: 4}\n");
  put("fall.yaml",
      "bin: {none: true}\npour: {pattern: given}\nparts:\n  - {model: box.stl, count: 2, poses: [[0, 0, 2], [1, 0, "
      "2]]}\n");
  for (const std::string device : {"cpu", "gpu"}) {
    const std::string options = " --solver sphere --set solver.sphere.device=" + device + " --verbose --out " + device;
    std::string told;
    const auto counted = [&](const std::string& name) {
      std::istringstream lines(told);
      std::string line, word;
      while (std::getline(lines, line)) {
        std::istringstream words(line);
        long long count = -1;
        if (words >> word && word == name && words >> count) return count;
      }
      ADD_FAILURE() << device << " does not tell " << name << ":\n" << told;
      return -1LL;
    };
    told = run("generate heap.yaml --seed 3" + options).out;
    for (const char* name : {"body_steps_in_free_fall", "body_steps_asleep", "pairs_culled", "pairs_recycled",
                             "pairs_asleep", "nodes_tested", "contacts", "contacts_reduced"})
      EXPECT_GT(counted(name), 0) << device << " " << name;
    EXPECT_LT(counted("pairs_culled") + counted("pairs_recycled"), counted("pairs"));
    EXPECT_LT(counted("nodes_tested"), counted("nodes_possible"));
    EXPECT_LT(counted("body_steps_in_free_fall") + counted("body_steps_asleep"), 4 * counted("steps"));

    told = run("generate fall.yaml --seconds 0.1" + options + "_fall").out;
    EXPECT_EQ(counted("steps"), 40);
    EXPECT_EQ(counted("body_steps_in_free_fall"), 2 * 40);
    for (const char* name : {"pairs", "nodes_tested", "nodes_possible", "contacts"})
      EXPECT_EQ(counted(name), 0) << name;
  }
}

TEST_F(CommandLine, WritesEveryFormatOfASeenScene) {
  const std::string sensor = " --set 'sensors=[{name: top, width: 64, height: 48}]'";
  const Outcome outcome = run("generate request.yaml --out out --formats json,png,bop" + sensor);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file :
       {"out/scene_000000/top.png", "out/scene_000000/top_depth.png", "out/scene_000000/top_labels.png",
        "out/bop/train/000000/scene_gt.json", "out/bop/train/000000/mask_visib/000000_000002.png",
        "out/bop/train/000000/mask/000000_000002.png", "out/bop/models/obj_000001.ply"}) {
    EXPECT_TRUE(fs::exists(dir / file)) << file;
  }
  EXPECT_EQ(json("out/scene_000000/scene.json").at("sensors").at(0).at("K").size(), 9u);
}

TEST_F(CommandLine, GraspsNameGrippersReasonsAndAnOrder) {
  const std::string asked =
      "generate request.yaml --out out --formats grasps --set 'sensors=[{name: top, width: 64, height: 48}]'";
  expect_failure(asked, 2, {"the request has no grippers", "grippers: [robotiq_2f_85]"});
  const Outcome outcome = run(asked + " --set 'grippers=[cup_10mm, {name: two, stroke: 0.05}]'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json grasps = json("out/scene_000000/grasps.json"), scene = json("out/scene_000000/scene.json");
  EXPECT_EQ(grasps.at("format"), "bin_scenes/grasps/1");
  EXPECT_EQ(grasps.at("removal_order").size(), 3u);
  std::set<std::string> grippers;
  std::size_t free = 0;
  for (const Json& grasp : grasps.at("grasps")) {
    grippers.insert(grasp.at("gripper").get<std::string>());
    EXPECT_EQ(grasp.at("free").get<bool>(), grasp.at("reason") == "");
    EXPECT_EQ(grasp.at("width").get<double>() > 0.0, grasp.at("gripper") == "two");
    EXPECT_GE(grasp.at("score").get<double>(), 0.0);
    EXPECT_LE(grasp.at("score").get<double>(), 1.0);
    // The camera looks down: what is above the floor is nearer than its distance from it.
    const double height = scene.at("sensors").at(0).at("pose").at("position").at(2);
    EXPECT_NEAR(grasp.at("pose_in_camera").at("top").at("position").at(2).get<double>(),
                height - grasp.at("pose").at("position").at(2).get<double>(), 1e-9);
    const double seen = grasp.at("visible").at("top");
    EXPECT_TRUE(seen >= 0.0 && seen <= 1.0);
    free += grasp.at("free").get<bool>();
  }
  EXPECT_EQ(grippers.size(), 2u);
  EXPECT_GT(free, 0u);
  for (const Json& model : grasps.at("models")) EXPECT_GT(model.at("coverage").get<double>(), 0.5);
}

TEST_F(CommandLine, BopRefusesWhatIsNoPinholeBeforeAnythingIsPoured) {
  for (const char* kind : {"distortion: [0.1, 0, 0, 0, 0]", "model: laser_line"}) {
    const std::string sensor = " --set 'sensors=[{name: top, width: 64, height: 48, " + std::string(kind) + "}]'";
    const Outcome outcome = run("generate request.yaml --out out --formats bop" + sensor);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("pinhole"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(dir / "out"));
  }
}

}  // namespace
}  // namespace bin_scenes
