/// Prints one line for each thing that the tool needs, with its remedy, and lets each solver drop a box. Exit code 3
/// without OpenGL.
#include "bin_scenes/core/cache.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/mesh/mesh_loader.hpp"
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/pour/pour.hpp"
#include "solver/device_choice.hpp"
#include "tool/commands.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace bin_scenes {

namespace {

void line(const char* what, bool good, const std::string& found, const std::string& advice = "") {
  std::printf("%-9s %-4s %s\n", what, good ? "ok" : "--", found.c_str());
  if (!good && !advice.empty()) std::printf("%-9s      advice: %s\n", "", advice.c_str());
}

/// True if a context can be made.
bool report_devices() {
  for (const gl::DeviceInfo& device : gl::Device::enumerate()) {
    const std::string kind = device.software ? " (software)" : "";
    line("egl", device.usable, device.name + kind + ": " + (device.usable ? device.renderer : device.detail),
         "install the driver of this device, or ignore it if another one is ok");
  }
  try {
    const gl::Device& device = gl::Device::current();
    const gl::Limits& limits = device.limits();
    line("gl", true, device.renderer() + ", " + device.version());
    std::printf("%-9s      %d storage blocks, %lld MiB a buffer, %d KiB shared, %d invocations, %d groups an axis\n",
                "", limits.storage_blocks, limits.storage_bytes >> 20, limits.shared_bytes >> 10, limits.invocations,
                limits.groups_per_axis);
    if (device.software()) {
      std::printf(
          "%-9s      advice: this is the CPU; for a GPU install its driver with EGL (in a container: with the "
          "graphics capability)%s\n",
          "", std::getenv("BIN_SCENES_GL") ? ", and unset BIN_SCENES_GL" : "");
    }
    return true;
  } catch (const Error& error) {
    line("gl", false, error.problem(), "install libegl1 and libgl1-mesa-dri, or the GPU's own driver");
    return false;
  }
}

std::string in_ms(const StepTimes& t) {
  std::ostringstream text;
  text.precision(3);
  text << 1e3 * t.few_s << " ms alone, " << 1e3 * t.together_s << " ms among " << DeviceFigures::worlds << "; of "
       << DeviceFigures::many << " parts " << 1e3 * t.many_s << " ms";
  return text.str();
}

/// What `auto` decides by.
void report_choice() {
  const auto figures = device_figures();
  if (!figures) {
    line("auto", true, "takes sphere on the CPU: there is no GPU with OpenGL 4.5");
    return;
  }
  line("auto", true, "takes sphere on the device that needs less time for a step of the standard heap");
  std::printf("%-9s      %zu parts on the CPU (%s): %s\n", "", DeviceFigures::few, figures->cpu.c_str(),
              in_ms(figures->on_cpu).c_str());
  std::printf("%-9s      %zu parts on the GPU (%s): %s\n", "", DeviceFigures::few, figures->gpu.c_str(),
              in_ms(figures->on_gpu).c_str());
}

PartModelPtr box(double edge) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(edge * (Vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1) - Vec3::Constant(0.5)));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return PartModel::from_mesh(mesh, "box");
}

/// A box of 5 cm let go a little above an endless floor has to lie on it: its centre at half an edge.
void test_solver(const char* name, SolverType type, SolverSettings::Preset preset) {
  constexpr double cube_edge = 0.05;
  // The thesis's floor is a lattice of spheres, here of 2.5 mm, in whose hollows a face rests: r (2 - sqrt 2) lower.
  const double tolerance = preset == SolverSettings::Preset::thesis ? 1.6e-3 : 1e-3;
  try {
    Request request;
    request.bin.kind = Bin::Kind::floor;
    request.solver.type = type;
    request.solver.preset = preset;
    request.pour.pattern = Pour::Pattern::given;
    request.pour.limit = 5.0;
    request.parts.emplace_back();
    request.parts[0].model = "box";
    Pose start;
    start.position.z() = 0.5 * cube_edge + 0.01;
    request.parts[0].poses = {start};
    const std::vector<PartModelPtr> parts = {box(cube_edge)};
    std::string reason;
    const std::unique_ptr<Solver> solver = make_solver({request, parts}, reason);
    const Scene scene = pour({request, parts}, *solver, {0}).at(0);
    const double error = std::abs(scene.parts.at(0).pose.position.z() - 0.5 * cube_edge);
    std::ostringstream found;
    found << name << ": box " << (scene.report.at_rest ? "at rest" : "still moving") << " after "
          << scene.report.simulated_s << " s, height off by " << 1e3 * error << " mm, on " << solver->device();
    line("solver", scene.report.at_rest && error < tolerance, found.str(), "use another solver, and report this line");
  } catch (const Error& error) {
    line("solver", false, std::string(name) + ": " + error.what(), "use solver.type: bullet, which needs no GL");
  }
}

void report_cad() {
  line("cad", reads_cad(), reads_cad() ? "STEP and IGES are read" : "STEP and IGES are not read by this build",
       "install libocct-data-exchange-dev and build again, or export STL files");
}

void report_ros() {
  const char* distribution = std::getenv("ROS_DISTRO");
  const char* packages = std::getenv("ROS_PACKAGE_PATH");
  const bool built = static_cast<bool>(bag_writer());
  line("ros", built, built ? "built in: node, messages, bags and MCAP" : "not in this build",
       "for bags, MCAP and the node, install ros-core and build with -DBIN_SCENES_ROS=ON");
  std::printf("%-9s      ROS_DISTRO %s, ROS_PACKAGE_PATH %s\n", "", distribution ? distribution : "not set",
              packages ? packages : "not set (package:// paths will not be found)");
}

void report_cache() {
  const std::string directory = Cache::global().directory();
  if (directory.empty()) {
    line("cache", false, "off", "unset BIN_SCENES_CACHE, so that parts are prepared only once");
    return;
  }
  std::string place = directory;
  while (::access(place.c_str(), F_OK) != 0 && place.find('/', 1) != std::string::npos) {
    place.resize(place.find_last_of('/'));
  }
  line("cache", ::access(place.c_str(), W_OK) == 0, directory, "make it writable, or set XDG_CACHE_HOME");
}

}  // namespace

int doctor() {
  const bool gl = report_devices();
  report_choice();
  test_solver("bullet", SolverType::bullet, SolverSettings::Preset::standard);
  test_solver("sphere", SolverType::sphere, SolverSettings::Preset::standard);
  test_solver("sphere/thesis", SolverType::sphere, SolverSettings::Preset::thesis);
  report_cad();
  report_ros();
  report_cache();
  return gl ? exit_done : static_cast<int>(ErrorKind::environment);
}

}  // namespace bin_scenes
