/// Commands that pour nothing: inspect, symmetries, sensor, doctor, reference.
#include "tool/command_line_fixture.hpp"

#include <cmath>
#include <functional>
#include <regex>

namespace bin_scenes {
namespace {

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
  const std::string as_text = run("inspect box.stl").out;
  EXPECT_NE(as_text.find("\nwatertight             yes "), std::string::npos) << as_text;
  const std::function<void(const Json&)> expect_keys = [&](const Json& section) {
    for (const auto& [key, value] : section.items()) {
      if (value.is_object()) expect_keys(value);
      EXPECT_TRUE(std::regex_search(as_text, std::regex("(^|\n) *" + key + " ")) || value.empty()) << key;
    }
  };
  expect_keys(report);  // one table is printed in both forms
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
  EXPECT_NE(text_of_open.find("the surface is not closed"), std::string::npos) << text_of_open;
  put("n\xff.stl", box_stl(0.04));
  EXPECT_EQ(Json::parse(run("inspect n\xff.stl --json").out).at("model"), "n\xef\xbf\xbd.stl") << "no UTF-8";
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
  put("blind.yaml", text("sensor.yaml") + "structured_light: {min_modulation: 0.99}\n");
  const std::string blind = run("sensor blind.yaml").out;
  EXPECT_NE(blind.find("sphere spacing error         unseen\n"), std::string::npos) << blind;
  EXPECT_NE(blind.find("dimension trueness           unseen\n"), std::string::npos) << blind;
  EXPECT_EQ(blind.find("nan"), std::string::npos) << blind;
}

}  // namespace
}  // namespace bin_scenes
