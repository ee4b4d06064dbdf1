/// Assembles the text of a shader that the compiler receives, and maps the lines of compiler messages back to source
/// files. It resolves includes and adds definitions; it does not compile (gl/program.hpp).
#pragma once

#include "bin_scenes/gl/program.hpp"

#include <string>
#include <vector>

namespace bin_scenes::gl {

struct ShaderSource {
  std::string text;                ///< #version, defines, includes resolved, #line marks
  std::vector<std::string> files;  ///< files, by the source number of #line
};

/// With BIN_SCENES_SHUFFLE=1 in the environment, for tests: invocations and groups have other numbers than they would,
/// so that what one invocation does before its neighbour is done after it. A pass that lacks a barrier then gives other
/// bits.
ShaderSource read_shader(const std::string& file, const Defines& defines);

/// Replaces "<source number>:<line>" (Mesa) and "<source number>(<line>)" (NVIDIA) by "<file>:<line>".
std::string with_file_names(const std::string& log, const ShaderSource& source);

}  // namespace bin_scenes::gl
