/// `bin_scenes new`: a first request for a part.
#include "tool/command_line_fixture.hpp"

namespace bin_scenes {
namespace {

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

TEST_F(CommandLine, NewMakesFoldersAndNamesPathsAsTheyAre) {
  put("part.stl", box_stl(30));
  EXPECT_EQ(run("new part.stl --no-pour --out near/by/first.yaml").code, 0);
  EXPECT_NE(text("near/by/first.yaml").find("model: ../../part.stl"), std::string::npos);
  EXPECT_NE(text("near/by/first.yaml").find("# relative to this file"), std::string::npos);
  EXPECT_EQ(run("new part.stl --no-pour --out far/a/b/c/d/first.yaml").code, 0);
  EXPECT_NE(text("far/a/b/c/d/first.yaml").find("model: /"), std::string::npos);
  EXPECT_EQ(text("far/a/b/c/d/first.yaml").find("relative to this file"), std::string::npos);
  const Outcome refused = run("new part.stl --no-pour --out part.stl/first.yaml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("part.stl' is no folder"), std::string::npos) << refused.err;
  EXPECT_EQ(run("new nothing.stl --no-pour --out not/made/first.yaml").code, 2);
  EXPECT_FALSE(fs::exists(dir / "not"));  // nothing is left of what failed
}

TEST_F(CommandLine, NewMakesRoomForPinsAndSheetsThatLean) {
  struct Case {
    Vec3 size;  // mm
    const char* count;
    bool may_be_set_apart;  // sheets that are pressed may lift the heap by more than accept.worst_energy_gain
  };
  for (const auto& [size, count, may_be_set_apart] :
       {Case{Vec3(2, 2, 60), "30", false}, Case{Vec3(40, 30, 1), "60", true}}) {
    put("part.stl", box_stl(size));
    const Outcome made = run(std::string("new part.stl --unit mm --out parts.yaml --overwrite --count ") + count);
    const bool set_apart_for_energy =
        may_be_set_apart && made.code == 1 && made.err.find("accept.worst_energy_gain") != std::string::npos;
    EXPECT_TRUE(made.code == 0 || set_apart_for_energy) << made.out << made.err;
    EXPECT_NE(made.out.find(std::string(count) + " of " + count + " parts"), std::string::npos) << made.out;
    double rim = 0.0, top = 0.0;
    const std::size_t at = made.out.find("bin of ");
    ASSERT_NE(at, std::string::npos) << made.out;
    ASSERT_EQ(std::sscanf(made.out.c_str() + at, "bin of %*f x %*f x %lf m, heap %lf m high", &rim, &top), 2)
        << made.out;
    EXPECT_LT(top, rim) << made.out;
  }
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
  put("n\xff.stl", box_stl(0.04));
  refused("n\xff.stl --count 3", {"n\\xff.stl", "no UTF-8", "rename"});
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

}  // namespace
}  // namespace bin_scenes
