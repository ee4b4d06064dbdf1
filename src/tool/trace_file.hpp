/// --trace: states of every part over simulated time, as CSV.
#pragma once

#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/solver/solver.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace bin_scenes {

/// time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz: pose of the model frame, velocity of the centre of mass, both in the
/// bin frame, SI units, 17 digits. Parts that are not in the bin yet have no row. The file appears with finish().
class TraceFile {
 public:
  /// Throws an environment Error where no file can be written, before anything is simulated.
  explicit TraceFile(const std::string& path);
  ~TraceFile();
  void add(double time, const std::vector<BodyState>& states);
  void finish();

 private:
  std::string path_;
  Temporary temporary_;
  std::FILE* file_ = nullptr;
};

}  // namespace bin_scenes
