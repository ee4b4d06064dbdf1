/// Assembles the text of a shader that the compiler receives, and maps the lines of compiler messages back to source
/// files. It resolves includes and adds definitions; it does not compile (gl/program.hpp).
#pragma once

#include "bin_scenes/gl/program.hpp"

#include <string>
#include <vector>

namespace bin_scenes::gl {

struct ShaderSource {
  std::string text;                ///< #version line, definitions, code with included files and #line directives
  std::vector<std::string> files;  ///< names of the files; index: source number in #line
};

/// Reads a shader file with its includes and puts `defines` before it. If the environment has BIN_SCENES_SHUFFLE=1 (for
/// tests), invocations and groups are numbered in another order. A pass that lacks a barrier then gives different
/// results.
ShaderSource read_shader(const std::string& file, const Defines& defines);

/// Replaces "<source number>:<line>" (Mesa) and "<source number>(<line>)" (NVIDIA) by "<file>:<line>".
std::string with_file_names(const std::string& log, const ShaderSource& source);

}  // namespace bin_scenes::gl
