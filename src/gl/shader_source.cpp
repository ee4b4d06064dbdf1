#include "shader_source.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/data_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace bin_scenes::gl {

namespace fs = std::filesystem;

std::string shader_directory() {
  const char* const set = std::getenv("BIN_SCENES_SHADERS");
  return first_place(set && *set ? std::vector<fs::path>{set} : data_places("shaders"), "shaders",
                     "set BIN_SCENES_SHADERS to the folder 'shaders' of bin_scenes");
}

namespace {

std::string read_text(const fs::path& path, const std::string& wanted_by) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in)
    throw environment_error("shader file can not be read", path.string() + wanted_by,
                            "the installation is incomplete: install bin_scenes again, or set BIN_SCENES_SHADERS");
  return text.str();
}

void append(const fs::path& directory, const std::string& file, const std::string& wanted_by, ShaderSource& source) {
  if (std::find(source.files.begin(), source.files.end(), file) != source.files.end()) return;
  const std::size_t number = source.files.size();
  source.files.push_back(file);
  std::istringstream lines(read_text(directory / file, wanted_by));
  source.text += "#line 1 " + std::to_string(number) + "\n";
  static const std::regex include("^\\s*#include\\s+\"([^\"]+)\".*");
  std::string line;
  for (std::size_t at = 1; std::getline(lines, line); ++at) {
    std::smatch match;
    // A cheap look first: regex on every line costs more than the compiler.
    if (line.find("#include") != std::string::npos && std::regex_match(line, match, include)) {
      append(directory, match[1], " (included by " + file + ":" + std::to_string(at) + ")", source);
      source.text += "#line " + std::to_string(at + 1) + " " + std::to_string(number) + "\n";
    } else {
      source.text += line + "\n";
    }
  }
}

/// Of a group every invocation, of a dispatch every group: numbered in another order. Macros, as the size of a group is
/// known only behind the layout line. 37 has no divisor in common with any size of a group.
constexpr const char* other_numbers =
    "#define shuffled_invocation ((gl_LocalInvocationIndex * 37u + 11u) % gl_WorkGroupSize.x)\n"
    "#define shuffled_group uvec3(gl_NumWorkGroups.x - 1u - gl_WorkGroupID.x, gl_WorkGroupID.yz)\n";

/// NVIDIA's compiler unrolls what it can: find_contacts, which takes it 24 s, was not done in 100.
constexpr const char* head = "#version 450 core\n#pragma optionNV(unroll none)\n";

void shuffle(std::string& text) {
  static const std::regex invocation("gl_LocalInvocationIndex\\b"), group("gl_WorkGroupID\\b");
  text = std::regex_replace(text, invocation, "shuffled_invocation");
  text = std::regex_replace(text, group, "shuffled_group");
}

}  // namespace

ShaderSource read_shader(const std::string& file, const Defines& defines) {
  ShaderSource source;
  for (const auto& [name, value] : defines) source.text += "#define " + name + " " + value + "\n";
  append(shader_directory(), file, "", source);
  BIN_SCENES_ASSERT(!source.files.empty() && source.files.front() == file);
  const char* const set = std::getenv("BIN_SCENES_SHUFFLE");
  const bool shuffled = set && std::string(set) == "1";
  if (shuffled) shuffle(source.text);
  source.text.insert(0, std::string(head) + (shuffled ? other_numbers : ""));
  return source;
}

std::string with_file_names(const std::string& log, const ShaderSource& source) {
  static const std::regex place("^(\\d+)(?::(\\d+)(?:\\(\\d+\\))?|\\((\\d+)\\))");
  std::istringstream lines(log);
  std::string line, text;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_search(line, match, place) && std::stoul(match[1]) < source.files.size())
      line = source.files[std::stoul(match[1])] + ":" + (match[2].matched ? match[2] : match[3]).str() +
             match.suffix().str();
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

}  // namespace bin_scenes::gl
