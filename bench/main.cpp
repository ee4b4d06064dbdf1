/// bin_scenes_bench: run time against error. Needs no ROS.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/freed_memory.hpp"
#include "framework/benchmark.hpp"
#include "framework/host.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace {

using namespace bin_scenes;
using namespace bin_scenes::bench;

constexpr int exit_done = 0, benchmark_failed = 1;

int complain(const std::string& message, ErrorKind kind) {
  std::cerr << "bin_scenes_bench: " << message << std::endl;
  return static_cast<int>(kind);
}

int run_all(const std::vector<Benchmark>& chosen, Run::Options options, const std::string& arguments) {
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  if (failed) throw environment_error(failed.message(), options.out, "give a folder that can be written with --out");
  bool good = true, any = false;
  for (const Benchmark& benchmark : chosen) {
    const std::string command = "bin_scenes_bench --filter " + benchmark.name + arguments;
    const Ended ended = run(benchmark, options, command);
    good &= ended != Ended::failed;
    any |= ended != Ended::nothing_wanted;
  }
  if (!any)
    throw input_error("no row is like this", "--rows", "see the table in " + options.out + ", or leave --rows out");
  std::printf("results: %s\n", options.out.c_str());
  return good ? exit_done : benchmark_failed;
}

int main_of(int argc, char** argv) {
  CLI::App app("Run time against error, measured. Results are CSV files; bench/publish shows them.");
  bool list_only = false;
  std::vector<std::string> filter;
  std::string results = "bench_results";
  Run::Options options;
  app.add_flag("--list", list_only, "the benchmarks that there are, or that --filter chooses");
  app.add_option("--filter", filter, "names or glob patterns of benchmarks; default: all")->delimiter(',');
  app.add_option("--rows", options.rows, "key=glob: only rows like this (solver=sphere)")
      ->check([](const std::string& filter) {
        return filter.find('=') == std::string::npos ? "expected key=glob, found '" + filter + "'" : std::string();
      });
  app.add_option("--results", results, "the results go to RESULTS/<device>")->capture_default_str();
  app.add_option("--out", options.out, "folder of the results, instead of RESULTS/<device>");
  app.add_flag("--quick", options.quick, "small forms of all: minutes instead of hours, figures to look at only");

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return complain(std::string(error.what()) + " (see bin_scenes_bench --help)", ErrorKind::input);
  }
  const Selection chosen = selected(benchmarks(), filter);
  int code = exit_done;
  for (const Error& unknown : chosen.unknown) code = complain(unknown.what(), unknown.kind());  // the rest is run
  for (const Benchmark& one : chosen.benchmarks)
    if (list_only) std::printf("%-18s %s\n", one.name.c_str(), one.about.c_str());
  if (list_only || chosen.benchmarks.empty()) return code;
  check_rows(chosen.benchmarks, options.rows);
  if (options.out.empty()) options.out = results + "/" + device_slug();
  return std::max(code, run_all(chosen.benchmarks, options, options.quick ? " --quick" : ""));
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  try {
    return main_of(argc, argv);
  } catch (const Error& error) {
    return complain(error.what(), error.kind());
  } catch (const std::exception& error) {
    return complain(std::string("unexpected: ") + error.what(), ErrorKind::environment);
  }
}
