/// What is asked of the device: where it is fast, dispatches, barriers and copies are what a step costs.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <cstdint>

namespace bin_scenes::gl {

struct Traffic {
  std::uint64_t dispatches = 0, barriers = 0;
  std::uint64_t bytes_uploaded = 0, bytes_read_back = 0;  ///< between host and device
};

/// Of the whole process so far: one thread owns GL. The functions of this layer add to it.
Traffic& traffic();

/// Adds what is asked for during the life time of the object to the counters gl_dispatches, gl_barriers,
/// gl_bytes_uploaded and gl_bytes_read_back.
class TrafficCount {
 public:
  explicit TrafficCount(Profile& profile) : profile_(profile), begin_(traffic()) {}
  ~TrafficCount();
  TrafficCount(const TrafficCount&) = delete;
  TrafficCount& operator=(const TrafficCount&) = delete;

 private:
  Profile& profile_;
  Traffic begin_;
};

}  // namespace bin_scenes::gl
