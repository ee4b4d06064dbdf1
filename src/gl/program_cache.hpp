/// Linked program binaries on disk, keyed by driver and source. Not writable, damaged or refused: it works without.
/// BIN_SCENES_CACHE=off switches it off.
#pragma once

#include <string>

namespace bin_scenes::gl {

/// Program made from the binary stored under `key`, 0 if there is none that the driver takes. The file's name begins
/// with `name`, so that a disassembler can be given the binary of a pass.
unsigned load_program_binary(const std::string& name, const std::string& key);
void store_program_binary(const std::string& name, const std::string& key, unsigned program);

}  // namespace bin_scenes::gl
