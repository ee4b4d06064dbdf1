#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "output/png.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace bin_scenes {

namespace fs = std::filesystem;

Temporary::Temporary(const std::string& target) : target_(fs::path(target).lexically_normal().string()) {
  const fs::path path(target_);
  path_ = (path.parent_path() / ("." + path.filename().string() + ".tmp-" + std::to_string(::getpid()))).string();
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Temporary::~Temporary() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

void Temporary::commit() {
  // A directory cannot be renamed over one that holds files: the old one steps aside first.
  std::error_code error;
  const std::string old = path_ + "-old";
  const bool replaces = fs::is_directory(target_, error);
  if (replaces) fs::rename(target_, old, error);
  if (!error || !replaces) fs::rename(path_, target_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(old, target_, ignored);
    throw environment_error("cannot be put in place: " + error.message(), target_, "check permissions and free space");
  }
  if (replaces) fs::remove_all(old, error);
  path_.clear();
}

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
