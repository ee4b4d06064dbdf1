#include "diagnostics.hpp"

#include "bin_scenes/core/cache.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace bin_scenes {

namespace {

using Level = diagnostic_msgs::DiagnosticStatus;

constexpr std::size_t many_set_apart = 3;  ///< scenes in a row that were not accepted: an error
constexpr double scarce_memory = 0.05;     ///< share of the machine's memory below which a warning is due

bool gpu_is_present() {
  std::error_code ignored;
  return std::filesystem::exists("/dev/nvidia0", ignored) || std::filesystem::exists("/dev/dri/renderD128", ignored);
}

bool is_software(const std::string& device) {
  return device.find("llvmpipe") != std::string::npos || device.find("softpipe") != std::string::npos;
}

/// kB of an entry of a file such as /proc/meminfo; 0 if it is not there.
double kilobytes(const char* file, const std::string& entry) {
  std::ifstream in(file);
  for (std::string name; in >> name;) {
    double value = 0.0;
    if (name == entry + ":" && in >> value) return value;
    in.ignore(1000, '\n');
  }
  return 0.0;
}

}  // namespace

// Named after the parameters: the process of a nodelet is its manager, and a node may have several bins.
Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& params, const SceneJobs& jobs,
                         const Publication& publication, const Settings& settings)
    : jobs_(jobs),
      publication_(publication),
      queue_size_(settings.queue_size),
      updater_(node, params, params.getNamespace()) {
  updater_.setHardwareID("none");
  updater_.add("device", [this](Status& status) { device(status); });
  updater_.add("scene", [this](Status& status) { scene(status); });
  updater_.add("queue", [this](Status& status) { queue(status); });
  updater_.add("cache", [this](Status& status) { cache(status); });
  updater_.add("memory", [this](Status& status) { memory(status); });
  updater_.add("sensors", [this](Status& status) { sensors(status); });
  // Wall time: a machine is also watched while a simulated clock stands still.
  timer_ =
      node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { updater_.force_update(); });
}

void Diagnostics::device(Status& status) const {
  const SceneJobs::Status jobs = jobs_.status();
  if (jobs.device.empty()) {
    status.summary(Level::OK, "no scene has been made yet");
  } else if (is_software(jobs.device) && gpu_is_present()) {
    status.summary(Level::WARN, "OpenGL runs in software, but this machine has a GPU: see `bin_scenes doctor`");
  } else {
    status.summary(Level::OK, jobs.solver + " on " + jobs.device);
  }
  status.add("solver", jobs.solver);
  status.add("device", jobs.device);
}

void Diagnostics::scene(Status& status) const {
  const SceneJobs::Status jobs = jobs_.status();
  if (jobs.set_apart_in_a_row >= many_set_apart) {
    status.summary(Level::ERROR, std::to_string(jobs.set_apart_in_a_row) + " scenes in a row were not accepted");
  } else if (!jobs.accepted) {
    status.summary(Level::WARN, "the last scene was not accepted");
  } else {
    status.summary(Level::OK, jobs.verdict.empty() ? "no scene has been made yet" : "the last scene was accepted");
  }
  status.add("verdict", jobs.verdict);
  status.add("scenes ahead", jobs.ahead);
}

void Diagnostics::queue(Status& status) const {
  const SceneJobs::Status jobs = jobs_.status();
  const bool full = jobs.jobs > static_cast<std::size_t>(queue_size_);
  status.summary(full ? Level::WARN : Level::OK,
                 full ? "full: further jobs are refused" : std::to_string(jobs.jobs) + " jobs");
  status.add("jobs", jobs.jobs);
  status.add("running", jobs.running);
  status.add("running for (s)", jobs.running_s);
  status.add("made", jobs.made);
  status.add("set apart", jobs.set_apart);
  status.add("failed", jobs.failed);
  status.add("cancelled", jobs.cancelled);
}

void Diagnostics::cache(Status& status) const {
  const std::string folder = Cache::global().directory();
  const bool writable = !folder.empty() && (::access(folder.c_str(), W_OK) == 0 || ::access(folder.c_str(), F_OK) != 0);
  status.summary(writable ? Level::OK : Level::WARN,
                 writable ? "in use" : "not writable: models are prepared anew in each run");
  status.add("folder", folder);
}

void Diagnostics::memory(Status& status) const {
  const double total = kilobytes("/proc/meminfo", "MemTotal"), available = kilobytes("/proc/meminfo", "MemAvailable");
  const bool scarce = available < scarce_memory * total;
  status.summary(scarce ? Level::WARN : Level::OK, scarce ? "the machine's memory is nearly used up" : "enough");
  status.add("of this node (MB)", kilobytes("/proc/self/status", "VmRSS") / 1000.0);
  status.add("available (MB)", available / 1000.0);
}

void Diagnostics::sensors(Status& status) const {
  const Publication::Counts counts = publication_.counts();
  const bool failed = counts.render_failures > 0;
  status.summary(failed ? Level::ERROR : Level::OK,
                 failed ? "images could not be made" : std::to_string(counts.sensors) + " sensors");
  status.add("sensors", counts.sensors);
  status.add("scenes shown", counts.scenes);
  status.add("late renderings", counts.renderings);
  status.add("failures since the last scene", counts.render_failures);
}

}  // namespace bin_scenes
