/// Which stages a pour goes through, by a solver whose parts do as they are told.
#include "bin_scenes/pour/pour.hpp"

#include "pour/small_boxes.hpp"
#include "pour/stages.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::testing {
namespace {

/// Its bodies hover where they are put, but for a jump of the first one some time into each of so many probes (or
/// presses after one) with a slide behind it, a swing of it to and fro in the first probe, and slow
/// creeping of the first one to begin with, or a slip of it as a verification begins; they fall asleep when they have
/// been probed for so long. Notes its phases.
class HoveringSolver : public Solver {
 public:
  struct Habits {
    int jumps = 0;
    Stage jumps_in = Stage::probe;
    double slips_in_verify_s = 0.0, jumps_at_s = 0.05, slides_s = 0.0, swings_s = 0.0, creeps_s = 0.0,
           sleeps_at_s = 0.0;
    bool heeds_phases = true, swings_fast = false;
  };
  explicit HoveringSolver(const Habits& habits) : habits_(habits) {}
  std::vector<Stage> phases;
  double probed_s = 0.0;  ///< in the last probe

  WorldId add_world(const WorldDef& def) override {
    states_.resize(def.bodies.size());
    return 0;
  }
  void remove_world(WorldId) override {}
  void insert(WorldId, std::size_t body, const BodyState& state) override { states_[body] = state; }
  void remove(WorldId, std::size_t) override {}
  bool set_phase(WorldId, const Phase& phase) override {
    phases.push_back(stage_of(phase));
    if (probes()) probed_s = 0.0;
    pressed_s_ = 0.0;
    jumped_ = false;
    return habits_.heeds_phases;
  }
  double advance(const std::vector<WorldId>&, double seconds) override {
    if (probes()) probed_s += seconds;
    if (!probes() && times_probed() > 0) pressed_s_ += seconds;
    const double asked_s = habits_.jumps_in == Stage::probe ? (probes() ? probed_s : 0.0) : pressed_s_;
    if (jumped_ && asked_s <= habits_.jumps_at_s + habits_.slides_s) states_[0].pose.position.x() += 0.1 * seconds;
    if (!jumped_ && habits_.jumps > 0 && asked_s > 0.0 && asked_s >= habits_.jumps_at_s) {
      states_[0].pose.position.x() += 1e-3;
      jumped_ = true;
      --habits_.jumps;
    }
    if (!phases.empty() && phases.back() == Stage::verify && verified_s_ < habits_.slips_in_verify_s) {
      states_[0].pose.position.x() += 0.1 * seconds;
      verified_s_ += seconds;
    }
    const bool swings = probes() && times_probed() == 1 && probed_s < habits_.swings_s;
    states_[0].velocity.linear.z() = swings && habits_.swings_fast ? -1.0 : 0.0;
    if (swings) {
      states_[0].pose.position.x() += swung_ ? -1e-3 : 1e-3;
      swung_ = !swung_;
    }
    if (habits_.creeps_s > 0.0) states_[0].pose.position.x() += 0.01 * seconds;
    habits_.creeps_s -= seconds;
    return seconds;
  }
  std::vector<BodyState> states(WorldId) const override { return states_; }
  std::vector<bool> asleep(WorldId) const override {
    return std::vector<bool>(states_.size(), probes() && probed_s >= habits_.sleeps_at_s);
  }
  double step_size() const override { return 1e-3; }
  std::uint64_t steps(WorldId) const override { return 0; }
  const Profile& profile() const override { return profile_; }
  std::vector<Flag> flags(WorldId) const override { return {}; }
  std::string name() const override { return "hovering"; }
  std::string device() const override { return "cpu"; }

 private:
  bool probes() const { return !phases.empty() && phases.back() == Stage::probe; }
  std::ptrdiff_t times_probed() const { return std::count(phases.begin(), phases.end(), Stage::probe); }

  Habits habits_;
  bool jumped_ = false, swung_ = false;
  double pressed_s_ = 0.0;  ///< in the last press after a probe
  double verified_s_ = 0.0;
  std::vector<BodyState> states_;
  Profile profile_;
};

struct Probed {
  std::vector<Stage> phases;
  double last_s;  ///< length of the last probe
  std::vector<int> unstable;

