/// The command `dataset` and those below it: reads options, listens to signals, prints progress. The work is in
/// src/dataset.
#include "bin_scenes/config/plan.hpp"
#include "core/formatted.hpp"
#include "dataset/data_folder.hpp"
#include "dataset/merge.hpp"
#include "dataset/run.hpp"
#include "dataset/slurm.hpp"
#include "dataset/verify.hpp"
#include "tool/commands.hpp"
#include "tool/interrupt.hpp"
#include "tool/progress_bar.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>

namespace bin_scenes {

namespace {

/// Workers die with this process, and what they left is removed by the next run.
const std::atomic<bool>& listen() {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes is an error like a full disk
  return stop_on_signals(700'000, nullptr);
}

/// "2/8": the share with number 2, from 0, of 8.
void read_shard(const std::string& text, RunOptions& run) {
  char behind = 0;
  const bool read = std::sscanf(text.c_str(), "%zu/%zu%c", &run.shard, &run.shards, &behind) == 2;
  if (!read || text[0] == '-' || run.shards == 0 || run.shards > 1'000'000 || run.shard >= run.shards)
    throw input_error("expected i/n with i from 0 to n - 1, found '" + text + "'", "--shard", "for instance 0/8");
}

BopFolder bop_in(const std::string& directory) {
  return bop_folder({directory}, read_facts(directory));
}

/// One line on a terminal, or a line of JSON at most twice a second.
class Teller {
 public:
  explicit Teller(bool json) : json_(json) {}

  void warn(const std::string& text) {
    bar_.clear();
    std::fprintf(stderr, "bin_scenes: warning: %s\n", text.c_str());
  }

  void report(const RunProgress& p, bool last = false) {
    if (!json_) {
      if (!last) show(p);
      return;
    }
    const auto now = std::chrono::steady_clock::now();
    if (!last && reported_ && now - time_ < std::chrono::milliseconds(500)) return;
    time_ = now;
    reported_ = true;
    const nlohmann::ordered_json line = {{"phase", p.phase},
                                         {"heaps", p.heaps},
                                         {"heaps_done", p.heaps_done},
                                         {"accepted", p.accepted},
                                         {"rejected", p.rejected},
                                         {"failed", p.failed},
                                         {"scenes_per_hour", p.scenes_per_hour},
                                         {"remaining_s", p.remaining_s},
                                         {"finished", last}};
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
  }

 private:
  void show(const RunProgress& p) {
    const std::string text = formatted("%s: %zu of %zu heaps, %zu scenes, %zu rejected, %.0f scenes/h", p.phase.c_str(),
                                       p.heaps_done, p.heaps, p.accepted, p.rejected, p.scenes_per_hour);
    const bool known = p.remaining_s > 0.0 && p.heaps > 0;
    bar_.show(p.heaps > 0 ? static_cast<double>(p.heaps_done) / static_cast<double>(p.heaps) : 0.0, text,
              known ? std::optional<double>(p.remaining_s) : std::nullopt);
  }

  bool json_, reported_ = false;
  ProgressBar bar_{false};  // workers are forked
  std::chrono::steady_clock::time_point time_;
};

}  // namespace

int dataset(const DatasetOptions& options) {
  if (options.plan.empty()) throw input_error("no plan is named", "dataset", "bin_scenes dataset PLAN.yaml --out DIR");
  if (options.out.empty()) throw input_error("is missing", "--out", "name the directory of the data set");
  RunOptions run;
  run.workers = options.workers;
  if (!options.shard.empty()) read_shard(options.shard, run);
  const Plan plan = read_plan(options.plan);
  for (const std::string& note : plan.notes) std::fprintf(stderr, "bin_scenes: note: %s\n", note.c_str());
  run.stop = &listen();
  RunProgress end;
  {
    Teller teller(options.json_progress);
    run.warn = [&](const std::string& text) { teller.warn(text); };
    run.progress = [&](const RunProgress& progress) { teller.report(progress); };
    end = run_dataset(plan, options.out, run);
    teller.report(end, true);
  }
  if (!options.json_progress)
    std::printf("%zu scenes in %s; %zu attempts set apart\n", end.accepted, options.out.c_str(), end.rejected);
  if (end.not_poured > 0)
    std::fprintf(stderr, "bin_scenes: warning: %zu of %zu parts found no room: ask for fewer, or enlarge the bin\n",
                 end.not_poured, end.asked_for);
  if (plan.wants("bop"))
    if (const std::string crowded = crowded_targets(bop_in(options.out)); !crowded.empty())
      std::fprintf(stderr, "bin_scenes: warning: %s\n", crowded.c_str());
  if (end.failed == 0) return exit_done;
  std::fprintf(stderr, "bin_scenes: %zu of %zu heaps were not accepted in %zu attempts each, see %s/set_apart\n",
               end.failed, end.heaps, plan.attempts, options.out.c_str());
  return exit_set_apart;
}

int dataset_verify(const VerifyOptions& options) {
  if (options.list) {
    for (const auto& [name, text] : invariants()) std::printf("%-18s %s\n", name, text);
    return exit_done;
  }
  if (options.directory.empty())
    throw input_error("no directory is named", "dataset verify", "name that of a data set");
  constexpr std::size_t most = 100;  // findings that are printed
  Findings findings;
  if (is_worked_in(options.directory))
    std::fprintf(stderr, "bin_scenes: note: another process works in %s: what it has yet to make is found missing\n",
                 options.directory.c_str());
  {
    ProgressBar bar;
    bar.stage(0.0, 1.0, "reading the data set");
    verify_dataset({options.directory}, findings);
  }
  std::size_t tried = 0;
  for (const auto& [name, count] : findings.checked()) tried += count;
  const std::vector<Finding> found = findings.sorted();
  for (std::size_t i = 0; i < std::min(found.size(), most); ++i)
    std::printf("%s: %s: %s\n", found[i].check.c_str(), found[i].where.c_str(), found[i].text.c_str());
  if (found.size() > most) std::printf("and %zu more\n", found.size() - most);
  std::printf("%zu invariants, %zu checks, %zu findings\n", findings.checked().size(), tried, found.size());
  return found.empty() ? exit_done : exit_set_apart;
}

int dataset_merge(const MergeOptions& options) {
  ProgressBar bar;
  bar.stage(0.0, 1.0, "joining shares");
  const Merged merged = merge_datasets(options.shares, options.out, &listen());
  bar.clear();
  std::printf("%zu scenes in %s; %zu attempts set apart\n", merged.scenes, options.out.c_str(), merged.rejected);
  if (merged.missing == 0) return exit_done;
  std::fprintf(stderr, "bin_scenes: %zu heaps are in no share; make them, and merge again\n", merged.missing);
  return exit_set_apart;
}

int dataset_toolkit(const ToolkitOptions& options) {
  const bool good = !options.name.empty() &&
                    options.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789") == std::string::npos;
  if (!good)
    throw input_error("'" + options.name + "' is no name that bop_toolkit reads back from a file of results", "--name",
                      "small letters and digits");
  const BopFolder bop = bop_in(options.directory);
  std::printf("%s", toolkit_entry(bop, options.name).c_str());
  if (const std::string crowded = crowded_targets(bop, options.name); !crowded.empty())
    std::fprintf(stderr, "bin_scenes: warning: %s\n", crowded.c_str());
  return exit_done;
}

int dataset_submit(const SubmitOptions& options) {
  const Plan plan = read_plan(options.plan);  // its errors are reported here, not by every task
  const std::atomic<bool>& interrupted = listen();
  const auto print = [](const std::string& text) {
    std::printf("%s\n", text.c_str());
    std::fflush(stdout);
  };
  const std::size_t shares = std::min(options.shares, plan.heaps);
  const std::vector<std::string> made =
      run_slurm_job({options.plan, options.out, shares, options.cpus, options.sbatch, print, &interrupted});
  return dataset_merge({made, options.out});
}

}  // namespace bin_scenes
