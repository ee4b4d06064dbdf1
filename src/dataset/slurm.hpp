/// Submits the making of a data set to Slurm as an array job, in which each task makes one share. The call waits until
/// all tasks have ended; a repeated call finds a job that was submitted before. Merging the shares is done by the
/// caller.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace bin_scenes {

struct SlurmJob {
  std::string plan, out;             ///< shares are stored in OUT/.shares until they are merged into OUT
  std::size_t shares = 4, cpus = 1;  ///< number of tasks; cores for each task
  std::vector<std::string> options;  ///< further options of sbatch
  std::function<void(const std::string)> report;
  const std::atomic<bool>* stop = nullptr;
};

/// Submits the job, or finds the one of an earlier call. Waits until all of its tasks have ended, and returns the
/// folders of the shares. Throws an environment Error if Slurm is not available, and Error(cancelled) when stopped: the
/// job then continues, and the next call finds it.
std::vector<std::string> run_slurm_job(const SlurmJob& job);

}  // namespace bin_scenes