  std::ptrdiff_t times() const { return std::count(phases.begin(), phases.end(), Stage::probe); }
};
Probed probed(const HoveringSolver::Habits& habits, std::size_t parts = 2, double rest_window = 0.25,
              Pour::Finish finish = Pour::Finish::probed) {
  HoveringSolver solver(habits);
  Request request = request_of(parts);
  request.pour.finish = finish;
  request.pour.rest_window = rest_window;
  request.bin.inner_size = Vec3(1.0, 1.0, 0.12);  // room for all
  const Report report = pour({request, {small_box()}}, solver, {0})[0].report;
  EXPECT_TRUE(report.at_rest);
  EXPECT_EQ(report.finish, habits.heeds_phases ? name_of(finish) : "settled");
  return {solver.phases, solver.probed_s, report.unstable};
}

TEST(Stages, ASceneIsFinishedAsFarAsTheRequestAsks) {
  const auto phases = [](Pour::Finish finish) { return probed({}, 2, 0.25, finish).phases; };
  const auto pour = Stage::pour, settle = Stage::settle, press = Stage::press, probe = Stage::probe,
             verify = Stage::verify;
  EXPECT_EQ(phases(Pour::Finish::settled), (std::vector<Stage>{pour, settle, verify}));
  EXPECT_EQ(phases(Pour::Finish::pressed), (std::vector<Stage>{pour, settle, press, verify}));
  EXPECT_EQ(phases(Pour::Finish::probed), (std::vector<Stage>{pour, settle, press, probe, verify}));
}

// Parts that remembered friction held slipped as soon as the scene was continued: 17 of 2,250 gears.
TEST(Stages, EachFinishWaitsForWhatSlipsWithoutRememberedForces) {
  for (const Pour::Finish finish : {Pour::Finish::settled, Pour::Finish::pressed}) {
    HoveringSolver::Habits habits;
    const auto time = [&] {
      HoveringSolver solver(habits);
      Request request = request_of(2);
      request.pour.finish = finish;
      const Scene scene = pour({request, {small_box()}}, solver, {0})[0];
      EXPECT_TRUE(scene.report.at_rest);
      EXPECT_EQ(scene.report.finish, name_of(finish));
      return scene.report.simulated_s;
    };
    const double still = time();
    habits.slips_in_verify_s = 0.2;
    EXPECT_NEAR(time(), still + 0.2, 0.15) << name_of(finish);
  }
}

TEST(Stages, WhatLiesStillIsPressedAndProbedUntilItStands) {
  HoveringSolver::Habits habits;
  const auto pour = Stage::pour, settle = Stage::settle, probe = Stage::probe, press = Stage::press,
             verify = Stage::verify;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, verify}));
  EXPECT_EQ(probed(habits, 2, 0.01).times(), 1) << "a window shorter than a slice";
  habits.jumps_at_s = 0.015;
  habits.jumps = 1;
  EXPECT_EQ(probed(habits).times(), 1) << "it budges while forces are found";
  habits.jumps_at_s = 0.05;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, probe, verify}))
      << "it comes to lie in the first, and stands the second";
  habits.jumps = 100;
  EXPECT_EQ(probed(habits).times(), 12) << "it moves in all of them";
  EXPECT_EQ(probed(habits, 49).times(), 12);
  EXPECT_EQ(probed(habits, 50).times(), 1) << "one in fifty may, and is checked again where it lies";
}

TEST(Stages, WhatStoodAProbeIsPressedUntilItStandsThatToo) {
  HoveringSolver::Habits habits;
  const auto pour = Stage::pour, settle = Stage::settle, probe = Stage::probe, press = Stage::press,
             verify = Stage::verify;
  habits.jumps_in = verify;
  habits.jumps_at_s = 1e-3;
  habits.slides_s = 0.05;
  habits.jumps = 2;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, verify, verify, verify}))
      << "forces are forgotten anew each time";
  habits.heeds_phases = false;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle})) << "a solver to which all stages are the same";
}

// One part of 150 might move in each check, and nobody named it.
TEST(Stages, AFewThatMoveInACheckAreCheckedAgainAloneOrNamed) {
  HoveringSolver::Habits habits;
  const auto probe = Stage::probe, verify = Stage::verify, recheck = Stage::recheck;
  const auto last_stages = [&](int jumps, std::vector<int> unstable) {
    habits.jumps_in = verify;
    habits.jumps_at_s = 0.05;
    habits.jumps = jumps;
    const Probed seen = probed(habits, 150);
    EXPECT_EQ(seen.unstable, unstable) << jumps;
    return std::vector<Stage>(std::find(seen.phases.begin(), seen.phases.end(), probe), seen.phases.end());
  };
  EXPECT_EQ(last_stages(1, {}), (std::vector<Stage>{probe, verify, recheck}));
  EXPECT_EQ(last_stages(2, {}), (std::vector<Stage>{probe, verify, recheck, recheck}));
  EXPECT_EQ(last_stages(1000, {0}), (std::vector<Stage>{probe, verify, recheck, recheck, recheck, recheck, recheck,
                                                        recheck, recheck, recheck}));
}

// A gear that turned again after each probe took 18 s; one disc of 80 rolled for as long as there was time.
TEST(Stages, OnePartThatGoesOnIsNamedAfterSomeSeconds) {
  HoveringSolver::Habits habits;
  habits.creeps_s = 1e9;
  HoveringSolver solver(habits);
  Request request = request_of(20);
  request.bin.inner_size = Vec3(1.0, 1.0, 0.12);
  const Scene scene = pour({request, {small_box()}}, solver, {0})[0];
  EXPECT_FALSE(scene.report.at_rest);
  EXPECT_LT(scene.report.simulated_s, 8.0);
  EXPECT_EQ(scene.parts[0].state, PartState::moving);
  EXPECT_EQ(scene.parts[1].state, PartState::resting);
}

