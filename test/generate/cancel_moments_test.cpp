/// Cancels requests that are busy in one phase each, at random moments, as a node does whose client is gone.
///
///     cancel_moments_test [--moments N] [--seed S]
///
/// Each has to end by Error(cancelled). How long that took is printed: wall time, so look at it on an idle machine.
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/generate/generator.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>

namespace {

using namespace bin_scenes;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A ball of `rings` rings with bumps, as ASCII STL.
std::string write_ball(const fs::path& path, int rings, double bumps) {
  const auto point = [&](int i, int k) {
    const double polar = M_PI * i / rings, turn = M_PI * k / rings;
    const double r = 0.02 * (1 + bumps * std::sin(7 * turn) * std::pow(std::sin(polar), 2) * std::sin(5 * polar));
    return Vec3(r * std::sin(polar) * std::cos(turn), r * std::sin(polar) * std::sin(turn), r * std::cos(polar));
  };
  std::ofstream out(path);
  const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3* v : {&a, &b, &c}) out << "vertex " << v->x() << ' ' << v->y() << ' ' << v->z() << '\n';
    out << "endloop\nendfacet\n";
  };
  out << "solid ball\n";
  out.precision(9);
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < 2 * rings; ++k) {
      const int next = (k + 1) % (2 * rings);
      if (i + 1 < rings) facet(point(i, k), point(i + 1, k), point(i + 1, next));
      if (i > 0) facet(point(i, k), point(i + 1, next), point(i, next));
    }
  out << "endsolid\n";
  return path.string();
}

struct Case {
  Request request;
  bool render = false, cold = false;  ///< cold: nothing is in the cache
};

std::map<std::string, Case> cases(const fs::path& folder) {
  const std::string ball = write_ball(folder / "ball.stl", 8, 0.0), fine = write_ball(folder / "fine.stl", 200, 0.05),
                    bumpy = write_ball(folder / "bumpy.stl", 24, 0.15);
  const auto heap = [](const std::string& model, std::size_t count, SolverType type) {
    Case c;
    c.request.bin.inner_size = Vec3(0.3, 0.3, 0.3);
    c.request.parts.emplace_back();
    c.request.parts[0].model = c.request.parts[0].path = model;
    c.request.parts[0].unit = Unit::metre;
    c.request.parts[0].count = count;
    c.request.solver.type = type;
    return c;
  };
  const auto overlap = [&](SolverType type, int count) {
    Case c = heap(ball, count, type);
    c.request.bin.kind = Bin::Kind::floor;
    c.request.pour.pattern = Pour::Pattern::given;
    for (int i = 0; i < count; ++i)
      c.request.parts[0].poses.push_back({Vec3(1e-4 * (i % 100), 1e-4 * (i / 100), 0.1), Quat::Identity()});
    return c;
  };
  std::map<std::string, Case> all;
  all["loading"] = heap(fine, 3, SolverType::sphere);
  all["decomposition"] = heap(bumpy, 3, SolverType::bullet);
  all["loading"].cold = all["decomposition"].cold = true;
  all["overlap, sphere"] = overlap(SolverType::sphere, 5000);
  all["overlap, bullet"] = overlap(SolverType::bullet, 700);
  all["many scenes"] = heap(ball, 20, SolverType::bullet);
  all["many scenes"].request.scenes = 200'000'000;
  all["judging"] = heap(fine, 30, SolverType::sphere);
  all["judging"].request.seconds = 0.05;
  all["rendering"] = heap(ball, 60, SolverType::bullet);
  all["rendering"].render = true;
  all["rendering"].request.seconds = 0.1;
  all["rendering"].request.sensors.emplace_back();
  all["rendering"].request.sensors[0].width = 1600;
  all["rendering"].request.sensors[0].height = 1200;
  all["shaders"] = heap(ball, 5, SolverType::sphere);
  all["shaders"].request.solver.sphere.device = SphereSettings::Device::gpu;
  all["thesis"] = heap(ball, 5, SolverType::sphere);
  all["thesis"].request.solver.preset = SolverSettings::Preset::thesis;
  all["shaders"].cold = all["thesis"].cold = true;
  return all;
}

/// Seconds from the cancel to the end; negative: it was over before. `after`: s from the start to the cancel.
double cancel_once(const Case& c, double after) {
  std::atomic<bool> flag{false};
  Clock::time_point set;
  std::thread timer([&] {
    const Clock::time_point at = Clock::now() + std::chrono::microseconds(static_cast<long>(1e6 * after));
    std::this_thread::sleep_until(at);
    set = Clock::now();
    flag = true;
  });
  bool cancelled = false;
  Clock::time_point end;
  try {
    Generator generator;
    Generator::Options options;
    options.render = c.render;
    options.hooks.cancel = &flag;
    generator.generate(c.request, options, [](Generator::Result&&) {});
  } catch (const Error& error) {
    cancelled = error.kind() == ErrorKind::cancelled;
    if (!cancelled) std::fprintf(stderr, "not cancelled, but: %s\n", error.what());
  }
  end = Clock::now();
  timer.join();
  return cancelled ? std::chrono::duration<double>(end - set).count() : -1.0;
}

}  // namespace

int main(int argc, char** argv) {
  int moments = 9;
  int seed = 1;
  for (int i = 1; i + 1 < argc; i += 2) (std::string(argv[i]) == "--seed" ? seed : moments) = std::atoi(argv[i + 1]);
  std::string name = (fs::temp_directory_path() / "bin_scenes_moments_XXXXXX").string();
  if (!mkdtemp(name.data())) return 1;
  const fs::path folder(name);
  const std::map<std::string, Case> all = cases(folder);
  std::map<std::string, std::vector<double>> times;
  Random random(static_cast<std::uint64_t>(seed), 0, Stream::pour);
  auto next = all.begin();
  for (int i = 0; i < moments; ++i) {
    const fs::path cache = folder / (next->second.cold ? "cold" : "warm");
    if (next->second.cold) fs::remove_all(cache);
    setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    setenv("MESA_SHADER_CACHE_DIR", cache.c_str(), 1);
    const double moment = random.uniform();
    times[next->first].push_back(cancel_once(next->second, 0.05 + 6.0 * moment * moment));
    if (++next == all.end()) next = all.begin();
  }
  fs::remove_all(folder);
  std::size_t cancelled = 0;
  std::printf("%-18s %5s %8s %8s\n", "request", "n", "median s", "max s");
  for (auto& [request, values] : times) {
    values.erase(std::remove_if(values.begin(), values.end(), [](double s) { return s < 0.0; }), values.end());
    std::sort(values.begin(), values.end());
    cancelled += values.size();
    if (values.empty()) continue;
    std::printf("%-18s %5zu %8.3f %8.3f\n", request.c_str(), values.size(), values[values.size() / 2], values.back());
  }
  return cancelled > 0 ? 0 : 1;
}
