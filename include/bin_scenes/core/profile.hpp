/// Measured times of the stages of a scene, and counters of the work that was done or skipped. Solvers, the generator
/// and the sensors each fill a Profile; their sum is in the report of a scene (`stages_ms`, `counters`). A stage has
/// the same name in its source file, its shader and here.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace bin_scenes {

/// Wall-clock times (ms) and counters of one scene or batch, summed by name. They never influence a simulation.
struct Profile {
  std::map<std::string, double> stages_ms;
  std::map<std::string, std::uint64_t> counters;

  void add(const std::string& stage, double ms) { stages_ms[stage] += ms; }
  void count(const std::string& counter, std::uint64_t n = 1) { counters[counter] += n; }
  void merge(const Profile& other) {
    for (const auto& [name, ms] : other.stages_ms) stages_ms[name] += ms;
    for (const auto& [name, n] : other.counters) counters[name] += n;
  }
  /// Returns what was added since `before`, which is an earlier state of this profile.
  Profile since(const Profile& before) const {
    Profile later = *this;
    for (const auto& [name, ms] : before.stages_ms) later.stages_ms[name] -= ms;
    for (const auto& [name, n] : before.counters) later.counters[name] -= n;
    return later;
  }
};

/// Adds the time between its construction and its destruction to one stage.
class StageTimer {
 public:
  StageTimer(Profile& profile, std::string stage)
      : profile_(profile), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start_;
    profile_.add(stage_, spent.count());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Profile& profile_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace bin_scenes
