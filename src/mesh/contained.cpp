#include "contained.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>

namespace bin_scenes {

namespace {

constexpr int exit_no_memory = 3;

bool write_all(int file, const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = write(file, from, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    from += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// What comes out of the child until its end; less if the work is no longer wanted.
std::string read_to_end(int file) {
  constexpr int patience_ms = 50;
  std::string all;
  char buffer[1 << 16];
  while (!cancelled()) {
    pollfd ready{file, POLLIN, 0};
    if (poll(&ready, 1, patience_ms) <= 0) continue;
    const ssize_t n = read(file, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    all.append(buffer, static_cast<std::size_t>(n));
  }
  return all;
}

/// Bytes of address space that this process has now.
rlim_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

[[noreturn]] void child(const std::function<std::string()>& work, const ContainedLimits& limits, pid_t parent,
                        int out) {
  // It dies with the thread that waits for it.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  // The limit counts processor time, so that a busy machine does not change what can be read.
  const rlimit cpu{limits.cpu_seconds, limits.cpu_seconds + 1}, no_core{0, 0};
  const rlim_t bytes = address_space() + limits.bytes;
  const rlimit memory{bytes, bytes};
  setrlimit(RLIMIT_CPU, &cpu);
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_AS, &memory);
  // What a library prints when it gives up would stand beside the one message that its failure becomes.
  dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDERR_FILENO);
  for (const int caught : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGXCPU, SIGINT, SIGTERM, SIGALRM})
    signal(caught, SIG_DFL);
  std::string output;
  try {
    output = work();
  } catch (const std::bad_alloc&) {
    _exit(exit_no_memory);
  }
  const std::uint64_t size = output.size();
  const bool sent = write_all(out, &size, sizeof size) && write_all(out, output.data(), output.size());
  // No destructors, no exit handlers: they belong to the parent.
  _exit(sent ? 0 : 1);
}

}  // namespace

Contained run_contained(const std::function<std::string()>& work, const ContainedLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw environment_error(std::string("no pipe: ") + std::strerror(errno), "", "close other programs or files");
  }
  const pid_t parent = getpid(), pid = fork();
  if (pid < 0) {
    const std::string reason = std::strerror(errno);
    close(ends[0]);
    close(ends[1]);
    throw environment_error("no process can be started: " + reason, "", "close other programs");
  }
  if (pid == 0) child(work, limits, parent, ends[1]);
  close(ends[1]);
  Contained result;
  result.output = read_to_end(ends[0]);
  close(ends[0]);
  if (cancelled()) kill(pid, SIGKILL);
  int status = 0;
  pid_t waited;
  do waited = waitpid(pid, &status, 0);
  while (waited < 0 && errno == EINTR);

  stop_if_cancelled();

  // What arrived decides, not the status: a host that ignores SIGCHLD gets none.
  std::uint64_t size = 0;
  if (result.output.size() >= sizeof size) {
    std::memcpy(&size, result.output.data(), sizeof size);
    result.finished = result.output.size() == sizeof size + size;
  }
  if (result.finished) {
    BIN_SCENES_ASSERT(result.failure.empty());
    result.output.erase(0, sizeof size);
    return result;
  }
  result.output.clear();
  if (waited == pid && WIFEXITED(status) && WEXITSTATUS(status) == exit_no_memory) {
    result.failure = "wanted more than " + std::to_string(limits.bytes >> 20) + " MiB of memory";
  } else if (waited == pid && WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    result.failure = signal == SIGXCPU ? "did not finish within " + std::to_string(limits.cpu_seconds) + " s"
                                       : std::string("crashed (") + strsignal(signal) + ")";
  } else {
    result.failure = "ended early";
  }
  BIN_SCENES_ASSERT(!result.finished && !result.failure.empty());
  return result;
}

}  // namespace bin_scenes
