#include "bin_scenes/core/cache.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/temporary.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <system_error>
#include <utility>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

/// What stands before the contents in a cache file. The name is hashed with the contents, so that a file copied to
/// another key does not pass for it.
struct Header {
  char magic[8] = {'B', 'S', 'c', 'a', 'c', 'h', 'e', '1'};
  std::uint64_t size = 0;
  char digest[64] = {};  // SHA-256 in hex
};

std::string digest_of(const std::string& name, const void* data, std::size_t size) {
  return Sha256().add(name.c_str(), name.size() + 1).add(data, size).hex();
}

std::string file_name(const std::string& kind, const std::string& key) {
  return kind + "-" + sha256_hex(key);
}

}  // namespace

Cache& Cache::global() {
  static Cache cache;
  return cache;
}

std::string Cache::directory() const {
  const char* on = std::getenv("BIN_SCENES_CACHE");
  if (on && std::string(on) == "off") return {};
  // The XDG base directory specification has relative paths ignored.
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg && xdg[0] == '/') return (fs::path(xdg) / "bin_scenes").string();
  const char* home = std::getenv("HOME");
  if (!home || home[0] != '/') {
    const passwd* user = getpwuid(getuid());
    home = user ? user->pw_dir : nullptr;
  }
  if (!home || home[0] != '/') return {};
  return (fs::path(home) / ".cache" / "bin_scenes").string();
}

CachedBytes::CachedBytes(void* mapping, std::size_t length, std::size_t before)
    : mapping_(mapping),
      length_(length),
      data_(static_cast<const std::uint8_t*>(mapping) + before),
      size_(length - before) {}

CachedBytes::CachedBytes(CachedBytes&& other) noexcept
    : mapping_(std::exchange(other.mapping_, nullptr)),
      length_(other.length_),
      data_(other.data_),
      size_(other.size_) {}

CachedBytes::~CachedBytes() {
  if (mapping_) munmap(mapping_, length_);
}

std::optional<CachedBytes> Cache::read(const std::string& kind, const std::string& key) const {
  const std::string folder = directory();
  if (folder.empty()) return std::nullopt;
  const std::string name = file_name(kind, key);
  const int descriptor = open((fs::path(folder) / name).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return std::nullopt;
  struct stat status;
  const bool whole = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
                     static_cast<std::size_t>(status.st_size) >= sizeof(Header);
  const std::size_t length = whole ? static_cast<std::size_t>(status.st_size) : 0;
  // Safe from writers: they put a new file in place, and never change one.
  void* mapping = whole ? mmap(nullptr, length, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor, 0) : MAP_FAILED;
  close(descriptor);
  if (mapping == MAP_FAILED) return std::nullopt;
  CachedBytes bytes(mapping, length, sizeof(Header));
  Header header;
  const Header expected;
  std::memcpy(&header, mapping, sizeof header);
  if (std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0 || header.size != bytes.size() ||
      digest_of(name, bytes.data(), bytes.size()) != std::string(header.digest, sizeof header.digest)) {
    return std::nullopt;
  }
  return bytes;
}

void Cache::write(const std::string& kind, const std::string& key, const Bytes& bytes) const {
  const std::string folder = directory();
  if (folder.empty()) return;
  BIN_SCENES_ASSERT(!kind.empty() && !key.empty());
  const std::string name = file_name(kind, key);
  const fs::path target = fs::path(folder) / name;
  std::error_code failed;
  fs::create_directories(target.parent_path(), failed);
  if (failed) return;

  // Each writer works under a name of its own; a cache that loses power may lose what it holds, so nothing waits for
  // it.
  static std::once_flag once;
  std::call_once(once, [&] { remove_leftovers(folder); });
  Temporary file(target.string());
  Header header;
  header.size = bytes.size();
  digest_of(name, bytes.data(), bytes.size()).copy(header.digest, sizeof header.digest);
  std::ofstream out(file.path(), std::ios::binary);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) return;
  fs::rename(file.path(), target, failed);
}

}  // namespace bin_scenes
