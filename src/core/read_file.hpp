/// Reads whole regular files, or computes their digest. It never waits for another process: a pipe, a device or a
/// folder is refused at once. All functions throw an input Error that names the path, and Error(cancelled) if the work
/// of this thread is cancelled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace bin_scenes {

/// Returns the contents of a file. A file of more than `most` bytes is refused before it is read.
std::string read_file(const std::string& path, std::size_t most = SIZE_MAX);
/// Returns the digest of the bytes of a file as 64 lower-case hexadecimal digits.
std::string sha256_of_file(const std::string& path);

/// A regular file that is open for reading.
class RegularFile {
 public:
  explicit RegularFile(const std::string& path);
  ~RegularFile();
  RegularFile(const RegularFile&) = delete;
  RegularFile& operator=(const RegularFile&) = delete;

  /// Reads at most `size` of the next bytes into `to`. Returns the number of bytes; 0 at the end of the file.
  std::size_t read(char* to, std::size_t size);
  std::size_t size() const { return size_; }  ///< size of the file (bytes) when it was opened

 private:
  std::string path_;
  int descriptor_;
  std::size_t size_ = 0;
};

}  // namespace bin_scenes
