/// The real binary, as a user calls it: exit code, messages, and what it leaves in files.
#include "box_mesh.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class CommandLine : public ::testing::Test {
 protected:
  CommandLine() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir = fs::temp_directory_path() / ("bin_scenes_tool_" + std::to_string(::getpid()) + info->name());
    fs::create_directories(dir);
    put("box.stl", box_stl(0.04));
    put("request.yaml",
        "seed: 3\nbin: {inner_size: [0.2, 0.2, 0.2]}\nsolver: {type: bullet}\nparts:\n"
        "  - {model: box.stl, count: 3}\n");
  }
  ~CommandLine() override { fs::remove_all(dir); }

  void put(const std::string& name, const std::string& content) { std::ofstream(dir / name) << content; }
  std::string text(const fs::path& name) const {
    std::ifstream file(dir / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Json json(const fs::path& name) const { return Json::parse(text(name)); }

  struct Outcome {
    int code;
    std::string out, err;
  };
  /// `before`: shell words in front of the command.
  Outcome run(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + dir.string() + "' && " + before + " '" BIN_SCENES_TOOL "' " + arguments +
                                " >stdout.txt 2>stderr.txt </dev/null";
    const int status = std::system(("bash -c \"" + command + "\"").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("stdout.txt"), text("stderr.txt")};
  }

  /// Whether the tool was built with ROS.
  bool with_ros() const { return run("doctor").out.find("ros       ok") != std::string::npos; }

  /// Fails with the code, one line on standard error that holds the words, and no output directory.
  void expect_failure(const std::string& arguments, int code, const std::vector<std::string>& words,
                      const std::string& before = "") {
    const Outcome outcome = run(arguments, before);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.err.compare(0, 12, "bin_scenes: "), 0) << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << "'" << word << "' is not in: " << outcome.err;
    }
    EXPECT_FALSE(fs::exists(dir / "out")) << arguments;
  }

  /// scene.json without what wall time decides.
  Json lasting(const fs::path& name) const {
    Json scene = json(name);
    for (const char* key : {"wall_s", "stages_ms", "counters"}) scene["report"].erase(key);
    return scene;
  }

  fs::path dir;
};

