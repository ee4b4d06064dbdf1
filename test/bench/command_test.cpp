/// The real program, as a user calls it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace bin_scenes {
namespace {

namespace fs = std::filesystem;

class BenchCommand : public ::testing::Test {
 protected:
  BenchCommand() { fs::create_directories(dir_); }
  ~BenchCommand() override { fs::remove_all(dir_); }

  struct Outcome {
    int code;
    std::string out, err;
  };
  Outcome run(const std::string& arguments, const std::string& program = BIN_SCENES_BENCH) const {
    const std::string command =
        "cd '" + dir_.string() + "' && '" + program + "' " + arguments + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text("out.txt"), text("err.txt")};
  }
  std::string text(const std::string& name) const {
    std::ifstream file(dir_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void put(const std::string& name, const std::string& content) const {
    fs::create_directories((dir_ / name).parent_path());
    std::ofstream(dir_ / name) << content;
  }

  const fs::path dir_ = fs::temp_directory_path() / ("bin_scenes_bench_test_" + std::to_string(::getpid()));
};

TEST_F(BenchCommand, ListsWhatThereIs) {
  const Outcome all = run("--list");
  EXPECT_EQ(all.code, 0) << all.err;
  EXPECT_NE(all.out.find("preparation "), std::string::npos) << all.out;
  const Outcome some = run("--list --filter 'prep*'");
  EXPECT_EQ(some.out.rfind("preparation ", 0), 0u) << some.out;
}

TEST_F(BenchCommand, SuggestsTheNearestName) {
  const Outcome outcome = run("--filter preparaton");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("preparaton"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'preparation'?"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(dir_ / "bench_results"));
}

TEST_F(BenchCommand, ANameThatIsNoneIsToldAndTheRestRuns) {
  const Outcome outcome = run("--filter preparaton,light --quick --rows bounces=0");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'preparation'?"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("light:  matte, albedo 0.9  16  0  analytic"), std::string::npos) << outcome.out;
  const Outcome names = run("--list --filter nosuch,light");
  EXPECT_EQ(names.code, 2);
  EXPECT_EQ(names.out.rfind("light ", 0), 0u) << names.out;
}

TEST_F(BenchCommand, UnwritableFolderIsOneClearMessage) {
  put("file", "");
  const Outcome outcome = run("--filter preparation --quick --out file/results");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("file/results"), std::string::npos) << outcome.err;
}

TEST_F(BenchCommand, RowsByAKeyThatIsNoneAreRefusedBeforeAnythingRuns) {
  const Outcome outcome = run("--filter goals,scenes --rows sovler=bullet");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("rows of goals have no key 'sovler'"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'solver'?"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(dir_ / "bench_results"));
}

TEST_F(BenchCommand, RowsOfAnEarlierRunStayUnlessMeasuredAnew) {
  put("out/light.csv",
      "# benchmark: light\n# roles: key key key key exact\nsurface,period_px,bounces,fidelity,rms_mm\n"
      "\"matte, albedo 0.9\",16,0,analytic,7\nmirror,16,0,analytic,7\n");
  const Outcome outcome = run("--filter light --quick --rows bounces=0 --out out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string csv = text("out/light.csv");
  EXPECT_NE(csv.find("mirror,16,0,analytic,7"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("\"matte, albedo 0.9\",16,0,analytic,7,"), std::string::npos) << csv;
}

TEST_F(BenchCommand, RowsThatNoBenchmarkHasAreAnError) {
  for (const std::string benchmark : {"goals", "simbenchmark", "preparation"}) {
    const Outcome outcome = run("--out results --rows solver=nosuch --filter " + benchmark);
    EXPECT_EQ(outcome.code, 2) << benchmark;
    EXPECT_NE(outcome.err.find("no row is like this"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(dir_ / "results" / (benchmark + ".csv")));
  }
}

TEST_F(BenchCommand, StressRefusesWhatItDoesNotKnow) {
  for (const std::string arguments :
       {"--solver nosuch", "--filter nosuch", "--sovler sphere", "--filter mass/1:10 --solver x"}) {
    const Outcome outcome = run(arguments, BIN_SCENES_STRESS);
    EXPECT_EQ(outcome.code, 2) << arguments << outcome.out;
    EXPECT_EQ(outcome.err.rfind("bin_scenes_stress: ", 0), 0u) << outcome.err;
  }
  const Outcome outcome = run("--filter stack/ --solver nosuch", BIN_SCENES_STRESS);
  EXPECT_NE(outcome.err.find("nosuch"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace bin_scenes
