/// Wall and CPU seconds of a view by each sensor model. What models err by, test/sensor holds to closed forms and to a
/// ray cast in double precision.
#include "framework/benchmark.hpp"

#include "bin_scenes/config/plan.hpp"
#include "bin_scenes/sensor/image_settings.hpp"
#include "bin_scenes/sensor/models.hpp"
#include "bin_scenes/sensor/resolve.hpp"
#include "bin_scenes/sensor/sensor_rig.hpp"
#include "raster/stage.hpp"
#include "runs.hpp"
#include "sensor/targets.hpp"

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
  const Row key = Row().key("what", what);
  if (!out.wanted(key)) return;
  work();
  std::vector<double> wall, cpu;
  for (int i = 0; i < (out.quick() ? 1 : 5); ++i) {
    const Clock clock;
    work();
    wall.push_back(clock.wall_s());
    cpu.push_back(clock.cpu_s());
  }
  out.row(Row(key)
              .measure("wall_s", wall)
              .measure("cpu_s", cpu)
              .info("goal", goal_s > 0.0 ? "at most " + Row::text(goal_s) : std::string()));
}

struct Case {
  const char* what;
  double goal_s;  ///< 0: none
  const char* model;
  Fidelity fidelity;
  int bounces;
  bool heap;  ///< of 50 parts, else 256 balls
};
constexpr Fidelity analytic = Fidelity::analytic, decoded = Fidelity::decoded;
constexpr Case cases[] = {
    {"ideal 1280 x 1024, all truth", 0.4, "ideal", analytic, 0, false},
    {"structured light, analytic", 0.6, "structured_light", analytic, 0, false},
    {"structured light, analytic, 50 parts", 0.15, "structured_light", analytic, 0, true},
    {"structured light, analytic, 50 parts, bounces 1", 0.0, "structured_light", analytic, 1, true},
    {"structured light, analytic, 50 parts, bounces 2", 0.0, "structured_light", analytic, 2, true},
    {"laser line, 1000 profiles, 50 parts, bounces 0", 0.0, "laser_line", analytic, 0, true},
    {"laser line, 1000 profiles, 50 parts, bounces 1", 0.0, "laser_line", analytic, 1, true},
    {"structured light, decoded", 3.0, "structured_light", decoded, 0, false},
    {"laser line, 1000 profiles", 1.0, "laser_line", analytic, 0, false},
    {"stereo 848 x 480, 128 disparities, matched", 0.5, "stereo", decoded, 0, false},
    {"stereo 848 x 480, analytic", 0.0, "stereo", analytic, 0, false},
    {"time of flight", 0.0, "time_of_flight", analytic, 0, false}};

Sensor sensor_of(const Case& c) {
  Sensor sensor;
  sensor.model = c.model;
  sensor.fidelity = c.fidelity;
  sensor.bounces = c.bounces;
  sensor.width = 1280, sensor.height = 1024;
  if (sensor.model == "stereo") sensor.width = 848, sensor.height = 480;
  sensor.fov = 0.4;
  sensor.near = 0.5, sensor.far = 2.0;
  sensor.pose = Pose();
  return sensor;
}

/// A grey image of a heap of steel, with its truth.
void image_time(Run& out, test::Stage& heap, int samples, bool denoise) {
  Sensor sensor = sensor_of({"", 0.0, "image", analytic, 2, true});
  sensor.height = 976;
  auto& settings = sensor.settings.of<ImageSettings>();
  settings.samples = samples, settings.denoise = denoise;
  settings.lamps.resize(2);
  settings.lamps[0].type = ImageLamp::Type::ring;
  settings.lamps[1].type = ImageLamp::Type::dome;
  settings.lamps[1].radiance = 0.01;
  for (PartLine& line : heap.request.parts) line.surface = {0.95, 0.95, 0.45, 2.9, 3.1};
  heap.request.parts[0].surface = {0.3, 0.1, 0.4};  // the plate
  heap.scene.sensors = {resolved(sensor, heap.request.bin)};
  SensorRig rig;
  const std::string what = "image 1280 x 976, 50 parts, " + std::to_string(samples) + " samples, bounces 2";
  const auto take = [&] { rig.render(heap.scene, {heap.request, heap.models}); };
  time(out, denoise ? what + ", denoised" : what, denoise ? 0.0 : 3.0, take);
}

/// The image that users of a preset get: that of the plan by which the throughput of data sets is measured, with the
/// preset's defaults, without its bounce, and without its blur as well.
void preset_times(Run& out) {
  const std::string what = "preset structured_light_0.65m_590mm, 1280 x 976, 50 parts", dark = what + ", bounces 0",
                    sharp = dark + ", blur 0";
  const auto asked = [&](const std::string& row) { return out.wanted(Row().key("what", row)); };
  if (!asked(what) && !asked(dark) && !asked(sharp)) return;
  Poured poured = pour_timed(read_plan(Run::plan("throughput")).reference);
  poured.scene.sensors = resolved_sensors(poured.loaded);
  SensorRig rig;
  const auto timed = [&](const std::string& row) {
    time(out, row, 0.0, [&] { rig.render(poured.scene, poured.loaded); });
  };
  timed(what);
  poured.scene.sensors.front().bounces = 0;
  timed(dark);
  poured.scene.sensors.front().imager.blur = 0.0;
  timed(sharp);
}

void run(Run& out) {
  preset_times(out);
  test::Stage balls, heap;
  add_balls(balls);
  add_heap(heap);
  SensorRig rig;
  for (const Case& c : cases) {
    test::Stage& stage = c.heap ? heap : balls;
    stage.scene.sensors = {resolved(sensor_of(c), stage.request.bin)};
    time(out, c.what, c.goal_s, [&] { rig.render(stage.scene, {stage.request, stage.models}); });
  }
  image_time(out, heap, 16, false);
  image_time(out, heap, 4, true);
  const Scenery scenery = balls.scenery();
  const Sensor& sensor = balls.scene.sensors[0];
  const View view =
      render(scenery, lens_of(resolved(sensor_of(cases[0]), balls.request.bin)), Pose(), sensor.near, sensor.far);
  time(out, "silhouettes of 256 parts alone", 0.4, [&] { silhouettes(scenery, view, sensor.near, sensor.far); });
}

const Registration registration{"sensors",
                                "wall and CPU seconds of a view by each sensor model",
                                {"what"},
                                run,
                                "src/core src/light src/mesh src/raster src/sensor"};

}  // namespace
}  // namespace bin_scenes::bench
