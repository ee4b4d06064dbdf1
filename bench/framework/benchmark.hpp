/// A benchmark is one file of bench/ with one registration at its end:
///
///     namespace bin_scenes::bench {
///     namespace {
///     void run(Run& out) {
///       for (const double dt : out.quick() ? coarse : all) {
///         out.row(Row().key("solver", "sphere").key("time_step_s", dt).measure("error_rel", samples));
///       }
///     }
///     const Registration registration{
///         "bounce", "height after a bounce over time steps, both solvers", {"solver", "time_step_s"}, run};
///     }  // namespace
///     }  // namespace bin_scenes::bench
///
/// The file goes into bench/CMakeLists.txt, its plot (if any) into bench/plots/<name>.gp (see bench/publish).
#pragma once

#include "bin_scenes/core/error.hpp"
#include "framework/table.hpp"

#include <functional>
#include <string>
#include <vector>

namespace bin_scenes::bench {

/// What a running benchmark is given.
class Run {
 public:
  struct Options {
    std::string out;  ///< folder of the results
    bool quick = false;
    std::vector<std::string> rows;  ///< "key=glob": only rows whose keys match
  };
  Run(const std::string& name, const Options& options, Table& table);
  ~Run();

  bool quick() const { return options_.quick; }
  /// Whether rows with these keys were asked for; ask before the work is done.
  bool wanted(const Row& keys) const;
  /// Adds a row to `<out>/<name>.csv`, which is whole after each row, and prints it. A row with the keys of an earlier
  /// one takes its place; other rows of an earlier run stay, those of engines that are no longer measured among them.
  void row(const Row& row);
  /// The same without printing it: for what can only be told when all rows are there.
  void amend(const Row& row);
  /// All rows so far, those kept from an earlier run included.
  const Table& table() const { return table_; }
  /// Paths in models/: a part's mesh, and the file of its exact convex pieces (channel_u and ring_24 have them).
  static std::string part(const std::string& name);
  static std::string pieces(const std::string& name);
  /// Path of a plan in config/.
  static std::string plan(const std::string& name);
  /// A folder for this run alone, removed afterwards.
  const std::string& scratch() const { return scratch_; }
  bool any_wanted() const { return any_wanted_; }  ///< of the rows asked about so far

 private:
  std::string name_, scratch_;
  const Options& options_;
  Table& table_;
  mutable bool any_wanted_ = false;
};

struct Benchmark {
  std::string name;               ///< snake_case: file, CSV, plot
  std::string about;              ///< one line
  std::vector<std::string> keys;  ///< columns that rows can be chosen by
  std::function<void(Run&)> run;
  std::string measures;  ///< folders of the source tree; when they change, bench/publish marks the results as stale
};

/// What most benchmarks measure: how heaps are poured.
constexpr const char* pouring = "src/core src/part src/solver src/pour src/quality shaders";

/// Puts a benchmark on the list; lives in an anonymous namespace of the benchmark's file.
struct Registration {
  Registration(const std::string& name, const std::string& about, const std::vector<std::string>& keys,
               std::function<void(Run&)> run, const std::string& measures = pouring);
};

/// All benchmarks by name.
std::vector<Benchmark> benchmarks();

struct Selection {
  std::vector<Benchmark> benchmarks;
  std::vector<Error> unknown;  ///< patterns that match none, each with the nearest name
};
/// Those whose name matches one of the glob patterns; all without patterns.
Selection selected(const std::vector<Benchmark>& all, const std::vector<std::string>& patterns);

/// Throws an input Error, with the nearest key, for a row filter by a key that one of the benchmarks does not have.
void check_rows(const std::vector<Benchmark>& chosen, const std::vector<std::string>& rows);

enum class Ended { good, failed, nothing_wanted };
/// Runs one; a bin_scenes Error in it becomes a last row with its text as status.
Ended run(const Benchmark& benchmark, const Run::Options& options, const std::string& command);

}  // namespace bin_scenes::bench
