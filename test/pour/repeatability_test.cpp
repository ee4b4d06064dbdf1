/// Whole scenes of the default solver, poured, settled, pressed and probed until they rest: the same bits whatever runs
/// beside them. Threads of the GL driver and other processes: command_line_test.cpp; passes: sphere_gl/batch_test.cpp.
#include "bin_scenes/pour/pour.hpp"
#include "pour/stages.hpp"
#include "solver/fixture.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <map>

namespace bin_scenes::testing {

namespace {

using Device = SphereSettings::Device;

PartModelPtr angle() {
  static const PartModelPtr part = PartModel::from_mesh(
      merged(box_mesh({0.06, 0.02, 0.02}), box_mesh({0.02, 0.04, 0.02}, {0.02, 0.03, 0})), "angle");
  return part;
}

Request angles(std::size_t count, Device device) {
  Request request;
  request.seed = 5;
  request.solver.type = SolverType::sphere;
  request.solver.sphere.device = device;
  request.bin.inner_size = Vec3(0.16, 0.14, 0.12);
  request.parts.emplace_back();
  request.parts[0].model = "angle";
  request.parts[0].count = count;
  return request;
}

std::unique_ptr<Solver> solver_of(const Request& request) {
  std::string reason;
  return make_solver({request, {angle()}}, reason);
}

/// Scenes by their hash, and how many steps each took.
using Ends = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
Ends ends_of(const Request& request, Solver& solver, const std::vector<std::size_t>& indices) {
  Ends ends;
  for (const Scene& scene : pour({request, {angle()}}, solver, indices)) {
    EXPECT_TRUE(scene.report.at_rest);
    ends.emplace_back(scene.report.state_hash, scene.report.steps);
  }
  return ends;
}
Ends ends_of(const Request& request, const std::vector<std::size_t>& indices) {
  return ends_of(request, *solver_of(request), indices);
}

/// With so many threads, whatever the machine has.
Ends ends_with(int threads, const Request& request, const std::vector<std::size_t>& indices) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  return tbb::task_arena(threads).execute([&] { return ends_of(request, indices); });
}

/// Hands calls on, and counts the stages that worlds were put into.
class Watched : public Solver {
 public:
  explicit Watched(std::unique_ptr<Solver> solver) : solver_(std::move(solver)) {}
  std::map<Stage, int> stages;

  WorldId add_world(const WorldDef& def) override { return solver_->add_world(def); }
  void remove_world(WorldId id) override { solver_->remove_world(id); }
  void insert(WorldId id, std::size_t body, const BodyState& state) override { solver_->insert(id, body, state); }
  void remove(WorldId id, std::size_t body) override { solver_->remove(id, body); }
  bool set_phase(WorldId id, const Phase& phase) override {
    ++stages[stage_of(phase)];
    return solver_->set_phase(id, phase);
  }
  double advance(const std::vector<WorldId>& ids, double seconds) override { return solver_->advance(ids, seconds); }
  std::vector<BodyState> states(WorldId id) const override { return solver_->states(id); }
  std::vector<bool> asleep(WorldId id) const override { return solver_->asleep(id); }
  double step_size() const override { return solver_->step_size(); }
  std::uint64_t steps(WorldId id) const override { return solver_->steps(id); }
  const Profile& profile() const override { return solver_->profile(); }
  std::vector<Flag> flags(WorldId id) const override { return solver_->flags(id); }
  std::string name() const override { return solver_->name(); }
  std::string device() const override { return solver_->device(); }

 private:
  std::unique_ptr<Solver> solver_;
};

}  // namespace

class Repeatability : public ::testing::TestWithParam<Device> {};
INSTANTIATE_TEST_SUITE_P(Sphere, Repeatability, ::testing::Values(Device::cpu, Device::gpu),
                         [](const auto& info) { return info.param == Device::cpu ? "cpu" : "gpu"; });

TEST_P(Repeatability, ASceneIsTheSameAloneAndInAnyBatch) {
  const Request request = angles(5, GetParam());
  const Ends batch = ends_of(request, {0, 1, 2, 3, 4});  // more than are poured at once: places change hands
  EXPECT_NE(batch[0].first, batch[1].first) << "the hash does not see the scene";
  for (const std::size_t index : {0, 4}) EXPECT_EQ(ends_of(request, {index})[0], batch[index]) << index;
  EXPECT_EQ(ends_of(request, {4, 1}), (Ends{batch[4], batch[1]})) << "in another order, with other neighbours";
  Request other = request;
  other.seed = 6;
  EXPECT_NE(ends_of(other, {0})[0].first, batch[0].first);
}

TEST_P(Repeatability, ASceneGoesThroughEveryStage) {
  Request request = angles(5, GetParam());
  request.pour.finish = Pour::Finish::probed;
  Watched solver(solver_of(request));
  const Ends watched = ends_of(request, solver, {1});
  for (const Stage stage : {Stage::pour, Stage::settle, Stage::press, Stage::probe, Stage::verify})
    EXPECT_GT(solver.stages[stage], 0) << row(stage).name;
  EXPECT_EQ(watched, ends_of(request, {1})) << "observed at once, not while the device works on another";
}

// Worlds are shared among threads, and of one world pairs and bundles of manifolds, from 16 and 8 on.
TEST(SphereRepeatability, ThreadsChangeNothing) {
  const Request few = angles(5, Device::cpu);
  EXPECT_EQ(ends_with(1, few, {0, 1, 2, 3, 4}), ends_with(4, few, {0, 1, 2, 3, 4}));
  Request request = angles(60, Device::cpu);
  request.bin.inner_size = Vec3(0.24, 0.2, 0.12);
  const Ends alone = ends_with(1, request, {0});
  EXPECT_EQ(ends_with(2, request, {0}), alone);
  EXPECT_EQ(ends_with(2, request, {1, 0})[1], alone[0]);
}

// The worlds of a group are observed by all threads.
TEST(SphereRepeatability, ThreadsThatLookAtWorldsOfTheDeviceChangeNothing) {
  const Request request = angles(12, Device::gpu);
  EXPECT_EQ(ends_with(1, request, {0, 1, 2, 3, 4}), ends_with(4, request, {0, 1, 2, 3, 4}));
}

// Parts that lie apart are solved in blocks of 256 bodies and more, by any thread.
TEST(SphereRepeatability, ThreadsThatShareOneWideSceneChangeNothing) {
  Request request = angles(600, Device::cpu);
  request.bin.inner_size = Vec3(2.4, 2.4, 0.12);
  request.pour.pattern = Pour::Pattern::grid;
  EXPECT_EQ(ends_with(1, request, {0}), ends_with(2, request, {0}));
}

}  // namespace bin_scenes::testing
