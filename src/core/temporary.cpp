/// Files and folders are written under a hidden name that contains host and process, synced, and renamed. Names of
/// processes that no longer run are removed by later ones.
#include "bin_scenes/core/temporary.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "bin_scenes/core/error.hpp"

#include <fcntl.h>
#include <linux/fs.h>
#include <stdio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace bin_scenes {

namespace fs = std::filesystem;

namespace {

const std::string mark = ".tmp-";
const std::string aside = "-old";  ///< of a directory that steps aside for its successor

std::string host_name() {
  char name[256] = "unknown";
  gethostname(name, sizeof name - 1);
  return name;
}

/// What the name of a temporary states.
struct Writer {
  std::string target;  ///< name that it was to get
  pid_t pid = 0;
  bool here = false;
  bool is_old = false;
};
std::optional<Writer> writer_of(const std::string& name) {
  const std::size_t at = name.rfind(mark);
  const std::size_t host = name.rfind('@');
  if (name.empty() || name[0] != '.' || at == std::string::npos || host == std::string::npos || host < at) {
    return std::nullopt;
  }
  Writer writer;
  writer.target = name.substr(1, at - 1);
  const char* first = name.data() + at + mark.size();
  const auto [end, error] = std::from_chars(first, name.data() + host, writer.pid);
  if (error != std::errc() || *end != '-' || writer.pid <= 0) return std::nullopt;
  const std::string rest = name.substr(host + 1), here = host_name();
  writer.is_old = rest == here + aside;
  writer.here = rest == here || writer.is_old;
  return writer;
}

/// One that has ended and whose parent has not asked yet how is still a process, and writes nothing any more.
bool runs(pid_t pid) {
  if (kill(pid, 0) != 0 && errno == ESRCH) return false;
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(") ");
  return name_end == std::string::npos || text[name_end + 2] != 'Z';
}

bool in_a_temporary(const fs::path& path) {
  for (const fs::path& step : path.parent_path())
    if (writer_of(step.string())) return true;
  return false;
}

/// Best effort: some file systems cannot sync a directory, and say so.
bool sync_one(const fs::path& path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool good = fsync(descriptor) == 0 || errno == EINVAL;
  close(descriptor);
  return good;
}

/// Few files are synced one by one; for many, one pass over the file system costs less than a journal entry each.
bool sync_all(const fs::path& path) {
  constexpr int few = 8;
  if (!fs::is_directory(path)) return sync_one(path);
  std::vector<fs::path> inside{path};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
    inside.push_back(entry.path());
    if (inside.size() <= few) continue;
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const bool good = descriptor >= 0 && syncfs(descriptor) == 0;
    if (descriptor >= 0) close(descriptor);
    return good;
  }
  bool good = true;
  for (const fs::path& one : inside) good &= sync_one(one);
  return good;
}

}  // namespace

Temporary::Temporary(const std::string& target) : target_(fs::path(target).lexically_normal().string()) {
  static std::atomic<unsigned> number{0};
  const fs::path path(target_);
  path_ = (path.parent_path() / ("." + path.filename().string() + mark + std::to_string(getpid()) + "-" +
                                 std::to_string(number++) + "@" + host_name()))
              .string();
  std::error_code ignored;
  fs::remove_all(path_, ignored);  // of an earlier process with the same number
}

Temporary::~Temporary() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

void Temporary::commit() {
  const auto fail = [&](const std::string& why) {
    return environment_error("cannot be put in place: " + why, target_, "check permissions and free space");
  };
  BIN_SCENES_ASSERT(!path_.empty());  // else it was committed before
  const bool last = !in_a_temporary(target_);
  if (last && !sync_all(path_)) throw fail(std::strerror(errno));
  // A directory cannot be renamed over one that holds files: the two change places at once where the file system can do
  // that, else the old one steps aside first.
  std::error_code error;
  const bool replaces = fs::is_directory(target_, error);
  if (!replaces) {
    fs::rename(path_, target_, error);
    if (error) throw fail(error.message());
  } else if (renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) {
    fs::remove_all(path_, error);
  } else {
    const std::string old = path_ + aside;
    fs::rename(target_, old, error);
    if (!error) fs::rename(path_, target_, error);
    if (error) {
      const std::string why = error.message();
      fs::rename(old, target_, error);
      throw fail(why);
    }
    fs::remove_all(old, error);
  }
  path_.clear();
  const fs::path parent = fs::path(target_).parent_path();
  if (last) sync_one(parent.empty() ? fs::path(".") : parent);
}

std::size_t remove_leftovers(const std::string& directory) {
  std::size_t count = 0;
  std::error_code ignored;
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, ignored)) found.push_back(entry.path());
  for (const fs::path& path : found) {
    const std::optional<Writer> writer = writer_of(path.filename().string());
    if (!writer || !writer->here || runs(writer->pid)) continue;
    const fs::path target = path.parent_path() / writer->target;
    if (writer->is_old && !fs::exists(target, ignored)) {
      fs::rename(path, target, ignored);  // killed between two renames: this is the whole one
    } else {
      fs::remove_all(path, ignored);
    }
    ++count;
  }
  return count;
}

}  // namespace bin_scenes
