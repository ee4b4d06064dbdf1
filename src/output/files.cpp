#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/png.hpp"
#include "output/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace bin_scenes {

WholeFile::WholeFile(const std::string& path)
    : path_(path),
      temporary_(path),
      descriptor_(::open(temporary_.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail("cannot be written");
}

WholeFile::~WholeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void WholeFile::append(const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  size_ += size;
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, from, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    from += written;
    size -= static_cast<std::size_t>(written);
  }
}

void WholeFile::commit() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0) fail("cannot be closed");  // some file systems report a full disk only here
  temporary_.commit();
}

void WholeFile::fail(const char* what) const {
  throw environment_error(std::string(what) + ": " + std::strerror(errno), path_, "check permissions and free space");
}

void write_bytes(const std::string& path, const void* data, std::size_t size) {
  WholeFile file(path);
  file.append(data, size);
  file.commit();
}

void write_text(const std::string& path, const std::string& text) {
  write_bytes(path, text.data(), text.size());
}

void make_directory(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw environment_error("cannot be made: " + error.message(), path.string(), "check permissions and space");
}

namespace {
BagWriter& registered_bag_writer() {
  static BagWriter writer;
  return writer;
}
McapWriter& registered_mcap_writer() {
  static McapWriter writer;
  return writer;
}
}  // namespace

void register_bag_writer(BagWriter writer) {
  registered_bag_writer() = std::move(writer);
}
const BagWriter& bag_writer() {
  return registered_bag_writer();
}

void register_mcap_writer(McapWriter writer) {
  registered_mcap_writer() = std::move(writer);
}
const McapWriter& mcap_writer() {
  return registered_mcap_writer();
}

}  // namespace bin_scenes
