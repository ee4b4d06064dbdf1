/// Reads prepared data of a part from the disk cache, or makes and stores them. All prepared data of all parts pass
/// through here.
#pragma once

#include "bin_scenes/part/part_model.hpp"
#include "core/formatted.hpp"
#include "part_bytes.hpp"

#include <atomic>

namespace bin_scenes {

/// Counts of shapes that were built, and of shapes that were read from the cache, for PartModel::work().
struct PartWorkCounter {
  static std::atomic<std::size_t> built, read;
};

/// Returns the value of an option as text for a cache key; every bit of the number counts.
inline std::string key_text(double value) {
  return formatted("%a ", value);
}

template <class T, class Make>
T cached(const std::string& kind, const std::string& key, Make&& make) {
  const std::string full_key = "format " + std::to_string(part_format) + " " + key;
  if (const auto bytes = Cache::global().read(kind, full_key)) {
    ByteReader in(*bytes);
    T value;
    in(value);
    if (in.complete()) {
      ++PartWorkCounter::read;
      return value;
    }
  }
  T value = make();
  ++PartWorkCounter::built;
  ByteWriter out;
  out(value);
  Cache::global().write(kind, full_key, out.take());
  return value;
}

}  // namespace bin_scenes
