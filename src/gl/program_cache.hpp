/// Stores linked shader programs in the disk cache (core/cache.hpp) under a key of driver and source. If the driver
/// refuses an entry, the program is compiled as without a cache.
#pragma once

#include <string>

namespace bin_scenes::gl {

/// Program made from the binary stored under `key`, 0 if there is none that the driver takes. The file's name begins
/// with `name`, so that a disassembler can be given the binary of a pass.
unsigned load_program_binary(const std::string& name, const std::string& key);
void store_program_binary(const std::string& name, const std::string& key, unsigned program);

}  // namespace bin_scenes::gl
