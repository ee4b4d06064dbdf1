/// Counts of dispatches, barriers and copied bytes. On a fast device, these numbers determine the cost of a step. The
/// functions of this layer count; TrafficCount adds the counts to a Profile.
#pragma once

#include "bin_scenes/core/profile.hpp"

#include <cstdint>

namespace bin_scenes::gl {

/// Counts since the start of the thread.
struct Traffic {
  std::uint64_t dispatches = 0, barriers = 0;
  std::uint64_t argument_barriers = 0;                    ///< those of the barriers that also protect numbers of groups
  std::uint64_t bytes_uploaded = 0, bytes_read_back = 0;  ///< between host and device
};

/// Returns the totals of the calling thread, which has a device of its own.
Traffic& traffic();

/// Adds the counts during the object's lifetime to the counters gl_dispatches, gl_barriers, gl_argument_barriers,
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
