/// Stores linked shader programs on the disk under a key of driver and source. If the cache cannot be written, or an
/// entry is damaged or refused by the driver, programs are compiled as without a cache. BIN_SCENES_CACHE=off switches
/// it off.
#pragma once

#include <string>

namespace bin_scenes::gl {

/// Program made from the binary stored under `key`, 0 if there is none that the driver takes. The file's name begins
/// with `name`, so that a disassembler can be given the binary of a pass.
unsigned load_program_binary(const std::string& name, const std::string& key);
void store_program_binary(const std::string& name, const std::string& key, unsigned program);

}  // namespace bin_scenes::gl
