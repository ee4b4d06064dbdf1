/// Noise and CPU time of colour pictures (sensor model `image`) by number of samples, in four heaps with different
/// lamps. The error of a picture is the rms of its difference from a picture with many samples, in shares of white.
#include "framework/benchmark.hpp"

#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "runs.hpp"

#include <cmath>
#include <fstream>
#include <functional>

namespace bin_scenes::bench {
namespace {

ImageLamp lamp_of(ImageLamp::Type type, double radiance) {
  ImageLamp lamp;
  lamp.type = type;
  lamp.radiance = radiance;
  return lamp;
}

/// A rectangle that shines from above on the middle of the bin's floor.
ImageLamp panel(const Vec3& place, double width, double height, double radiance, const Vec3& colour = Vec3::Ones()) {
  ImageLamp lamp = lamp_of(ImageLamp::Type::area, radiance);
  lamp.pose = Pose{place, Quat::FromTwoVectors(Vec3::UnitZ(), -place)};
  lamp.width = width, lamp.height = height;
  lamp.colour = colour;
  return lamp;
}

/// The sky over a hall: dim walls, a bright window and a small, very bright sun. Radiance file without runs.
std::string hall(const std::string& folder) {
  constexpr int width = 64, height = 32;
  std::ofstream file(folder + "/hall.hdr", std::ios::binary);
  file << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << height << " +X " << width << "\n";
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool window = x >= 40 && x < 52 && y >= 6 && y < 14, sun = x == 10 && y == 5;
      const int exponent = sun ? 136 : window ? 130 : 125;  // factors of 2^(exponent - 128)
      for (const int byte : {160, window ? 190 : 150, window ? 220 : 140, exponent}) file.put(static_cast<char>(byte));
    }
  }
  return folder + "/hall.hdr";
}

struct Heap {
  std::string name, part;
  std::size_t count;
  Surface surface, bin;
  std::vector<ImageLamp> lamps;
  bool table = false;
};

std::vector<Heap> heaps(const std::string& scratch) {
  const Surface steel{0.95, 0.95, 0.45, 2.9, 3.1}, dark{0.1, 0.05, 0.5}, white{0.7, 0.0, 0.5};
  Surface satin{0.8, 0.3, 0.4}, brass{0.95, 0.95, 0.3, 0.45, 2.5};
  satin.colour = Vec3(0.2, 0.5, 1.0), brass.colour = Vec3(1.0, 0.8, 0.4);
  using Type = ImageLamp::Type;
  ImageLamp sky = lamp_of(Type::dome, 1.0);
  sky.picture = hall(scratch);
  return {{"steel, ring and dome", "nut_hex", 60, steel, dark, {lamp_of(Type::ring, 20.0), lamp_of(Type::dome, 0.05)}},
          {"brass, panel and dome, table",
           "conrod",
           12,
           brass,
           dark,
           {panel({0.4, 0.2, 1.0}, 0.5, 0.15, 1.0), lamp_of(Type::dome, 0.08)},
           true},
          {"satin, four panels",
           "ring_24",
           40,
           satin,
           white,
           {panel({0.5, 0.0, 0.6}, 0.3, 0.3, 1.0), panel({-0.5, 0.1, 0.8}, 0.1, 0.6, 2.0, {1.0, 0.8, 0.6}),
            panel({0.0, 0.6, 0.7}, 0.4, 0.1, 2.0), panel({0.1, -0.5, 0.5}, 0.1, 0.1, 5.0)}},
          {"matte, picture of a hall, table", "mug", 8, white, white, {sky}, true}};
}

Request request_of(const Heap& heap, bool quick) {
  Request request = bin_of(heap.part, heap.count);
  request.bin.surface = heap.bin;
  request.parts.front().surface = heap.surface;
  if (heap.table) request.table.height = -0.005;
  Sensor sensor;
  sensor.model = "image";
  sensor.width = quick ? 120 : 240, sensor.height = quick ? 90 : 180;
  sensor.fov = 0.2;
  sensor.bounces = 1;
  sensor.noise = false;
  const Vec3 eye(0.15, 0.1, 0.7);
  sensor.pose = Pose{eye, Quat::FromTwoVectors(Vec3::UnitZ(), Vec3(0.0, 0.0, 0.03) - eye)};
  auto& settings = sensor.settings.of<ImageSettings>();
  settings.colour = true;
  settings.bits = 16;
  settings.lamps = heap.lamps;
  request.sensors = {sensor};
  return request;
}

/// Renders pictures of one heap.
class Camera {
 public:
  explicit Camera(Poured& poured) : poured_(poured) { poured_.scene.sensors = resolved_sensors(poured_.loaded); }
  std::vector<std::uint16_t> picture(int samples, bool denoise, std::uint64_t seed) {
    auto& settings = poured_.scene.sensors.front().settings.of<ImageSettings>();
    settings.samples = samples, settings.denoise = denoise;
    poured_.scene.seed = seed;
    return rig_.render(poured_.scene, poured_.loaded).front().picture.counts;
  }

 private:
  Poured& poured_;
  SensorRig rig_;
};

double rms(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b) {
  double square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) square += std::pow((a[i] - b[i]) / 65535.0, 2);
  return std::sqrt(square / static_cast<double>(a.size()));
}

void run(Run& out) {
  const int many = out.quick() ? 256 : 1024;
  const std::uint64_t seeds = out.quick() ? 2 : 4;
  for (const Heap& heap : heaps(out.scratch())) {
    const auto key = [&](int samples, bool denoise) {
      return Row::keys("heap", heap.name, "samples", samples, "denoise", denoise ? "yes" : "no");
    };
    bool any = false;
    for (const int samples : {8, 16, 32, 64})
      for (const bool denoise : {false, true}) any = any || out.wanted(key(samples, denoise));
    if (!any) continue;
    Poured poured = pour_timed(request_of(heap, out.quick()));
    Camera camera(poured);
    const std::vector<std::uint16_t> truth = camera.picture(many, false, 1000);
    for (const bool denoise : {false, true}) {
      for (const int samples : {8, 16, 32, 64}) {
        if (!out.wanted(key(samples, denoise))) continue;
        std::vector<double> errors, cpu;
        for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
          const Clock clock;
          const std::vector<std::uint16_t> picture = camera.picture(samples, denoise, seed);
          cpu.push_back(clock.cpu_s());
          errors.push_back(100.0 * rms(picture, truth));
        }
        out.row(key(samples, denoise).measure("rms_percent", errors).measure("cpu_s", cpu));
      }
    }
  }
}

const Registration registration{"pictures",
                                "noise and CPU seconds of colour pictures by number of samples",
                                {"heap", "samples", "denoise"},
                                run,
                                "src/light src/raster src/sensor"};

}  // namespace
}  // namespace bin_scenes::bench
