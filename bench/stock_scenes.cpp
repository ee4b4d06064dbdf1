/// Scenes as published scripts make them, as a BOP data set for `bin_scenes audit`: all parts start on a grid above the
/// bin, stock Bullet simulates ten seconds, whatever lies there then is the scene.
///
///     bin_scenes_bench_stock REQUEST.yaml OUT SCENES
#include "bin_scenes/bop/bop_writer.hpp"
#include "bin_scenes/config/request_reader.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/pour/heap.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "peers/stock_bullet.hpp"
#include "runs.hpp"

#include <cstdio>
#include <filesystem>

namespace bin_scenes::bench {

namespace {

/// BlenderProc's example for the BOP challenge: friction 100, damping 0.99, up to 10 s, 20 substeps of 1/24 s, 25
/// iterations (examples/datasets/bop_challenge/main_*.py, DLR-RM/BlenderProc, github.com).
StockBullet as_published(const std::vector<PartModelPtr>& parts) {
  StockBullet settings;
  settings.time_step = 1.0 / 480.0;
  settings.iterations = 25;
  settings.damping = 0.99;
  for (const PartModelPtr& part : parts) {
    settings.pieces.emplace_back();
    for (const Mesh& hull : part->hulls({}).hulls) settings.pieces.back().push_back(hull.vertices);
  }
  return settings;
}

void make(const std::string& file, const std::string& out, std::size_t scenes) {
  Request request = read_request(file);
  request.pour.pattern = Pour::Pattern::grid;
  request.seconds = 10.0;
  for (PartLine& line : request.parts) line.friction = 100.0;
  const LoadedRequest loaded = bench::loaded(request);
  SensorRig rig;
  for (std::size_t i = 0; i < scenes; ++i) {
    Heap heap(loaded, make_stock_bullet(as_published(loaded.parts)), i);
    heap.settle();
    Scene scene = heap.scene();
    scene.sensors = resolved_sensors(loaded);
    const std::vector<RangeImage> images = rig.render(scene, loaded);
    char name[32];
    std::snprintf(name, sizeof name, "/train/%06zu", i);
    write_bop(out + name, scene, loaded.parts, images);
  }
  write_bop_models(out + "/models", loaded.parts);
}

}  // namespace

}  // namespace bin_scenes::bench

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "bin_scenes_bench_stock REQUEST.yaml OUT SCENES\n");
    return 2;
  }
  try {
    bin_scenes::bench::make(argv[1], argv[2], std::stoul(argv[3]));
  } catch (const bin_scenes::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.kind());
  }
  return 0;
}
