/// Jobs that stop half-way, on a full disk or killed, and those that go on where an earlier one stopped.
#include "tool/command_line_fixture.hpp"

namespace bin_scenes {
namespace {

TEST_F(CommandLine, AnEnvironmentThatDoesNotDoEndsWithCodeThree) {
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

}  // namespace
}  // namespace bin_scenes
