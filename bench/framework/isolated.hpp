/// Work in a process of its own: its peak memory and CPU time are its own, and neither a crash nor a hang of a peer
/// library takes the other rows along.
#pragma once

#include "framework/table.hpp"

#include <functional>

namespace bin_scenes::bench {

struct Isolated {
  Row row;  ///< what the function returned; only a status if it failed
  bool good = false;
  double peak_mb = 0.0;   ///< largest resident set (MB = 1e6 byte)
  double added_mb = 0.0;  ///< of it, what the work added to what the process started with
};

/// Forks and runs `work` there. An exception, a crash, or more than `limit_cpu_s` seconds of CPU time (or thirty times
/// that on the wall) become the row's status: on a busy machine too, the same rows fit into the limit. The caller must
/// not have made a GL context yet: contexts do not survive a fork.
Isolated isolated(const std::function<Row()>& work, double limit_cpu_s = 600.0);

/// User and system time of all threads of this process so far (s).
double cpu_seconds();

}  // namespace bin_scenes::bench
