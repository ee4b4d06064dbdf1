/// Times a standard heap on CPU and GPU, keeps the figures on disk, and predicts by the number of parts which is
/// faster.
#include "solver/device_choice.hpp"

#include "bin_scenes/core/cache.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/core/random.hpp"
#include "bin_scenes/core/sha256.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "core/formatted.hpp"
#include "solver/sphere/sphere_solver.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <sstream>
#include <thread>

namespace bin_scenes {

namespace {

constexpr double clearly = 0.8;           ///< the GPU's time / the CPU's, at most
constexpr int settling = 80, timed = 20;  ///< steps
constexpr const char* kind = "device";
const std::string format = "2\n";  ///< another one for another heap or another meaning

/// An angle iron of 60 x 40 x 20 mm: concave, and known in closed form.
PartModelPtr angle_iron() {
  constexpr double outline[6][2] = {{0, 0}, {0.06, 0}, {0.06, 0.01}, {0.01, 0.01}, {0.01, 0.04}, {0, 0.04}};
  Mesh mesh;
  for (const double z : {0.0, 0.02})
    for (const auto& [x, y] : outline) mesh.vertices.emplace_back(x, y, z);
  for (const auto& [a, b, c] : {Triangle{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + 6, b + 6, c + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  return PartModel::from_mesh(mesh, "angle iron");
}

/// Loose layers that fall into a narrow bin.
WorldId add_heap(Solver& solver, const PartModelPtr& part, std::size_t parts) {
  const auto side = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(parts))));
  constexpr double pitch = 0.08;
  WorldDef def;
  def.parts = {part};
  def.bin.kind = Bin::Kind::box;
  const double width = static_cast<double>(side) * pitch;
  def.bin.inner_size = Vec3(width, width, width);
  def.wall_height = 3.0 * width;
  BodyDef body;
  body.mass = 0.05;
  def.bodies.assign(parts, body);
  const WorldId world = solver.add_world(def);
  Random random(1, parts, Stream::pour);
  for (std::size_t i = 0; i < parts; ++i) {
    const Vec3 place(static_cast<double>(i % side), static_cast<double>(i / side % side),
                     static_cast<double>(i / (side * side)));
    BodyState state;
    state.pose.position = pitch * (place + Vec3(0.5, 0.5, 0.5)) - Vec3(0.5 * width, 0.5 * width, 0.0);
    state.pose.orientation = random.orientation();
    state.velocity.linear = Vec3(0, 0, -1.0);
    solver.insert(world, i, state);
  }
  return world;
}

/// s a step, all worlds together.
double step_time(Solver& solver, const PartModelPtr& part, std::size_t parts, std::size_t worlds) {
  std::vector<WorldId> ids;
  for (std::size_t i = 0; i < worlds; ++i) ids.push_back(add_heap(solver, part, parts));
  solver.advance(ids, settling * solver.step_size());
  const auto begin = std::chrono::steady_clock::now();
  solver.advance(ids, timed * solver.step_size());
  const double spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const WorldId id : ids) solver.remove_world(id);
  return spent / timed;
}

StepTimes step_times(const std::function<std::unique_ptr<Solver>(std::size_t)>& make, const PartModelPtr& part,
                     double share) {
  const auto scaled = [&](std::size_t count) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(count)));
  };
  StepTimes times;
  const std::unique_ptr<Solver> small = make(scaled(DeviceFigures::few));
  times.few_s = step_time(*small, part, scaled(DeviceFigures::few), 1);
  const std::size_t worlds = scaled(DeviceFigures::worlds);
  times.together_s = step_time(*small, part, scaled(DeviceFigures::few), worlds) / static_cast<double>(worlds);
  const std::unique_ptr<Solver> large = make(scaled(DeviceFigures::many));
  times.many_s = step_time(*large, part, scaled(DeviceFigures::many), 1);
  return times;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) == 0 && line.find(':') + 2 < line.size()) {
      return line.substr(line.find(':') + 2) + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
    }
  }
  return "unknown processor";
}

/// A GPU shows itself by a device file; asking OpenGL costs tenths of a second.
bool device_file() {
  std::error_code none;
  for (const char* folder : {"/dev/dri", "/dev"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind("renderD", 0) == 0 || name == "nvidia0") return true;
    }
  }
  return false;
}

