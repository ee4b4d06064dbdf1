/// Forks workers, hands out numbers of heaps and hears one line of JSON for each, over pipes. A worker that dies is
/// replaced and its heap is given again.
#include "dataset/workers.hpp"

#include "bin_scenes/core/assertion.hpp"

#include "bin_scenes/core/error.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>

namespace bin_scenes {

namespace {

constexpr std::size_t most_deaths = 10;  ///< of workers on one heap
constexpr int patience_ms = 250;         ///< between two looks at the clock

[[noreturn]] void serve(int socket, std::size_t threads, const std::function<nlohmann::json(std::size_t)>& work) {
  // The cores are shared by processes: in each, work that could use all cores keeps to its share.
  const tbb::global_control share(tbb::global_control::max_allowed_parallelism, std::max<std::size_t>(1, threads));
  std::uint64_t heap = 0;
  while (recv(socket, &heap, sizeof heap, MSG_WAITALL) == static_cast<ssize_t>(sizeof heap)) {
    nlohmann::json answer;
    try {
      answer = work(heap);
    } catch (const Error& error) {
      answer = {{"heap", heap},
                {"error", error.problem()},
                {"where", error.where()},
                {"remedy", error.remedy()},
                {"kind", static_cast<int>(error.kind())}};
    } catch (const std::bad_alloc&) {
      answer = {{"heap", heap},
                {"error", "out of memory"},
                {"where", "a worker"},
                {"remedy", "use fewer --workers"},
                {"kind", static_cast<int>(ErrorKind::environment)}};
    } catch (const std::exception& error) {
      answer = {{"heap", heap},
                {"error", error.what()},
                {"where", "a worker"},
                {"remedy", "report it as a defect"},
                {"kind", static_cast<int>(ErrorKind::environment)}};
    }
    const std::string line = answer.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    for (std::size_t sent = 0; sent < line.size();) {
      const ssize_t n = send(socket, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
      if (n <= 0) _exit(1);
      sent += static_cast<std::size_t>(n);
    }
  }
  _exit(0);
}

}  // namespace

Workers::Workers(std::size_t count, std::function<nlohmann::json(std::size_t)> work,
                 std::function<void(const std::string&)> warn)
    : work_(std::move(work)), warn_(std::move(warn)), workers_(count) {}

Workers::~Workers() {
  for (Worker& worker : workers_) end(worker);
}

int Workers::end(Worker& worker) {
  if (worker.pid < 0) return 0;
  int status = 0;
  kill(worker.pid, SIGKILL);
  close(worker.socket);
  while (waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) {
  }
  worker.pid = worker.socket = -1;
  worker.line.clear();
  return status;
}

void Workers::start(Worker& worker) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw environment_error(std::string("no socket for a worker: ") + std::strerror(errno), "workers",
                            "use fewer --workers");
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0)
    throw environment_error(std::string("no process for a worker: ") + std::strerror(errno), "workers",
                            "use fewer --workers");
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);  // it died before it could be watched
    signal(SIGINT, SIG_IGN);            // of a terminal: the parent decides
    signal(SIGTERM, SIG_DFL);
    close(ends[0]);
    for (const Worker& other : workers_)
      if (other.socket >= 0) close(other.socket);
    serve(ends[1], std::thread::hardware_concurrency() / workers_.size(), work_);
  }
  close(ends[1]);
  worker.pid = pid;
  worker.socket = ends[0];
}

void Workers::give(Worker& worker, std::size_t heap) {
  if (worker.pid < 0) start(worker);
  if (worker.heap != heap) worker.deaths = 0;
  worker.heap = heap;
  BIN_SCENES_ASSERT(worker.pid >= 0 && worker.socket >= 0);
  const std::uint64_t number = heap;
  if (send(worker.socket, &number, sizeof number, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof number)) return;
  hear(worker, {});  // it died while it waited
}

void Workers::hear(Worker& worker, const std::function<void(const nlohmann::json&)>& done) {
  char text[65536];
  const ssize_t n = recv(worker.socket, text, sizeof text, 0);
  if (n > 0) {
    worker.line.append(text, static_cast<std::size_t>(n));
    if (worker.line.back() != '\n') return;
    const nlohmann::json answer = nlohmann::json::parse(worker.line);
    worker.line.clear();
    worker.heap.reset();
    done(answer);
    return;
  }
  if (n < 0 && errno == EINTR) return;
  BIN_SCENES_ASSERT(worker.heap && worker.pid >= 0);
  const std::size_t heap = *worker.heap;
  const std::string name = "worker " + std::to_string(worker.pid);
  const int status = end(worker);
  const std::string how = WIFSIGNALED(status) ? " was killed by signal " + std::to_string(WTERMSIG(status))
                                              : " ended with code " + std::to_string(WEXITSTATUS(status));
  if (++worker.deaths > most_deaths)
    throw environment_error(
        "workers died " + std::to_string(worker.deaths) + " times while they made heap " + std::to_string(heap),
        "workers", "look for the out-of-memory killer (dmesg), or use fewer --workers");
  if (warn_) warn_(name + how + " while it made heap " + std::to_string(heap) + ", which is made again");
  give(worker, heap);
}

void Workers::run(const std::function<std::optional<std::size_t>()>& next,
                  const std::function<void(const nlohmann::json&)>& done, const std::atomic<bool>& stop,
                  const std::function<void()>& idle) {
  bool more = true;
  while (!stop) {
    std::vector<pollfd> polled;
    std::vector<Worker*> busy;
    for (Worker& worker : workers_) {
      if (!worker.heap && more) {
        const std::optional<std::size_t> heap = next();
        if (heap) give(worker, *heap);
        more = heap.has_value();
      }
      if (!worker.heap) continue;
      polled.push_back({worker.socket, POLLIN, 0});
      busy.push_back(&worker);
    }
    if (busy.empty()) return;
    BIN_SCENES_ASSERT(polled.size() == busy.size());
    const int ready = poll(polled.data(), polled.size(), patience_ms);
    for (std::size_t i = 0; ready > 0 && i < busy.size(); ++i)
      if (polled[i].revents != 0) hear(*busy[i], done);
    idle();
  }
}

}  // namespace bin_scenes
