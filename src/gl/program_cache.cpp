#include "program_cache.hpp"

#include "bin_scenes/core/cache.hpp"

#include <epoxy/gl.h>

#include <cstring>

namespace bin_scenes::gl {

namespace {

/// An entry is the driver's format of the binary, then the binary.
constexpr std::size_t format_bytes = sizeof(GLenum);

/// The file's name begins with the name of the program, so that a disassembler can be given the binary of a pass.
std::string kind_of(const std::string& name) {
  return "programs/" + name;
}

}  // namespace

unsigned load_program_binary(const std::string& name, const std::string& key) {
  const auto entry = Cache::global().read(kind_of(name), key);
  if (!entry || entry->size() < format_bytes) return 0;
  GLenum format = 0;
  std::memcpy(&format, entry->data(), format_bytes);
  const unsigned program = glCreateProgram();
  glProgramBinary(program, format, entry->data() + format_bytes, static_cast<GLsizei>(entry->size() - format_bytes));
  GLint good = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good) return program;
  glDeleteProgram(program);
  while (glGetError() != GL_NO_ERROR) {  // an unknown format is an answer, not a failure of what comes next
  }
  return 0;
}

void store_program_binary(const std::string& name, const std::string& key, unsigned program) {
  GLint formats = 0, size = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
  if (formats < 1 || size < 1) return;
  Bytes entry(format_bytes + static_cast<std::size_t>(size));
  GLenum format = 0;
  glGetProgramBinary(program, size, nullptr, &format, entry.data() + format_bytes);
  std::memcpy(entry.data(), &format, format_bytes);
  Cache::global().write(kind_of(name), key, entry);
}

}  // namespace bin_scenes::gl
