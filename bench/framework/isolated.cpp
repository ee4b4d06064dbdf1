#include "framework/isolated.hpp"

#include "bin_scenes/core/error.hpp"

#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>

namespace bin_scenes::bench {

namespace {

constexpr double wall_per_cpu = 30.0;  ///< a process that waits longer than this for its CPU time hangs

// A row goes through the pipe as a table with this behind it, which one cut short by a crash lacks.
constexpr char end_of_row = '\0';

std::string packed(const Row& row) {
  Table table;
  table.add(row);
  return (row.cells().empty() ? std::string() : to_csv(table)) + end_of_row;
}

bool unpack(std::string text, Row& row) {
  if (text.empty() || text.back() != end_of_row) return false;
  text.pop_back();
  if (!text.empty()) row = from_csv(text, "a row's process").row(0);
  return true;
}

[[noreturn]] void child(const std::function<Row()>& work, int pipe, double limit_cpu_s) {
  const auto limit = static_cast<rlim_t>(std::max(1.0, std::ceil(limit_cpu_s)));
  const rlimit cpu{limit, limit + 1};
  ::setrlimit(RLIMIT_CPU, &cpu);  // SIGXCPU when it is spent
  std::string answer;
  int code = 0;
  try {
    answer = packed(work());
  } catch (const std::exception& error) {
    answer = packed(Row().status(std::string("failed: ") + error.what()));
    code = 1;
  }
  for (std::size_t sent = 0; sent < answer.size();) {
    const ssize_t n = ::write(pipe, answer.data() + sent, answer.size() - sent);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  std::_Exit(code);  // no destructors of what the parent shares: files, folders, streams
}

/// What the child writes until it closes the pipe or the time is over (false).
bool receive(int pipe, double limit_s, std::string& text) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limit_s);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd wait{pipe, POLLIN, 0};
    if (left.count() <= 0 || ::poll(&wait, 1, static_cast<int>(left.count())) == 0) return false;
    char buffer[4096];
    const ssize_t n = ::read(pipe, buffer, sizeof buffer);
    if (n <= 0) return true;
    text.append(buffer, static_cast<std::size_t>(n));
  }
}

double resident_mb() {
  std::ifstream file("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  return 1e-6 * resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double cpu_seconds_of(const rusage& usage) {
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

}  // namespace

Isolated isolated(const std::function<Row()>& work, double limit_cpu_s) {
  std::fflush(nullptr);  // or the child would print it again
  int ends[2];
  if (::pipe(ends) != 0) throw environment_error(std::strerror(errno), "pipe", "close some files");
  const double before_mb = resident_mb();
  const pid_t pid = ::fork();
  if (pid < 0) throw environment_error(std::strerror(errno), "fork", "free some memory");
  if (pid == 0) {
    ::close(ends[0]);
    child(work, ends[1], limit_cpu_s);
  }
  ::close(ends[1]);
  Isolated result;
  std::string text;
  const bool in_time = receive(ends[0], wall_per_cpu * limit_cpu_s, text);
  ::close(ends[0]);
  if (!in_time) ::kill(pid, SIGKILL);
  int status = 0;
  rusage usage{};
  ::wait4(pid, &status, 0, &usage);
  result.peak_mb = static_cast<double>(usage.ru_maxrss) * 1024e-6;
  result.added_mb = std::max(0.0, result.peak_mb - before_mb);
  const bool whole = unpack(text, result.row);
  result.good = whole && in_time && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!in_time || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU))
    result.row = Row().status("stopped after " + Row::text(cpu_seconds_of(usage)) + " s of CPU time");
  else if (WIFSIGNALED(status))
    result.row = Row().status(std::string("crashed: ") + ::strsignal(WTERMSIG(status)));
  else if (!whole)
    result.row = Row().status("ended without a result");
  return result;
}

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return cpu_seconds_of(usage);
}

}  // namespace bin_scenes::bench
