#include "output/trace_file.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"

#include <cerrno>
#include <cstring>

namespace bin_scenes {

namespace {
Error failed(const std::string& path) {
  return environment_error(std::string("the trace cannot be written: ") + std::strerror(errno), path,
                           "check permissions and free space");
}
}  // namespace

TraceFile::TraceFile(const std::string& path) : path_(path), temporary_(path) {
  file_ = std::fopen(temporary_.path().c_str(), "w");
  if (!file_) throw failed(path_);
  std::fputs("time,id,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n", file_);
}

TraceFile::~TraceFile() {
  if (file_) std::fclose(file_);
}

void TraceFile::add(const TraceSample& sample) {
  BIN_SCENES_ASSERT(file_ && sample.time >= 0.0);
  for (const ScenePart& part : sample.parts) {
    if (!part.pose.finite()) continue;
    const Vec3 &p = part.pose.position, &v = part.velocity.linear, &w = part.velocity.angular;
    const Quat& q = part.pose.orientation;
    std::fprintf(file_, "%.17g,%d", sample.time, part.id);
    for (const double value :
         {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()}) {
      std::fprintf(file_, ",%.17g", value);
    }
    std::fputc('\n', file_);
  }
  if (std::ferror(file_)) throw failed(path_);
}

void TraceFile::finish() {
  const int result = std::fclose(file_);
  file_ = nullptr;
  if (result != 0) throw failed(path_);
  temporary_.commit();
}

}  // namespace bin_scenes
