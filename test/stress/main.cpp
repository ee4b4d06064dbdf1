/// bin_scenes_stress: does a scene survive what is asked of it? Counts survived / tried per row.
#include "stress/table.hpp"

#include "bin_scenes/core/error.hpp"
#include "framework/host.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace {

using namespace bin_scenes;
using namespace bin_scenes::stress;
namespace fs = std::filesystem;

std::vector<Row> all_rows(bool soak) {
  std::vector<Row> rows;
  for (const auto theme : {mass_ratios, stacks, time_steps, sizes, overlaps, speeds, thin_parts, materials, bins,
                           numbers, random_requests})
    for (Row& row : theme(soak)) rows.push_back(std::move(row));
  return rows;
}

struct Options {
  std::string filter, solver, csv, results, out = "stress";
  bool list = false, soak = false;
};

std::string file_name(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.') c = '_';
  return text;
}

/// Regressions of the row: failures that are not known.
int run_row(const Row& row, const Options& options, std::vector<Tally>& tallies) {
  int regressions = 0;
  for (const std::string& solver : row.solvers) {
    Tally tally;
    tally.theme = row.theme;
    tally.row = row.name;
    tally.solver = solver;
    for (const Case& c : row.cases) {
      for (const auto& [name, mesh] : c.models) write_obj(mesh, options.out + "/models/" + name + ".obj");
      // Written before it runs: whatever happens, the request that did it is there.
      const std::string yaml = request_text(c, solver);
      const std::string path =
          options.out + "/" + file_name(row.theme + "." + row.name + "." + c.name + "." + solver) + ".yaml";
      std::ofstream(path) << yaml;
      const Outcome outcome = run_apart(yaml, options.out, c.expect, {});
      const auto known = row.known.find(solver + ": " + c.name);
      const std::string why = known == row.known.end() ? "" : known->second;
      tally.add(c, outcome, why);
      for (const std::string& flag : outcome.flags)
        std::printf("  %s: %s: flagged, %s\n", solver.c_str(), c.name.c_str(), flag.c_str());
      if (outcome.survived()) {
        fs::remove(path);
        if (!why.empty())
          std::printf("  %s: %s survives now; take it from the known failures\n", solver.c_str(), c.name.c_str());
      } else {
        std::printf("  %s\n    request: %s\n", tally.failures.back().c_str(), path.c_str());
        regressions += why.empty();
      }
    }
    std::printf(
        "%-12s %-34s %-10s %3zu / %-3zu flagged %-3zu overlap %6.3f %%  drift %6.3f %%  energy %+7.3f %%  %6.1f s  "
        "%4.0f MB\n",
        tally.theme.c_str(), tally.row.c_str(), solver.c_str(), tally.survived, tally.tried, tally.flagged,
        100.0 * tally.penetration, 100.0 * tally.drift, 100.0 * tally.energy, tally.cpu_s, tally.peak_mb);
    std::fflush(stdout);
    tallies.push_back(std::move(tally));
  }
  return regressions;
}

int run(int argc, char** argv) {
  CLI::App app("Stress suite: extreme requests, each in a process of its own; counts survived / tried.");
  Options o;
  app.add_flag("--list", o.list, "rows with their number of cases, nothing is run");
  app.add_option("--filter", o.filter, "only rows whose 'theme/row' contains this");
  app.add_option("--solver", o.solver, "only this one: sphere, sphere/gpu, bullet or thesis")
      ->check(CLI::IsMember({"sphere", "sphere/gpu", "bullet", "thesis"}));
  app.add_flag("--soak", o.soak, "the long form: more cases, more parts, more seeds");
  app.add_option("--out", o.out, "directory for models and the requests that failed")->capture_default_str();
  app.add_option("--csv", o.csv, "file for the results");
  app.add_option("--results", o.results, "folder: the results go to RESULTS/<device>/stress.csv too");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    throw input_error(error.what(), "command line", "see bin_scenes_stress --help");
  }

  std::vector<Row> rows;
  for (Row& row : all_rows(o.soak)) {
    if ((row.theme + "/" + row.name).find(o.filter) == std::string::npos) continue;
    if (!o.solver.empty())
      row.solvers.erase(std::remove_if(row.solvers.begin(), row.solvers.end(),
                                       [&](const std::string& solver) { return solver != o.solver; }),
                        row.solvers.end());
    if (!row.solvers.empty()) rows.push_back(std::move(row));
  }
  if (rows.empty()) {
    const std::string by = o.solver.empty() ? "" : " under " + o.solver;
    throw input_error("no row matches '" + o.filter + "'" + by, "--filter", "see --list");
  }
  if (o.list) {
    for (const Row& row : rows)
      std::printf("%s/%s: %zu cases x %zu solvers\n", row.theme.c_str(), row.name.c_str(), row.cases.size(),
                  row.solvers.size());
    return 0;
  }
  std::error_code failed;
  fs::create_directories(o.out + "/models", failed);
  if (failed) throw environment_error(failed.message(), o.out, "choose another --out");
  o.out = fs::absolute(o.out).string();

  std::string command = "bin_scenes_stress";
  if (o.soak) command += " --soak";
  if (!o.filter.empty()) command += " --filter " + o.filter;
  if (!o.solver.empty()) command += " --solver " + o.solver;
  std::vector<Tally> tallies;
  int regressions = 0;
  for (const Row& row : rows) regressions += run_row(row, o, tallies);
  if (!o.csv.empty()) write_csv(o.csv, tallies, command);
  if (!o.results.empty()) {
    const std::string folder = o.results + "/" + bench::device_slug();
    fs::create_directories(folder);
    write_csv(folder + "/stress.csv", tallies, command);
  }

  std::size_t tried = 0, survived = 0, flagged = 0;
  for (const Tally& t : tallies) tried += t.tried, survived += t.survived, flagged += t.flagged;
  std::printf("survived %zu / %zu, flagged %zu; %d failures that are not known\n", survived, tried, flagged,
              regressions);
  return regressions ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const bin_scenes::Error& error) {
    std::cerr << "bin_scenes_stress: " << error.what() << std::endl;
    return static_cast<int>(error.kind());
  }
}
