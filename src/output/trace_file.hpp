/// Writes a trace as a CSV file with one row for each part and sample (output/trace.hpp). Other formats of a trace are
/// in trace_lines.hpp (.jsonl) and in ros/ (.bag, .mcap).
#pragma once

#include "bin_scenes/core/temporary.hpp"
#include "bin_scenes/output/trace.hpp"

#include <cstdio>

namespace bin_scenes {

/// Columns: time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz: pose of the model frame and velocity of the centre of mass in
/// the bin frame (SI units, 17 digits). Parts that have not entered have no row. finish() completes the file.
class TraceFile final : public Trace {
 public:
  explicit TraceFile(const std::string& path);
  ~TraceFile() override;
  void add(const TraceSample& sample) override;
  void finish() override;

 private:
  std::string path_;
  Temporary temporary_;
  std::FILE* file_ = nullptr;
};

}  // namespace bin_scenes
