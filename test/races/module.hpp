/// A compute pass in SPIR-V, decoded for an interpreter. A value lies in a file of 32-bit registers, one file an
/// invocation; so do its variables. Functions do not recurse in GLSL, so each id has one place.
///
// clang-format off
///     registers | constants | pointers known here | results of instructions | variables of functions | private ones |
///     shared    | variables of the group, one after the other
///     buffers   | as std430 lays them out; values and all other memory have no gaps
// clang-format on
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace bin_scenes::races {

using Word = std::uint32_t;

/// What SPIR-V has no instruction for: loads and stores by where the memory is.
enum Code : std::uint16_t {
  copy = 1000,  // to, from a, n words
  copy_list,    // to, list c of n places
  load_registers,
  load_shared,
  load_buffer,  // to, pointer a, list c of n (word of the value, word of the memory)
  store_registers,
  store_shared,
  store_buffer,
  extended = 2000  // + number in GLSL.std.450
};

struct Instruction {
  std::uint16_t code = 0;
  std::uint16_t n = 0;  ///< components, or words
  Word to = 0, a = 0, b = 0, c = 0;
  Word line = 0;  ///< as #line tells it
};

struct BufferVariable {
  std::string name;
  unsigned binding = 0;
  bool coherent = false, readonly = false;
};

struct Variable {
  std::string name;
  Word place = 0;  ///< first register, or first word of the group's memory
  Word words = 0;
};

struct Module {
  std::vector<Instruction> code;
  std::vector<Word> lists;
  std::vector<Word> registers;  ///< as an invocation begins
  std::vector<BufferVariable> buffers;
  std::vector<Variable> uniforms, shared;
  std::unordered_map<Word, Variable> inputs;  ///< by number of the built-in
  Word shared_words = 0;
  Word group_size = 1;
  Word entry = 0;                  ///< of main in `code`
  Word instructions = 0;           ///< of SPIR-V in functions, without labels, lines and merges
  std::vector<Word> barriers;      ///< where in `code`: control and memory barriers
  std::vector<std::string> files;  ///< by line / lines_per_file; filled by who compiles

  std::string place_of(Word line) const;  ///< "file:line"
};

/// Lines of the files of a text, as one number: file * lines_per_file + line.
constexpr Word lines_per_file = 10000;

/// Throws std::runtime_error at what no pass has used so far.
Module decode(const std::vector<Word>& binary);

/// Whether spirv-opt works over the compiler's output: it inlines all calls and moves values from variables to
/// registers, as a driver's compiler does.
enum class Optimise { no, yes };

/// The reference compiler on what the driver gets as source; throws with what it complains about.
Module compile(const std::string& source, const std::string& name, Optimise optimise = Optimise::no);

}  // namespace bin_scenes::races
