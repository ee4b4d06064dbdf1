/// Detects the format of a model file from its name and its bytes, before any reader is called. Unknown formats are
/// refused here.
#pragma once

#include <optional>
#include <string>

namespace bin_scenes {

/// Returns the format by the file name: "STL", "OBJ", "PLY", "DAE", "OFF", "STEP", "IGES", or empty.
std::string format_of_name(const std::string& path);
/// Returns the format by the contents of a file, or "". OBJ files cannot be recognised by their contents.
std::string format_of_content(const std::string& bytes);
/// Returns a text in UTF-16 (with byte order mark), which assimp's readers cannot read, as UTF-8; none for other bytes.
std::optional<std::string> utf8_from_utf16(const std::string& bytes);
/// Throws an input Error if a header states more elements than the file can hold: assimp would allocate their memory.
void check_promised_counts(const std::string& bytes, const std::string& format, const std::string& path);

}  // namespace bin_scenes
