#include "read_file.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/sha256.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace bin_scenes {

namespace {

constexpr std::size_t piece = std::size_t{1} << 20;  ///< bytes between two questions whether the work is still wanted

Error cannot_read(const std::string& path) {
  return input_error(std::string("cannot be read: ") + std::strerror(errno), path,
                     "name a file that is there and readable");
}

}  // namespace

RegularFile::RegularFile(const std::string& path)
    : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) throw cannot_read(path);
  struct stat status;
  const bool regular = fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode);
  if (!regular) {
    close(descriptor_);
    throw input_error("is not a regular file", path, "name a file, not a folder, pipe or device");
  }
  size_ = static_cast<std::size_t>(status.st_size);
}

RegularFile::~RegularFile() {
  close(descriptor_);
}

std::size_t RegularFile::read(char* to, std::size_t size) {
  stop_if_cancelled();
  for (;;) {
    const ssize_t n = ::read(descriptor_, to, std::min(size, piece));
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR) throw cannot_read(path_);
  }
}

std::string read_file(const std::string& path, std::size_t most) {
  RegularFile file(path);
  if (file.size() > most) {
    throw input_error("has " + std::to_string(file.size() >> 20) + " MiB, more than the " + std::to_string(most >> 20) +
                          " MiB that are read",
                      path, "give a smaller file");
  }
  std::string bytes(file.size() + 1, '\0');  // one more, so that the end is seen
  std::size_t filled = 0;
  while (const std::size_t n = file.read(bytes.data() + filled, bytes.size() - filled)) {
    filled += n;
    if (filled == bytes.size()) bytes.resize(2 * bytes.size());  // it grew meanwhile
  }
  bytes.resize(filled);
  return bytes;
}

std::string sha256_of_file(const std::string& path) {
  RegularFile file(path);
  std::string bytes(piece, '\0');
  Sha256 digest;
  while (const std::size_t n = file.read(bytes.data(), bytes.size())) digest.add(bytes.data(), n);
  return digest.hex();
}

}  // namespace bin_scenes
