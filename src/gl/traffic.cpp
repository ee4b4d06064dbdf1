#include "bin_scenes/gl/traffic.hpp"

namespace bin_scenes::gl {

Traffic& traffic() {
  static thread_local Traffic sum;
  return sum;
}

TrafficCount::~TrafficCount() {
  const Traffic& end = traffic();
  profile_.count("gl_dispatches", end.dispatches - begin_.dispatches);
  profile_.count("gl_barriers", end.barriers - begin_.barriers);
  profile_.count("gl_argument_barriers", end.argument_barriers - begin_.argument_barriers);
  profile_.count("gl_bytes_uploaded", end.bytes_uploaded - begin_.bytes_uploaded);
  profile_.count("gl_bytes_read_back", end.bytes_read_back - begin_.bytes_read_back);
}

}  // namespace bin_scenes::gl
