#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/png.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace bin_scenes {

void write_bytes(const std::string& path, const void* data, std::size_t size) {
  const auto fail = [&](const char* what) {
    return environment_error(std::string(what) + ": " + std::strerror(errno), path, "check permissions and free space");
  };
  Temporary file(path);
  const int descriptor = ::open(file.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw fail("cannot be written");
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor, from, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const Error error = fail("cannot be written");
      ::close(descriptor);
      throw error;
    }
    from += written;
    size -= static_cast<std::size_t>(written);
  }
  if (::close(descriptor) != 0) throw fail("cannot be closed");  // some file systems tell of a full disk only here
  file.commit();
}

void write_text(const std::string& path, const std::string& text) {
  write_bytes(path, text.data(), text.size());
}

namespace {
BagWriter& registered_bag_writer() {
  static BagWriter writer;
  return writer;
}
}  // namespace

void register_bag_writer(BagWriter writer) {
  registered_bag_writer() = std::move(writer);
}
const BagWriter& bag_writer() {
  return registered_bag_writer();
}

}  // namespace bin_scenes