// Of 128 heaps of 150 channels, 4 were set apart as not at rest: a few parts had just begun to slip in one more probe
// of the whole heap.
TEST(Stages, ALateHeapIsNotProbedAgainAsAWhole) {
  HoveringSolver::Habits habits;
  habits.jumps = 100;
  habits.slides_s = 1.5;
  HoveringSolver solver(habits);
  Request request = request_of(20);
  request.bin.inner_size = Vec3(9.0, 9.0, 0.12);  // it slides far
  const Scene scene = pour({request, {small_box()}}, solver, {0})[0];
  EXPECT_TRUE(scene.report.at_rest);
  EXPECT_LT(scene.report.simulated_s, 8.0);
  const auto probes = std::count(solver.phases.begin(), solver.phases.end(), Stage::probe);
  EXPECT_GT(probes, 1);
  EXPECT_LT(probes, 5);
}

/// Its parts have been still for some time (s), or move.
class HeapOfTimes : public HeapView {
 public:
  std::vector<double> still;

  bool all_in() const override { return true; }
  bool all_slow() const override { return true; }
  bool all_rest() const override { return still_for_less_than(rest_window()) == 0; }
  bool all_asleep() const override { return false; }
  std::size_t count() const override { return still.size(); }
  std::size_t still_for_less_than(double seconds) const override {
    return static_cast<std::size_t>(
        std::count_if(still.begin(), still.end(), [&](double time) { return time < seconds; }));
  }
  double rest_window() const override { return 0.25; }
};

// In a heap of 800 gears, 80 slipped one after the other, until all rested 0.2 s after the heap was ended.
TEST(Stages, FewThatMoveAreNotWaitedForButOneAfterTheOtherIs) {
  HeapOfTimes heap;
  heap.still.assign(800, 100.0);
  Settling settling(Pour::Finish::probed);
  settling.start(Stage::pour);
  for (const double time : {1.0, 1.5, 2.0, 3.5}) settling.advance(heap, time);
  ASSERT_EQ(settling.stage(), Stage::verify);
  std::fill_n(heap.still.begin(), 80, 1.0);
  std::fill_n(heap.still.begin(), 2, 0.0);
  EXPECT_FALSE(settling.advance(heap, 7.5));
  std::fill_n(heap.still.begin() + 2, 78, 2.5);
  EXPECT_TRUE(settling.advance(heap, 9.0));
  EXPECT_TRUE(settling.done());
}

TEST(Stages, WhatRocksOnInAProbeIsSettledAgain) {
  HoveringSolver::Habits habits;
  const auto pour = Stage::pour, settle = Stage::settle, probe = Stage::probe, press = Stage::press,
             verify = Stage::verify;
  habits.swings_s = 3.0;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, settle, press, probe, verify}));
  EXPECT_EQ(probed(habits, 150).phases, (std::vector<Stage>{pour, settle, press, probe, verify}))
      << "one of many is waited for";
  habits.swings_s = 1.5;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, probe, verify})) << "in time";
}

// A part that fell sent the heap back to soft contacts, on which it sagged as a whole; 1,000 rods never came to an end.
TEST(Stages, WhatFallsInAProbeIsWaitedFor) {
  HoveringSolver::Habits habits;
  habits.swings_fast = true;
  habits.swings_s = 0.3;
  const auto pour = Stage::pour, settle = Stage::settle, probe = Stage::probe, press = Stage::press,
             verify = Stage::verify;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, probe, verify}));
  habits.swings_s = 3.0;
  EXPECT_EQ(probed(habits).phases, (std::vector<Stage>{pour, settle, press, probe, settle, press, probe, verify}));
}

TEST(Stages, AProbeWaitsUntilNothingCreepsButNotForLong) {
  HoveringSolver::Habits habits;
  const double at_once = probed(habits).last_s;
  EXPECT_GE(at_once, 0.1) << "what has moved since forces were found must show";
  EXPECT_LE(at_once, 0.25);
  habits.sleeps_at_s = 0.4;
  EXPECT_NEAR(probed(habits).last_s, 0.4, 0.03);
  habits.sleeps_at_s = 100.0;
  EXPECT_NEAR(probed(habits).last_s, 1.0, 0.03);
}

TEST(Stages, WhatWasGivenAtRestIsProbedOnlyIfItMoves) {
  const auto phases_of = [](double creeps_s) {
    HoveringSolver::Habits habits;
    habits.creeps_s = creeps_s;
    HoveringSolver solver(habits);
    Request request = request_of(2);
    request.pour.pattern = Pour::Pattern::given;
    request.pour.finish = Pour::Finish::probed;
    for (const double x : {-0.05, 0.05}) request.parts[0].poses.push_back({Vec3(x, 0, 0.05), Quat::Identity()});
    EXPECT_TRUE(pour({request, {small_box()}}, solver, {0})[0].report.at_rest);
    return solver.phases;
  };
  const auto settle = Stage::settle, probe = Stage::probe, press = Stage::press, verify = Stage::verify;
  EXPECT_EQ(phases_of(0.0), (std::vector<Stage>{press}));
  EXPECT_EQ(phases_of(0.5), (std::vector<Stage>{press, settle, press, probe, verify}));
}

}  // namespace
}  // namespace bin_scenes::testing
