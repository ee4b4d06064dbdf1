#include "bin_scenes/part/cache.hpp"

#include <pwd.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

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

std::string digest_of(const std::string& name, const Bytes& bytes) {
  Bytes all(name.begin(), name.end());
  all.push_back(0);
  all.insert(all.end(), bytes.begin(), bytes.end());
  return sha256_hex(all.data(), all.size());
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

std::optional<Bytes> Cache::read(const std::string& kind, const std::string& key) const {
  const std::string folder = directory();
  if (folder.empty()) return std::nullopt;
  const std::string name = file_name(kind, key);
  std::ifstream file(fs::path(folder) / name, std::ios::binary | std::ios::ate);
  if (!file) return std::nullopt;
  const std::streamoff length = file.tellg();
  Header header;
  const Header expected;
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(&header), sizeof header)) return std::nullopt;
  if (std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0) return std::nullopt;
  if (length < 0 || header.size != static_cast<std::uint64_t>(length) - sizeof header) return std::nullopt;
  Bytes bytes(header.size);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    return std::nullopt;
  }
  if (digest_of(name, bytes) != std::string(header.digest, sizeof header.digest)) return std::nullopt;
  return bytes;
}

void Cache::write(const std::string& kind, const std::string& key, const Bytes& bytes) const {
  const std::string folder = directory();
  if (folder.empty()) return;
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return;

  const std::string name = file_name(kind, key);
  const std::string target = (fs::path(folder) / name).string();
  // A name of its own for each writer; rename makes the file appear whole or not at all.
  std::string temporary = target + ".XXXXXX";
  const int descriptor = mkstemp(temporary.data());
  if (descriptor < 0) return;
  close(descriptor);

  Header header;
  header.size = bytes.size();
  digest_of(name, bytes).copy(header.digest, sizeof header.digest);
  std::ofstream file(temporary, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) {
    fs::rename(temporary, target, failed);
    if (!failed) return;
  }
  fs::remove(temporary, failed);
}

}  // namespace bin_scenes