std::string text_of(const DeviceFigures& figures) {
  std::ostringstream text;
  text.precision(17);
  for (const StepTimes& t : {figures.on_cpu, figures.on_gpu})
    text << t.few_s << ' ' << t.many_s << ' ' << t.together_s << '\n';
  return text.str();
}
bool read(const std::string& text, DeviceFigures& figures) {
  std::istringstream in(text);
  for (StepTimes* t : {&figures.on_cpu, &figures.on_gpu}) in >> t->few_s >> t->many_s >> t->together_s;
  return !in.fail();
}

std::string in_ms(double seconds) {
  return formatted("%.3g ms", 1e3 * seconds);
}

/// s a step and scene.
double predicted(const StepTimes& t, std::size_t parts, std::size_t scenes) {
  const double size = std::max(1.0, static_cast<double>(parts)) / DeviceFigures::few;
  const double grows = std::log(t.many_s / t.few_s) /
                       std::log(static_cast<double>(DeviceFigures::many) / static_cast<double>(DeviceFigures::few));
  const double alone = t.few_s * std::pow(size, std::clamp(grows, 0.0, 1.5));
  const double together = static_cast<double>(std::min(scenes, DeviceFigures::worlds));
  // Worlds together fill a device: from there on, their time grows with their parts.
  return std::max(alone / together, t.together_s * size);
}

}  // namespace

DeviceChoice choose_device(const DeviceFigures& figures, std::size_t parts, std::size_t scenes) {
  const double cpu = scenes > 1
                         ? std::min(predicted(figures.on_cpu, parts, 1), predicted(figures.on_cpu, parts, scenes))
                         : predicted(figures.on_cpu, parts, 1);
  const double gpu = predicted(figures.on_gpu, parts, std::max<std::size_t>(scenes, 1));
  DeviceChoice choice;
  choice.gpu = gpu < clearly * cpu;
  choice.reason = std::string(choice.gpu ? "on the GPU" : "on the CPU") + ": a step of " + std::to_string(parts) +
                  (parts == 1 ? " part" : " parts") + " takes about " + in_ms(cpu) + " on the CPU, " + in_ms(gpu) +
                  " on the GPU (standard heap, measured on this machine)";
  return choice;
}

DeviceFigures measure_devices(double share) {
  const std::shared_ptr<gl::Device> device = gl::Device::shared();
  device->make_current();
  DeviceFigures figures;
  figures.cpu = processor();
  figures.gpu = device->renderer() + ", " + device->version();
  const PartModelPtr part = angle_iron();
  figures.on_cpu = step_times([](std::size_t) { return make_sphere_solver({}); }, part, share);
  figures.on_gpu = step_times(
      [](std::size_t bodies) {
        sphere_gl::Capacity capacity;
        capacity.bodies = bodies;
        return make_gl_sphere_solver({}, capacity);
      },
      part, share);
  return figures;
}

std::optional<DeviceFigures> device_figures() {
  if (!device_file()) return std::nullopt;
  try {
    const std::shared_ptr<gl::Device> device = gl::Device::shared();
    if (device->software()) return std::nullopt;
    DeviceFigures figures;
    figures.cpu = processor();
    figures.gpu = device->renderer() + ", " + device->version();
    const std::string key = sha256_hex(format + figures.cpu + "\n" + figures.gpu);
    const auto known = Cache::global().read(kind, key);
    if (known && read(std::string(known->data(), known->data() + known->size()), figures)) return figures;
    figures = measure_devices();
    const std::string text = text_of(figures);
    Cache::global().write(kind, key, Bytes(text.begin(), text.end()));
    return figures;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) throw;
    return std::nullopt;  // a GPU that cannot do it is none
  }
}

DeviceChoice choose_device(const Request& request) {
  const std::size_t bodies = request.part_count() + (request.bin.kind == Bin::Kind::mesh ? 1 : 0);
  const bool moves = request.bin.motion.any() || std::any_of(request.parts.begin(), request.parts.end(),
                                                             [](const PartLine& line) { return line.motion.any(); });
  if (moves) return {false, "on the CPU: motion is not simulated on the GPU"};
  if (bodies > most_gl_bodies())
    return {false, "on the CPU: the GPU form takes at most " + std::to_string(most_gl_bodies()) +
                       " bodies per scene, this one has " + std::to_string(bodies)};
  // Of each thread, as the device is: a loss of it is met by a new one.
  thread_local const std::optional<DeviceFigures> figures = device_figures();
  if (!figures) return {false, "on the CPU: there is no GPU with OpenGL 4.5"};
  return choose_device(*figures, bodies, request.scenes);
}

}  // namespace bin_scenes
