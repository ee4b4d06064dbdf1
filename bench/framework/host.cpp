#include "framework/host.hpp"

#include "bin_scenes/gl/device.hpp"
#include "framework/isolated.hpp"

#include <cctype>
#include <ctime>
#include <fstream>
#include <regex>
#include <thread>

namespace bin_scenes::bench {

namespace {

struct Gl {
  std::string renderer, driver;
  bool software = true;
};

/// Asked in a process of its own: a benchmark may fork later, and contexts do not survive that.
const Gl& gl() {
  static const Gl known = [] {
    const auto ask = [] {
      const gl::Device device;
      return Row::keys("renderer", device.renderer(), "driver", device.version(), "software", device.software());
    };
    const Row row = isolated(ask, 60.0).row;
    Gl found{row.at("renderer"), row.at("driver"), row.at("software") != "no"};
    if (found.renderer.empty()) found.renderer = "none (" + row.at("status") + ")";
    return found;
  }();
  return known;
}

std::string cpu() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

/// "Intel(R) Xeon(R) Processor" without its trade marks, as bench/publish has it.
std::string short_cpu() {
  return std::regex_replace(cpu(), std::regex(R"(\((R|TM|tm)\)| (Processor|CPU).*)"), "");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> host() {
  char date[32];
  const std::time_t now = std::time(nullptr);
  std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
  return {{"cpu", cpu()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"gl", gl().renderer},
          {"driver", gl().driver},
          {"version", BIN_SCENES_BENCH_VERSION},
          {"commit", commit()},
          {"date", date}};
}

std::string commit() {
  return BIN_SCENES_BENCH_COMMIT;
}

bool has_gpu() {
  return !gl().software;
}

std::string device_slug() {
  const std::string cores = std::to_string(std::thread::hardware_concurrency()) + " cores";
  const std::string name = has_gpu() ? gl().renderer : short_cpu() + " " + cores;
  std::string slug;
  for (const char c : name) {
    if (c == '/' || c == '(') break;  // "NVIDIA H200/PCIe/SSE2": bus and instruction set are not the device
    if (std::isalnum(static_cast<unsigned char>(c)))
      slug += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!slug.empty() && slug.back() != '-')
      slug += '-';
  }
  while (!slug.empty() && slug.back() == '-') slug.pop_back();
  return slug;
}

}  // namespace bin_scenes::bench
