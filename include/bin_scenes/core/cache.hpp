/// Disk cache of prepared parts and of compiled shader programs in $XDG_CACHE_HOME/bin_scenes (otherwise
/// ~/.cache/bin_scenes). The key of an entry consists of contents, parameters and format version. Files are written
/// under a temporary name and renamed, so that two processes do not disturb each other. Reading tests a checksum,
/// and a damaged entry is made again. If the cache cannot be written, that is no error: parts are then prepared, and
/// shaders compiled, in each run.
#pragma once

#include "bin_scenes/core/sha256.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

using Bytes = std::vector<std::uint8_t>;

/// The contents of a cache file, mapped into memory so that only what is read is loaded.
class CachedBytes {
 public:
  CachedBytes(const CachedBytes&) = delete;
  CachedBytes(CachedBytes&& other) noexcept;
  ~CachedBytes();

  const std::uint8_t* data() const { return data_; }
  std::size_t size() const { return size_; }
  friend bool operator==(const CachedBytes& a, const Bytes& b) {
    return std::equal(a.data_, a.data_ + a.size_, b.begin(), b.end());
  }

 private:
  friend class Cache;
  CachedBytes(void* mapping, std::size_t length, std::size_t before);
  void* mapping_;
  std::size_t length_;
  const std::uint8_t* data_;
  std::size_t size_;
};

/// The cache of this user. Its functions may be called from several threads.
class Cache {
 public:
  static Cache& global();  ///< the environment variable BIN_SCENES_CACHE=off switches it off

  std::string directory() const;
  /// Returns the contents that are stored under `key`; none if the file is missing or damaged. The file's name begins
  /// with `kind`, in which a slash separates folders.
  std::optional<CachedBytes> read(const std::string& kind, const std::string& key) const;
  /// Stores contents under `key`. Failure is not reported.
  void write(const std::string& kind, const std::string& key, const Bytes& bytes) const;
};

}  // namespace bin_scenes
