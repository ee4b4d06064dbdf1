/// Detects the format of a model file from its name and its bytes, before any reader is called. Unknown formats are
/// refused here.
#pragma once

#include <optional>
#include <string>

namespace bin_scenes {

/// "STL", "OBJ", "PLY", "DAE", "OFF", "STEP", "IGES", or empty.
std::string format_of_name(const std::string& path);
/// Returns the format by the contents of a file, or "". OBJ files cannot be recognised by their contents.
std::string format_of_content(const std::string& bytes);
/// Texts in UTF-16 (with byte order mark), which assimp's readers take for noise, as UTF-8.
std::optional<std::string> utf8_from_utf16(const std::string& bytes);
/// Refuses a header that promises more than the file can hold: assimp would believe it and ask for the memory.
void check_promised_counts(const std::string& bytes, const std::string& format, const std::string& path);

}  // namespace bin_scenes
