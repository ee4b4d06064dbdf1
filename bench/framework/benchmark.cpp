/// The list of benchmarks, the paths that they use, and the run of one with its table.
#include "framework/benchmark.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "config/suggest.hpp"
#include "framework/host.hpp"

#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

namespace bin_scenes::bench {

namespace {

namespace fs = std::filesystem;

std::vector<Benchmark>& registry() {
  static std::vector<Benchmark> all;  // here, so that it is there before the first registration of any file
  return all;
}

std::string models() {
  const char* given = std::getenv("BIN_SCENES_MODELS");
  return given ? given : BIN_SCENES_BENCH_MODELS;
}

}  // namespace

Registration::Registration(const std::string& name, const std::string& about, const std::vector<std::string>& keys,
                           std::function<void(Run&)> run, const std::string& measures) {
  registry().push_back({name, about, keys, std::move(run), measures});
}

std::vector<Benchmark> benchmarks() {
  std::vector<Benchmark> all = registry();
  std::sort(all.begin(), all.end(), [](const Benchmark& a, const Benchmark& b) { return a.name < b.name; });
  return all;
}

Selection selected(const std::vector<Benchmark>& all, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return {all, {}};
  Selection chosen;
  std::vector<bool> wanted(all.size(), false);
  std::vector<std::string> names;
  for (const Benchmark& benchmark : all) names.push_back(benchmark.name);
  for (const std::string& pattern : patterns) {
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (fnmatch(pattern.c_str(), names[i].c_str(), 0) != 0) continue;
      wanted[i] = any = true;
    }
    if (any) continue;
    const std::string near = config::nearest(pattern, names);
    chosen.unknown.push_back(
        input_error("no benchmark is called '" + pattern + "'", "--filter",
                    near.empty() ? "bin_scenes_bench --list shows all" : "did you mean '" + near + "'?"));
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (wanted[i]) chosen.benchmarks.push_back(all[i]);
  return chosen;
}

void check_rows(const std::vector<Benchmark>& chosen, const std::vector<std::string>& rows) {
  for (const std::string& row : rows)
    for (const Benchmark& benchmark : chosen) {
      const std::string key = row.substr(0, row.find('='));
      if (std::find(benchmark.keys.begin(), benchmark.keys.end(), key) != benchmark.keys.end()) continue;
      const std::string near = config::nearest(key, benchmark.keys);
      std::string all;
      for (const std::string& known : benchmark.keys) all += (all.empty() ? "" : ", ") + known;
      throw input_error("rows of " + benchmark.name + " have no key '" + key + "'", "--rows",
                        near.empty() ? "its keys are " + all : "did you mean '" + near + "'?");
    }
}

Run::Run(const std::string& name, const Options& options, Table& table)
    : name_(name),
      scratch_(fs::temp_directory_path() / ("bin_scenes_bench_" + std::to_string(::getpid()) + "_" + name)),
      options_(options),
      table_(table) {
  fs::create_directories(scratch_);
}

Run::~Run() {
  std::error_code ignored;
  fs::remove_all(scratch_, ignored);
}

std::string Run::part(const std::string& name) {
  return models() + "/" + name + ".stl";
}
std::string Run::plan(const std::string& name) {
  return models() + "/../config/" + name + "_plan.yaml";
}
std::string Run::pieces(const std::string& name) {
  return models() + "/pieces/" + name + ".obj";
}

bool Run::wanted(const Row& keys) const {
  for (const std::string& filter : options_.rows) {
    const std::size_t equals = filter.find('=');
    const std::string value = keys.at(filter.substr(0, equals));
    if (!value.empty() && fnmatch(filter.substr(equals + 1).c_str(), value.c_str(), 0) != 0) return false;
  }
  return any_wanted_ = true;
}

void Run::amend(const Row& row) {
  table_.add(row.at("commit").empty() ? Row(row).info("commit", commit()) : row);
  write_text(options_.out + "/" + name_ + ".csv", to_csv(table_));
}

void Run::row(const Row& row) {
  amend(row);
  std::string line;
  for (const auto& [column, value] : row.cells()) {
    if (value.empty()) continue;
    if (column.role == Role::spread)
      line += " [" + value + "]";
    else
      line += "  " + (column.role == Role::key ? value : column.name + " " + value);
  }
  std::printf("%s:%s\n", name_.c_str(), line.c_str());
  std::fflush(stdout);
}

Ended run(const Benchmark& benchmark, const Run::Options& options, const std::string& command) {
  Table table;
  const std::string before = options.out + "/" + benchmark.name + ".csv";
  if (fs::exists(before)) table = read_csv(before);
  table.header = {{"benchmark", benchmark.name},
                  {"about", benchmark.about},
                  {"command", command},
                  {"measures", benchmark.measures}};
  for (const auto& line : host()) table.header.push_back(line);
  table.header.emplace_back("quick", options.quick ? "yes" : "no");
  Run run(benchmark.name, options, table);
  try {
    benchmark.run(run);
    return run.any_wanted() ? Ended::good : Ended::nothing_wanted;
  } catch (const std::exception& error) {
    run.row(Row().status(std::string("failed: ") + error.what()));
    return Ended::failed;
  }
}

}  // namespace bin_scenes::bench
