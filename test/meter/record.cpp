/// Records the dispatches of one step of a settled heap, each into FOLDER/<pass>: what test/meter/card_test.cpp
/// compares with the times of a card.
///   bin_scenes_record_dispatches HEAP.json PART.stl settle|press|probe FOLDER PASS...
#include "bin_scenes/output/scene_writer.hpp"
#include "bin_scenes/part/part_model.hpp"
#include "meter/recording.hpp"
#include "pour/settling.hpp"
#include "solver/sphere_gl/gl_sphere_solver.hpp"

#include <algorithm>
#include <cstdio>

using namespace bin_scenes;

int main(int count, char** words) {
  if (count < 6) {
    std::fprintf(stderr, "usage: bin_scenes_record_dispatches HEAP.json PART.stl PHASE FOLDER PASS...\n");
    return 2;
  }
  const std::vector<ScenePart> heap = read_scene_json(words[1]).parts;
  const std::string phase = words[3], folder = words[4];
  const std::vector<std::string> passes(words + 5, words + count);
  LoadOptions options;
  options.unit = Unit::millimetre;
  WorldDef def;
  def.parts = {PartModel::load(words[2], options)};
  BodyDef body;
  body.mass = 7850.0 * def.parts.front()->mass().volume;
  def.bodies.assign(heap.size(), body);
  def.bin.inner_size = Vec3(0.40, 0.30, 0.20);
  def.wall_height = 1.0;

  meter::Watch watch;
  watch.on_taken = [&](const meter::Taken& taken, const races::Module&) {
    if (std::find(passes.begin(), passes.end(), taken.pass) != passes.end()) save(taken, folder + "/" + taken.pass);
  };
  sphere_gl::Capacity capacity;
  capacity.world_group = 256;
  capacity.pair_group = 32;
  capacity.bodies = heap.size();
  capacity.as_on_card = true;
  const auto solver = make_gl_sphere_solver({}, capacity);
  const WorldId world = solver->add_world(def);
  solver->set_phase(world, phase == "press" ? phases::press : phase == "probe" ? phases::probe : phases::settle);
  for (std::size_t i = 0; i < heap.size(); ++i) solver->insert(world, i, {heap[i].pose, {}});
  solver->advance({world}, 4 * solver->step_size());
  watch.begin();
  solver->advance({world}, solver->step_size());
}
