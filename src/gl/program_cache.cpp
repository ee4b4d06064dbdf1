#include "program_cache.hpp"

#include <epoxy/gl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace bin_scenes::gl {

namespace fs = std::filesystem;

namespace {

// FNV-1a; the second basis makes 128 bits of two.
constexpr std::uint64_t basis = 0xcbf29ce484222325ULL, second_basis = 0x9ae16a3b2f90404fULL;
std::uint64_t hash(const void* data, std::size_t size, std::uint64_t h = basis) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) h = (h ^ bytes[i]) * 0x100000001b3ULL;
  return h;
}

/// Before the binary in the file: enough to recognize a complete file of this key.
struct Header {
  char magic[8] = {'b', 's', 'p', 'r', 'o', 'g', '0', '1'};
  std::uint64_t key[2] = {0, 0};
  std::uint64_t size = 0, checksum = 0;
  std::uint64_t format = 0;
};

Header header_of(const std::string& key) {
  Header header;
  header.key[0] = hash(key.data(), key.size());
  header.key[1] = hash(key.data(), key.size(), second_basis);
  return header;
}

fs::path file_of(const std::string& name, const Header& header) {
  if (const char* off = std::getenv("BIN_SCENES_CACHE"); off && std::strcmp(off, "off") == 0) return {};
  fs::path cache;
  if (const char* set = std::getenv("XDG_CACHE_HOME"); set && *set) {
    cache = set;
  } else if (const char* home = std::getenv("HOME"); home && *home) {
    cache = fs::path(home) / ".cache";
  } else {
    return {};
  }
  char hashed[40];
  std::snprintf(hashed, sizeof hashed, "-%016llx%016llx", static_cast<unsigned long long>(header.key[0]),
                static_cast<unsigned long long>(header.key[1]));
  return cache / "bin_scenes" / "programs" / (name + hashed);
}

}  // namespace

unsigned load_program_binary(const std::string& name, const std::string& key) {
  const Header wanted = header_of(key);
  const fs::path path = file_of(name, wanted);
  std::ifstream in(path, std::ios::binary);
  Header header;
  if (path.empty() || !in.read(reinterpret_cast<char*>(&header), sizeof header)) return 0;
  std::error_code failed;
  if (std::memcmp(header.magic, wanted.magic, sizeof header.magic) || header.key[0] != wanted.key[0] ||
      header.key[1] != wanted.key[1] || fs::file_size(path, failed) != sizeof header + header.size)
    return 0;
  std::vector<char> binary(header.size);
  if (!in.read(binary.data(), static_cast<std::streamsize>(binary.size())) ||
      hash(binary.data(), binary.size()) != header.checksum)
    return 0;
  const unsigned program = glCreateProgram();
  glProgramBinary(program, static_cast<GLenum>(header.format), binary.data(), static_cast<GLsizei>(binary.size()));
  GLint good = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good) return program;
  glDeleteProgram(program);
  while (glGetError() != GL_NO_ERROR) {  // an unknown format is an answer, not a failure of what comes next
  }
  return 0;
}

void store_program_binary(const std::string& name, const std::string& key, unsigned program) {
  Header header = header_of(key);
  const fs::path path = file_of(name, header);
  GLint formats = 0, size = 0;
  glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
  glGetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
  if (path.empty() || formats < 1 || size < 1) return;
  std::vector<char> binary(static_cast<std::size_t>(size));
  GLenum format = 0;
  glGetProgramBinary(program, size, nullptr, &format, binary.data());
  header.size = binary.size();
  header.checksum = hash(binary.data(), binary.size());
  header.format = format;

  // Written beside and renamed, so that another process never reads half a file.
  std::error_code failed;
  fs::create_directories(path.parent_path(), failed);
  const fs::path beside = path.string() + "." + std::to_string(getpid());
  {
    std::ofstream out(beside, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(binary.data(), static_cast<std::streamsize>(binary.size()));
    out.close();
    if (!out) {
      fs::remove(beside, failed);
      return;
    }
  }
  fs::rename(beside, path, failed);
}

}  // namespace bin_scenes::gl
