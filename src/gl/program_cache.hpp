/// Stores linked shader programs in the disk cache (core/cache.hpp) under a key of driver and source. If the driver
/// refuses an entry, the program is compiled from its source.
#pragma once

#include <string>

namespace bin_scenes::gl {

/// Returns the OpenGL program made from the binary under `key`, or 0 if there is none that the driver accepts. The name
/// of the cache file begins with `name`, so that the binary of a pass can be found for a disassembler.
unsigned load_program_binary(const std::string& name, const std::string& key);
void store_program_binary(const std::string& name, const std::string& key, unsigned program);

}  // namespace bin_scenes::gl
