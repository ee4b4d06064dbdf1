#include "stress/trial.hpp"

#include "bin_scenes/core/error.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <sstream>

namespace bin_scenes::stress {

namespace {

// The child sends one line of figures, one of the device, one a flag and one a failure.

constexpr char flag_mark = '!', failure_mark = '-';

void send(int pipe, const Outcome& o) {
  std::ostringstream out;
  out.precision(17);
  out << o.penetration << ' ' << o.drift << ' ' << o.energy << ' ' << o.simulated_s << ' ' << o.steps << ' '
      << o.growth_bytes << ' ' << o.pace << ' ' << o.parts << ' ' << o.resting << '\n'
      << o.device << '\n';
  const auto list = [&](char mark, const std::vector<std::string>& lines) {
    for (std::string line : lines) {
      std::replace(line.begin(), line.end(), '\n', ' ');
      out << mark << line << '\n';
    }
  };
  list(flag_mark, o.flags);
  list(failure_mark, o.failures);
  const std::string text = out.str();
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t n = write(pipe, text.data() + sent, text.size() - sent);
    if (n <= 0) return;
    sent += static_cast<std::size_t>(n);
  }
}

std::string receive(int pipe) {
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(pipe, buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  return text;
}

Outcome parse(const std::string& text) {
  Outcome o;
  std::istringstream in(text);
  std::string line;
  in >> o.penetration >> o.drift >> o.energy >> o.simulated_s >> o.steps >> o.growth_bytes >> o.pace >> o.parts >>
      o.resting;
  std::getline(in, line);
  std::getline(in, o.device);
  while (std::getline(in, line)) (line[0] == flag_mark ? o.flags : o.failures).push_back(line.substr(1));
  return o;
}

[[noreturn]] void child(int pipe, const std::string& yaml, const std::string& directory, const Expect& expect,
                        const Limits& limits) {
  const auto seconds = static_cast<rlim_t>(std::ceil(limits.cpu_s));
  const rlimit cpu{seconds, seconds + 5}, no_core{0, 0};
  setrlimit(RLIMIT_CPU, &cpu);
  setrlimit(RLIMIT_CORE, &no_core);
  send(pipe, run_here(yaml, directory, expect));
  close(pipe);
  _exit(0);  // what the parent opened is the parent's to close
}

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

Outcome run_apart(const std::string& yaml, const std::string& directory, const Expect& expect, const Limits& limits) {
  int ends[2];
  if (pipe(ends) != 0) throw environment_error(std::strerror(errno), "pipe", "close other programs");
  const pid_t process = fork();
  if (process < 0) throw environment_error(std::strerror(errno), "fork", "close other programs");
  if (process == 0) {
    close(ends[0]);
    child(ends[1], yaml, directory, expect, limits);
  }
  close(ends[1]);
  const std::string text = receive(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(process, &status, 0, &used);
  Outcome outcome = parse(text);
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    outcome.failures.push_back(signal == SIGXCPU || signal == SIGKILL
                                   ? "stopped after " + with("", limits.cpu_s) + " s of CPU time"
                                   : "crashed with signal " + std::to_string(signal));
  } else if (text.empty()) {
    outcome.failures.push_back("ended without a word, exit code " + std::to_string(WEXITSTATUS(status)));
  }
  outcome.cpu_s = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  outcome.peak_mb = static_cast<double>(used.ru_maxrss) / 1024.0;
  return outcome;
}

}  // namespace bin_scenes::stress