TEST_F(CommandLine, BadRequestsEndWithCodeTwoAndNothingWritten) {
  expect_failure("", 2, {"--help"});
  expect_failure("generate request.yaml", 2, {"--out"});
  expect_failure("generate request.yaml --out out --colour red", 2, {"--colour"});
  expect_failure("generate nowhere.yaml --out out", 2, {"nowhere.yaml"});
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

TEST_F(CommandLine, NewWritesARequestWithABinThatItsHeapFills) {
  put("part.stl", box_stl(30));  // no unit makes sense but mm: 52 mm
  const Outcome made = run("new part.stl --count 60 --out first.yaml");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(std::count(made.out.begin(), made.out.end(), '\n'), 1) << made.out;
  EXPECT_NE(made.out.find("first.yaml: 60 of 60 parts in a bin of"), std::string::npos) << made.out;
  EXPECT_NE(text("first.yaml").find("unit: mm "), std::string::npos) << text("first.yaml");
  const Json scene = json("first/scene_000000/scene.json");
  EXPECT_TRUE(fs::exists(dir / "first/scene_000000/camera.png"));
  double top = 0.0;  // of the centres
  for (const Json& part : scene["parts"]) top = std::max(top, part["pose"]["position"][2].get<double>());
  const Json& size = scene["bin"]["inner_size"];
  const double volume = size[0].get<double>() * size[1].get<double>() * size[2].get<double>();
  EXPECT_GT(60 * 27e-6 / volume, 0.15);  // a quarter of the bin is steel; a bin that cubes fill to the rim has 0.6
  EXPECT_LT(60 * 27e-6 / volume, 0.45);
  EXPECT_GT(top, 0.3 * size[2].get<double>());
  EXPECT_LT(top, size[2].get<double>());
  EXPECT_EQ(scene["report"]["not_poured"].size(), 0u);
  // What it wrote is a request like any other, also from another folder.
  EXPECT_EQ(run("generate first.yaml --out again").code, 0);
  EXPECT_EQ(json("again/scene_000000/scene.json")["report"]["state_hash"], scene["report"]["state_hash"]);
}

TEST_F(CommandLine, NewMakesRoomForPinsThatLean) {
  put("pin.stl", box_stl(Vec3(2, 2, 60)));
  const Outcome made = run("new pin.stl --count 30 --out pins.yaml");
  EXPECT_EQ(made.code, 0) << made.out << made.err;
  double rim = 0.0, top = 0.0;
  const std::size_t at = made.out.find("bin of ");
  ASSERT_NE(at, std::string::npos) << made.out;
  ASSERT_EQ(std::sscanf(made.out.c_str() + at, "bin of %*f x %*f x %lf m, heap %lf m high", &rim, &top), 2) << made.out;
  EXPECT_LT(top, rim) << made.out;
}

TEST_F(CommandLine, NewSaysHowTheUnitWasChosenAndRefusesWhatFitsNoBin) {
  const auto unit_of = [&](double edge, const std::string& options) {
    put("part.stl", box_stl(edge));
    fs::remove(dir / "out.yaml");
    const Outcome made = run("new part.stl --no-pour --out out.yaml " + options);
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_FALSE(fs::exists(dir / "out"));
    const std::string request = text("out.yaml");
    const std::size_t at = request.find("unit: ");
    return request.substr(at, request.find('\n', at) - at);
  };
  EXPECT_EQ(unit_of(0.04, "").substr(0, 8), "unit: m ");
  EXPECT_EQ(unit_of(40, "").substr(0, 8), "unit: mm");
  EXPECT_NE(unit_of(8, "").find("inch makes it 0.352"), std::string::npos);  // 13.9 mm, or 13.9 inch
  EXPECT_NE(unit_of(1.5, "--unit inch").find("as --unit says"), std::string::npos);
  fs::remove(dir / "out.yaml");
  const std::vector<std::pair<double, std::string>> unclear = {
      {1.5, "--unit inch makes it 0.06599 m, cm"}, {500.0, "--unit mm makes it 0.866 m"}, {3000.0, "scale the model"}};
  for (const auto& [edge, remedy] : unclear) {
    put("part.stl", box_stl(edge));
    expect_failure("new part.stl --out out.yaml", 2, {"part.stl", remedy});
    EXPECT_FALSE(fs::exists(dir / "out.yaml"));
  }
  put("part.stl", box_stl(40));
  expect_failure("new part.stl --out out.yaml --unit m", 2, {"as --unit says", "mm makes it 0.06928 m"});
}

TEST_F(CommandLine, NewRefusesBadInputAndOverwritesNothing) {
  expect_failure("new", 2, {"PART"});
  expect_failure("new box.stl", 2, {"request.yaml", "--overwrite"});  // the default of --out
  const auto refused = [&](const std::string& arguments, const std::vector<std::string>& words) {
    expect_failure("new --out new.yaml " + arguments, 2, words);
    EXPECT_FALSE(fs::exists(dir / "new.yaml")) << arguments;
  };
  refused("nowhere.stl", {"nowhere.stl"});
  refused("box.stl --count 0", {"--count"});
  refused("box.stl --sensor structured_light_0.7m_750m", {"did you mean 'structured_light_0.7m_750mm'"});
  refused("box.stl --unit parsec", {"parsec", "mm"});
  put("open.stl", box_stl(0.04, 10));
  refused("open.stl", {"open.stl", "--thickness"});
  expect_failure("new box.stl --out none/new.yaml", 2, {"none"});
  expect_failure("new box.stl --out new", 2, {".yaml"});
  EXPECT_EQ(run("new open.stl --out new.yaml --thickness 0.002 --no-pour").code, 0);
  EXPECT_NE(text("new.yaml").find("thickness: 0.002"), std::string::npos);
}

TEST_F(CommandLine, NewSaysWhatASensorCannotSee) {
  const Outcome near = run("new box.stl --sensor laser_line_0.5m_350mm --count 3 --out near.yaml --no-pour");
  EXPECT_EQ(near.err, "");
  EXPECT_EQ(text("near.yaml").find("pose:"), std::string::npos);
  const Outcome wide = run("new box.stl --sensor laser_line_0.5m_350mm --count 20000 --out wide.yaml --no-pour");
  EXPECT_EQ(wide.code, 0);
  EXPECT_NE(wide.err.find("note: the bin is larger"), std::string::npos) << wide.err;
  EXPECT_NE(text("wide.yaml").find("pose: [0, 0, 0.686, 1, 0, 0, 0]"), std::string::npos) << text("wide.yaml");
}

TEST_F(CommandLine, AnEnvironmentThatDoesNotDoEndsWithCodeThree) {
  put("file", "");
  expect_failure("generate request.yaml --out file/deeper", 3, {"not a directory"});
  // Files that may not grow stand for a disk that is full.
  const Outcome full = run("generate request.yaml --out out", "trap '' XFSZ; ulimit -f 0;");
  EXPECT_EQ(full.code, 3);
  EXPECT_FALSE(fs::exists(dir / "out/scene_000000"));
  std::size_t left = 0;
  if (fs::exists(dir / "out")) left = static_cast<std::size_t>(std::distance(fs::directory_iterator(dir / "out"), {}));
  EXPECT_EQ(left, 0u);
}

TEST_F(CommandLine, AFullDiskEndsEveryFormatWithOneMessageAndNothingHalfWritten) {
  std::vector<std::string> formats = {"pcd", "ply", "png", "bop"};
  if (with_ros()) formats.insert(formats.end(), {"bag", "mcap"});
  for (const std::string& format : formats) {
    const Outcome full = run("generate request.yaml --out " + format + " --formats " + format +
                                 " --set 'sensors=[{name: top, width: 64, height: 48}]'",
                             "trap '' XFSZ; ulimit -f 1;");
    EXPECT_EQ(full.code, 3) << format << ": " << full.err;
    EXPECT_EQ(std::count(full.err.begin(), full.err.end(), '\n'), 1) << full.err;
    EXPECT_NE(full.err.find(format + "/"), std::string::npos) << full.err;
    EXPECT_EQ(full.err.find("tmp-"), std::string::npos) << "a path that no user knows: " << full.err;
    if (!fs::exists(dir / format)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(dir / format)) {
      EXPECT_EQ(entry.path().filename().string().find("tmp"), std::string::npos) << entry;
      EXPECT_NE(entry.path().filename(), "scene_000000");
    }
  }
}

TEST_F(CommandLine, OnAFullDiskNoSceneIsThereWithoutTheOtherHalf) {
  // KiB a file: at first nothing fits, then some files of the scene, of its BOP data, or of both.
  std::size_t failed = 0;
  for (const std::string blocks : {"1", "4", "6", "8", "12"}) {
    const Outcome full = run("generate request.yaml --out out --formats json,bop --set parts[0].count=12" +
                                 std::string(" --set 'sensors=[{name: top, width: 96, height: 72}]'"),
                             "trap '' XFSZ; ulimit -f " + blocks + ";");
    if (full.code == 0) break;
    ++failed;
    EXPECT_EQ(full.code, 3) << full.err;
    EXPECT_FALSE(fs::exists(dir / "out")) << blocks << ": not even empty directories";
  }
  EXPECT_GT(failed, 0u);
}

TEST_F(CommandLine, WhatAnEarlierSceneLeftOnTheOtherSideGoes) {
  const std::string formats = " --formats json,bop --overwrite --set 'sensors=[{name: top, width: 64, height: 48}]'";
  const std::string moving = " --set pour.limit=0.26";
  EXPECT_EQ(run("generate request.yaml --out out" + formats).code, 0);
  EXPECT_TRUE(fs::exists(dir / "out/bop/train/000000"));
  EXPECT_EQ(run("generate request.yaml --out out" + moving + formats).code, 1);
  EXPECT_TRUE(fs::exists(dir / "out/set_apart/bop/train/000000"));
  EXPECT_FALSE(fs::exists(dir / "out/scene_000000"));
  EXPECT_FALSE(fs::exists(dir / "out/bop/train/000000")) << "of a scene that is gone";
  EXPECT_EQ(run("generate request.yaml --out out" + formats).code, 0);
  EXPECT_FALSE(fs::exists(dir / "out/set_apart/bop/train/000000"));
  EXPECT_FALSE(fs::exists(dir / "out/set_apart/scene_000000"));
  EXPECT_EQ(run("generate request.yaml --out out --seed 4 --overwrite").code, 0);
  EXPECT_FALSE(fs::exists(dir / "out/bop/train/000000")) << "of another request";
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

TEST_F(CommandLine, GoesOnWhereAnEarlierRunStopped) {
  EXPECT_EQ(run("generate request.yaml --out out --first 1").code, 0);
  const auto time = fs::last_write_time(dir / "out/scene_000001/scene.json");
  const Outcome resumed = run("generate request.yaml --out out --scenes 3");
  EXPECT_EQ(resumed.code, 0);
  EXPECT_NE(resumed.err.find("1 of 3 scenes are there already"), std::string::npos) << resumed.err;
  EXPECT_EQ(fs::last_write_time(dir / "out/scene_000001/scene.json"), time);
  EXPECT_TRUE(fs::exists(dir / "out/scene_000000/scene.json"));
  EXPECT_TRUE(fs::exists(dir / "out/scene_000002/scene.json"));

  const Outcome mixed = run("generate request.yaml --out out --first 1 --seed 4");
  EXPECT_EQ(mixed.code, 2);
  EXPECT_NE(mixed.err.find("another request"), std::string::npos) << mixed.err;
  EXPECT_EQ(run("generate request.yaml --out out --first 1 --seed 4 --overwrite").code, 0);
  EXPECT_EQ(json("out/scene_000001/scene.json").at("seed"), 4);

  fs::resize_file(dir / "out/scene_000001/scene.json", 200);
  fs::remove(dir / "out/scene_000001/files.json");
  const Outcome cut = run("generate request.yaml --out out --first 1 --seed 4");
  EXPECT_EQ(cut.code, 2);
  EXPECT_NE(cut.err.find("out/scene_000001: scene.json is there already, but it is cut off"), std::string::npos)
      << cut.err;
}

TEST_F(CommandLine, AFileThatIsNotWholeIsNoScene) {
  const std::string job =
      "generate request.yaml --out out --formats json,png,bop --scenes 2 "
      "--set 'sensors=[{name: top, width: 64, height: 48}]'";
  ASSERT_EQ(run(job).code, 0);
  const fs::path scene = "out/scene_000000", bop = "out/bop/train/000000";
  const auto kept = [&](const std::string& more = "") {
    const Outcome again = run(job + more);
    EXPECT_EQ(again.code, 0) << again.err;
    const std::size_t of = again.err.find(" of 2 scenes are there");
    return of == std::string::npos ? std::string("0") : again.err.substr(of - 1, 1);
  };
  EXPECT_EQ(kept(), "2");
  for (const fs::path& name : {scene / "top_depth.png", scene / "scene.json", bop / "scene_gt.json", bop / "mask"}) {
    const fs::path file = fs::is_directory(dir / name) ? name / "000000_000000.png" : name;
    const std::string whole = text(file);
    fs::resize_file(dir / file, 0);  // as a file system leaves it after a loss of power
    EXPECT_EQ(kept(), "1") << file;
    EXPECT_GT(text(file).size(), whole.size() / 2) << file;  // wall times in scene.json differ
    EXPECT_EQ(kept(), "2") << file;
  }
  fs::remove(dir / scene / "files.json");
  EXPECT_EQ(kept(), "1") << "of a run that was killed, or of an earlier version";

  // A changed byte has the same size: it is found by those who ask for it.
  std::string changed = text(scene / "top_depth.png");
  changed[changed.size() / 2] ^= 1;
  put((scene / "top_depth.png").string(), changed);
  EXPECT_EQ(kept(), "2");
  EXPECT_EQ(kept(" --verify"), "1");
  EXPECT_EQ(kept(" --verify"), "2");
}

TEST_F(CommandLine, WhatAKilledRunLeftIsRemovedByTheNext) {
  ASSERT_EQ(run("generate request.yaml --out out").code, 0);
  const int status = std::system(("bash -c 'echo $$ > " + (dir / "pid").string() + "'").c_str());
  ASSERT_EQ(status, 0);
  std::string pid = text("pid");
  pid.pop_back();
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const fs::path mine = dir / "out" / (".scene_000001.tmp-" + pid + "-0@" + host);
  const fs::path theirs = dir / "out" / (".scene_000001.tmp-" + pid + "-0@elsewhere");
  fs::create_directories(mine / "half");
  fs::create_directories(theirs);
  EXPECT_EQ(run("generate request.yaml --out out").code, 0);
  EXPECT_FALSE(fs::exists(mine));
  EXPECT_TRUE(fs::exists(theirs)) << "of another host, which may still write it";
}

TEST_F(CommandLine, AJobOfAnyLengthStartsAtOnce) {
  EXPECT_EQ(run("generate request.yaml --out out --first 1000000").code, 0);
  fs::create_directories(dir / "out/scene_notes");
  const Outcome resumed = run("generate request.yaml --out out --first 999999 --scenes 2");
  EXPECT_NE(resumed.err.find("1 of 2 scenes are there already"), std::string::npos) << resumed.err;
  // To look for each of these on disk takes half an hour; the first one that is written ends the job, on a full disk.
  const Outcome long_job =
      run("generate request.yaml --out out --scenes 1000000000", "trap '' XFSZ; ulimit -f 0; timeout 100");
  EXPECT_EQ(long_job.code, 3);
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

TEST_F(CommandLine, SymmetriesOfAPartAreListedAsBopHasThem) {
  const Outcome outcome = run("symmetries box.stl --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json report = Json::parse(outcome.out);
  EXPECT_EQ(report.at("models_info").at("symmetries_discrete").size(), 23u) << "a cube's, without the identity";
  EXPECT_EQ(report.at("residuals_discrete_mm").size(), 23u);
  EXPECT_NEAR(report.at("models_info").at("diameter").get<double>(), 40.0 * std::sqrt(3.0), 1e-3);
  EXPECT_NE(run("symmetries box.stl").out.find("24 poses look alike"), std::string::npos);
  EXPECT_EQ(run("symmetries box.stl --tolerance 0").code, 2);
  EXPECT_EQ(run("symmetries box.stl --picture box.png").code, 0);
  EXPECT_EQ(text("box.png").substr(1, 3), "PNG");
  EXPECT_EQ(run("symmetries box.stl --picture nowhere/box.png").code, 3);
  EXPECT_EQ(Json::parse(run("inspect box.stl --json").out).at("symmetries").at("discrete"), 23);
  EXPECT_EQ(run("symmetries nowhere.stl").code, 2);
}

TEST_F(CommandLine, InspectMeasuresAModel) {
  const Outcome outcome = run("inspect box.stl --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json report = Json::parse(outcome.out);
  EXPECT_EQ(report.at("watertight"), true);
  EXPECT_NEAR(report.at("mass_properties").at("volume").get<double>(), 0.04 * 0.04 * 0.04, 1e-9);
  EXPECT_EQ(report.at("proxies").at("hulls").at("count"), 1);
  EXPECT_GT(report.at("proxies").at("spheres").at("count").get<int>(), 100);
  EXPECT_NEAR(Json::parse(run("inspect box.stl --json --unit mm").out).at("size").at(0).get<double>(), 4e-5, 1e-9);
  EXPECT_NE(run("inspect box.stl").out.find("watertight  yes"), std::string::npos);
  EXPECT_EQ(run("inspect box.stl --hulls hulls.obj").code, 0);
  const Json hull = Json::parse(run("inspect hulls.obj --json --unit m").out);
  EXPECT_EQ(hull.at("watertight"), true);
  EXPECT_NEAR(hull.at("mass_properties").at("volume").get<double>(), 0.04 * 0.04 * 0.04, 1e-9);
  put("open.stl", box_stl(0.04, 10));
  expect_failure("inspect open.stl --hulls open.obj", 2, {"open.stl", "4 open edges"});
  EXPECT_FALSE(fs::exists(dir / "open.obj"));
  expect_failure("inspect box.stl --hulls nowhere/hulls.obj", 3, {"nowhere/hulls.obj"});
  const Outcome open = run("inspect open.stl --json");
  EXPECT_EQ(open.code, 0) << open.err;
  EXPECT_EQ(Json::parse(open.out).at("watertight"), false);
  EXPECT_EQ(Json::parse(open.out).at("open_edges"), 4);
  EXPECT_EQ(Json::parse(open.out).at("file").at("flags").at(0).at("code"), "surface_open");
  const std::string text_of_open = run("inspect open.stl").out;
  EXPECT_NE(text_of_open.find("flag        the surface is not closed"), std::string::npos) << text_of_open;
}

TEST_F(CommandLine, DoctorTestsEachSolverAndReferenceIsTheDocument) {
  const Outcome outcome = run("doctor");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  for (const char* solver : {"bullet", "sphere", "sphere/thesis"}) {
    EXPECT_NE(outcome.out.find("solver    ok   " + std::string(solver) + ": box at rest"), std::string::npos)
        << outcome.out;
  }
  EXPECT_NE(outcome.out.find("ros "), std::string::npos) << outcome.out;
  std::ifstream file(std::string(BIN_SCENES_DOCS) + "/use/request.md");
  EXPECT_EQ(run("reference").out, std::string(std::istreambuf_iterator<char>(file), {}));
}

TEST_F(CommandLine, ASensorIsMeasuredBeforeAnyScene) {
  put("sensor.yaml", "model: structured_light\nwidth: 160\nheight: 120\nfov: 0.4\nnear: 0.7\nfar: 1.4\n");
  const Outcome outcome = run("sensor sensor.yaml --json --plot noise.svg");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json j = Json::parse(outcome.out);
  EXPECT_EQ(j["model"], "structured_light");
  EXPECT_EQ(j["predicted_sigma"].size(), 48u);  // 3 distances, 4 incidences, 4 albedos
  EXPECT_GT(j["temporal_noise"].get<double>(), 1e-6);
  EXPECT_LT(j["temporal_noise"].get<double>(), 1e-3);
  EXPECT_EQ(j["probing_error_form"].size(), 7u);
  EXPECT_NE(text("noise.svg").find("</svg>"), std::string::npos);
  expect_failure("sensor structured_lihgt_0.7m_750mm", 2, {"structured_light_0.7m_750mm"});
}

}  // namespace
}  // namespace bin_scenes
