/// Disk cache of prepared parts in $XDG_CACHE_HOME/bin_scenes (else ~/.cache/bin_scenes).
/// Keyed by content, parameters and format version; written by rename, so that two processes do no harm;
/// checksummed and never trusted: a damaged file is rebuilt. Not writable is not an error: it works without.
#pragma once

#include "bin_scenes/core/sha256.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bin_scenes {

using Bytes = std::vector<std::uint8_t>;

class Cache {
 public:
  static Cache& global();  ///< BIN_SCENES_CACHE=off switches it off

  std::string directory() const;
  /// Contents stored under `key` if whole and undamaged.
  std::optional<Bytes> read(const std::string& kind, const std::string& key) const;
  void write(const std::string& kind, const std::string& key, const Bytes& bytes) const;
};

}  // namespace bin_scenes
