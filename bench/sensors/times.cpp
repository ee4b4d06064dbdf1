/// Times of views, silhouettes, sensor models and images.
#include "sensors/rows.hpp"
#include "sensors/stage.hpp"

#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "runs.hpp"
#include "sensor/stage.hpp"

#include <functional>

namespace bin_scenes::bench {
namespace {

/// 256 balls of 5,120 triangles above a plate, all in the image.
void add_balls(test::Stage& stage) {
  stage.place(stage.model(box_target({4.0, 4.0, 0.02})), test::at(0, 0, 1.06));
  const std::size_t line = stage.model(ball_target(0.013, 4));
  stage.request.parts[line].surface = {0.5, 0.1, 0.4};
  Random random(1, 0, Stream::probe);
  for (int i = 0; i < 256; ++i) {
    const Vec3 place(0.025 * (i % 16 - 7.5), 0.02 * (i / 16 - 7.5), random.uniform(0.95, 1.03));
    stage.place(line, {place, random.orientation()});
  }
}

/// 50 boxes and rings in all poses on a plate.
void add_heap(test::Stage& stage) {
  stage.place(stage.model(box_target({4.0, 4.0, 0.02})), test::at(0, 0, 1.06));
  const std::size_t lines[] = {stage.model(test::box_mesh({0.07, 0.05, 0.03})),
                               stage.model(test::torus_mesh(0.03, 0.01, 48, 24))};
  Random random(2, 0, Stream::probe);
  for (int i = 0; i < 50; ++i) {
    const Vec3 place(random.uniform(-0.17, 0.17), random.uniform(-0.13, 0.13), random.uniform(0.95, 1.03));
    stage.place(lines[i % 2], {place, random.orientation()});
  }
}

/// Several runs after one that makes the search trees of the models. The goal is for two cores that do nothing else.
void time(Run& out, const std::string& what, double goal_s, const std::function<void()>& work) {
  const Figure figure{"time: " + what};
  if (!out.wanted(figure.key())) return;
  work();
  std::vector<double> wall, cpu;
  for (int i = 0; i < (out.quick() ? 1 : 5); ++i) {
    const Clock clock;
    work();
    wall.push_back(clock.wall_s());
    cpu.push_back(clock.cpu_s());
  }
  out.row(figure.key()
              .measure("wall_s", wall)
              .measure("cpu_s", cpu)
              .info("unit", "s")
              .info("goal", goal_s > 0.0 ? "at most " + Row::text(goal_s) : std::string()));
}

/// A grey image of a heap of steel, with its truth.
void image_time(Run& out, test::Stage& heap) {
  Sensor sensor;
  sensor.model = "image";
  sensor.width = 1280, sensor.height = 976;
  sensor.fov = 0.4;
  sensor.near = 0.5, sensor.far = 2.0;
  sensor.pose = Pose();
  sensor.bounces = 2;
  auto& lamps = sensor.settings.of<ImageSettings>().lamps;
  lamps.resize(2);
  lamps[0].type = ImageLamp::Type::ring;
  lamps[1].type = ImageLamp::Type::dome;
  lamps[1].radiance = 0.01;
  std::vector<PartLine>& lines = heap.request.parts;
  const std::vector<PartLine> before = lines;
  for (PartLine& line : lines) line.surface = {0.95, 0.95, 0.45, 2.9, 3.1};
  lines[0].surface = {0.3, 0.1, 0.4};  // the plate
  heap.scene.sensors = {resolved(sensor, heap.request.bin)};
  SensorRig rig;
  time(out, "image 1280 x 976, 50 parts, 16 samples, bounces 2", 3.0, [&] {
    rig.render(heap.scene, {heap.request, heap.models});
  });
  lines = before;
}

void view_times(Run& out) {
  test::Stage stage, heap;
  add_balls(stage);
  add_heap(heap);
  SensorRig rig;
  const auto whole_of = [&](test::Stage& stage, const std::string& what, double goal_s, const std::string& model,
                            Fidelity fidelity, int bounces = 0) {
    Sensor sensor;
    sensor.model = model;
    sensor.fidelity = fidelity;
    sensor.bounces = bounces;
    sensor.width = 1280, sensor.height = 1024;
    if (model == "stereo") sensor.width = 848, sensor.height = 480;
    sensor.fov = 0.4;
    sensor.near = 0.5, sensor.far = 2.0;
    sensor.pose = Pose();
    stage.scene.sensors = {resolved(sensor, stage.request.bin)};
    time(out, what, goal_s, [&] { rig.render(stage.scene, {stage.request, stage.models}); });
  };
  const auto whole = [&](const std::string& what, double goal_s, const std::string& model, Fidelity fidelity) {
    whole_of(stage, what, goal_s, model, fidelity);
  };
  whole("ideal 1280 x 1024, all truth", 0.4, "ideal", Fidelity::analytic);
  {
    const Scenery scenery = stage.scenery();
    const Sensor& sensor = stage.scene.sensors[0];
    const View view = render(scenery, lens_of(sensor), Pose(), sensor.near, sensor.far);
    time(out, "silhouettes of 256 parts alone", 0.4, [&] { silhouettes(scenery, view, sensor.near, sensor.far); });
  }
  whole("structured light, analytic", 0.6, "structured_light", Fidelity::analytic);
  whole_of(heap, "structured light, analytic, 50 parts", 0.15, "structured_light", Fidelity::analytic);
  for (const int bounces : {1, 2}) {
    whole_of(heap, "structured light, analytic, 50 parts, bounces " + std::to_string(bounces), 0.0, "structured_light",
             Fidelity::analytic, bounces);
  }
  for (const int bounces : {0, 1}) {
    whole_of(heap, "laser line, 1000 profiles, 50 parts, bounces " + std::to_string(bounces), 0.0, "laser_line",
             Fidelity::analytic, bounces);
  }
  image_time(out, heap);
  whole("structured light, decoded", 3.0, "structured_light", Fidelity::decoded);
  whole("laser line, 1000 profiles", 1.0, "laser_line", Fidelity::analytic);
  whole("stereo 848 x 480, 128 disparities, matched", 0.5, "stereo", Fidelity::decoded);
  whole("stereo 848 x 480, analytic", 0.0, "stereo", Fidelity::analytic);
  whole("time of flight", 0.0, "time_of_flight", Fidelity::analytic);
}

/// A scene with a noisy sensor of which no image is asked for.
void unasked(Run& out) {
  const Figure figure{"views, silhouettes and noisy images that nobody asked for"};
  if (!out.wanted(figure.key())) return;
  Request request = bin_of("bolt_hex", 8);
  Sensor sensor;
  sensor.model = "structured_light";
  request.sensors = {sensor};
  Generator::Options options;
  options.render = false;
  Generator().generate(request, options, [&](Generator::Result&& result) {
    double made = 0.0;
    for (const char* counter : {"views", "silhouettes", "noisy_images"}) {
      const auto found = result.scene.report.profile.counters.find(counter);
      if (found != result.scene.report.profile.counters.end()) made += static_cast<double>(found->second);
    }
    out.row(row_of(figure, made, "", "0"));
  });
}

}  // namespace

void time_rows(Run& out) {
  view_times(out);
  unasked(out);
}

}  // namespace bin_scenes::bench
