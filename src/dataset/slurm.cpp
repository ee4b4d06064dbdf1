/// Submits an array job, looks at it once a second, and reports its shares once Slurm no longer knows it.
#include "dataset/slurm.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "core/data_files.hpp"
#include "core/read_file.hpp"
#include "dataset/whole_folders.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <sstream>
#include <thread>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::milliseconds between_looks(1000);

struct Outcome {
  int code = -1;
  std::string out, errors;  ///< apart: sites have sbatch say things to its user, too
};

/// A command of Slurm, without a shell between.
Outcome call(const std::vector<std::string>& words) {
  int ends[2];
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors(std::tmpfile(), std::fclose);
  if (!errors || pipe(ends) != 0) throw environment_error(std::strerror(errno), words[0], "close programs");
  const pid_t pid = fork();
  if (pid == 0) {
    dup2(ends[1], STDOUT_FILENO);
    dup2(fileno(errors.get()), STDERR_FILENO);
    close(ends[0]);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close(ends[1]);
  Outcome outcome;
  char text[4096];
  for (ssize_t n; (n = read(ends[0], text, sizeof text)) > 0 || (n < 0 && errno == EINTR);)
    if (n > 0) outcome.out.append(text, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::rewind(errors.get());
  while (const std::size_t n = std::fread(text, 1, sizeof text, errors.get())) outcome.errors.append(text, n);
  return outcome;
}

std::string script() {
  return first_place(data_places("scripts/slurm/dataset.sbatch"), "the script of the array job",
                     "install bin_scenes anew");
}

/// State -> number of tasks that Slurm still knows; none: the job is over.
std::map<std::string, int> states_of(const std::string& id) {
  const Outcome outcome = call({"squeue", "--noheader", "--array", "--jobs=" + id, "--format=%T"});
  std::map<std::string, int> states;
  if (outcome.code != 0) {
    if (outcome.errors.find("Invalid job id") != std::string::npos) return states;
    throw environment_error("squeue: " + outcome.errors, "Slurm", "ask again when Slurm answers: the job goes on");
  }
  std::istringstream lines(outcome.out);
  for (std::string state; lines >> state;) ++states[state];
  return states;
}

/// As a pattern of Slurm, where % begins the number of a task and the like.
std::string as_pattern(const std::string& path) {
  std::string pattern;
  for (const char c : path) pattern += c == '%' ? "%%" : std::string(1, c);
  return pattern;
}

std::string submit(const SlurmJob& job, const fs::path& folder) {
  // Not as words of --export, which end at a comma.
  setenv("BIN_SCENES_TOOL", fs::read_symlink("/proc/self/exe").c_str(), 1);
  setenv("BIN_SCENES_PLAN", fs::absolute(job.plan).c_str(), 1);
  setenv("BIN_SCENES_OUT", folder.c_str(), 1);
  setenv("BIN_SCENES_SHARES", std::to_string(job.shares).c_str(), 1);
  std::vector<std::string> words = {"sbatch",
                                    "--parsable",
                                    "--array=0-" + std::to_string(job.shares - 1),
                                    "--cpus-per-task=" + std::to_string(job.cpus),
                                    "--output=" + as_pattern(folder.string()) + "/share_%a.log",
                                    "--export=ALL"};
  words.insert(words.end(), job.options.begin(), job.options.end());
  words.push_back(script());
  const Outcome outcome = call(words);
  if (outcome.code == 127)
    throw environment_error("there is no sbatch", "Slurm", "submit on a machine that has Slurm (Debian: slurm-client)");
  if (outcome.code != 0)
    throw environment_error("sbatch: " + outcome.errors, "Slurm",
                            "correct what it says; --sbatch passes options on to it");
  return outcome.out.substr(0, outcome.out.find_first_of(";\n"));
}

}  // namespace

std::vector<std::string> run_slurm_job(const SlurmJob& job) {
  const CancelScope scope(job.stop);
  const fs::path folder = fs::absolute(job.out).lexically_normal() / ".shares";
  const fs::path note = folder / "job";
  make_directory(folder);
  std::string id = fs::exists(note) ? read_file(note.string()) : "";
  const bool runs = !id.empty() && !states_of(id).empty();
  if (!runs) {
    id = submit(job, folder);
    write_text(note.string(), id);
  }
  job.report((runs ? "found job " : "submitted job ") + id);
  std::map<std::string, int> stated;
  for (;;) {
    const std::map<std::string, int> states = states_of(id);
    if (states.empty()) break;
    if (states != stated) {
      std::string text = "job " + id + ":";
      for (const auto& [state, count] : states) text += " " + std::to_string(count) + " " + state;
      job.report(text);
      stated = states;
    }
    for (int i = 0; i < 10; ++i) {
      stop_if_cancelled();
      std::this_thread::sleep_for(between_looks / 10);
    }
  }
  std::vector<std::string> shares;
  for (std::size_t i = 0; i < job.shares; ++i) {
    const fs::path share = folder / ("share_" + std::to_string(i));
    if (!fs::exists(share / "dataset.json"))
      throw environment_error("share " + std::to_string(i) + " made nothing",
                              (folder / ("share_" + std::to_string(i) + ".log")).string(),
                              "read this log; the same command submits again what is missing");
    shares.push_back(share.string());
  }
  return shares;
}

}  // namespace bin_scenes
