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
  const Outcome outcome = run("--filter preparaton,shape_errors --quick --rows proxy=field");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("did you mean 'preparation'?"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("shape_errors:  bolt_hex  field  sphere"), std::string::npos) << outcome.out;
  const Outcome names = run("--list --filter nosuch,shape_errors");
  EXPECT_EQ(names.code, 2);
  EXPECT_EQ(names.out.rfind("shape_errors ", 0), 0u) << names.out;
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
  put("out/shape_errors.csv",
      "# benchmark: shape_errors\n# roles: key key key exact\npart,proxy,solver,count\n"
      "bolt_hex,field,sphere,1\nbolt_hex,an older proxy,ode,7\n");
  const Outcome outcome = run("--filter shape_errors --quick --rows proxy=field --out out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string csv = text("out/shape_errors.csv");
  EXPECT_NE(csv.find("bolt_hex,an older proxy,ode,7"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("bolt_hex,field,sphere,1,"), std::string::npos) << csv;
}

TEST_F(BenchCommand, RowsThatNoBenchmarkHasAreAnError) {
  for (const std::string benchmark : {"goals", "simbenchmark", "shape_errors"}) {
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

TEST_F(BenchCommand, ComparesTwoFolders) {
  const std::string head = "# benchmark: scenes\n# roles: key measure spread\npart,time_s,time_s_spread\n";
  put("a/scenes.csv", head + "ring,1,0.1\ntee,2,0.1\n");
  put("b/scenes.csv", head + "ring,1.05,0.1\ntee,3,0.1\n");
  const Outcome moved = run("compare a b");
  EXPECT_EQ(moved.code, 1) << moved.err;
  EXPECT_NE(moved.out.find("moved: scenes: part=tee: time_s"), std::string::npos) << moved.out;
  EXPECT_EQ(moved.out.find("part=ring"), std::string::npos) << moved.out;
  EXPECT_EQ(run("compare a a").code, 0);
  const Outcome missing = run("compare a c");
  EXPECT_EQ(missing.code, 2);
  EXPECT_NE(missing.err.find("neither a file nor a folder"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace bin_scenes
