/// Races in the passes of the GPU forms. A device promises no order of invocations but that of barriers, and no test on
/// llvmpipe shows that one is missing. So each dispatch of real steps runs in an interpreter that knows of each word
/// who reads and writes it (referee.hpp), and then on llvmpipe, which must make the same of it. Then each barrier of
/// each pass is left out once: where nothing is found, the barrier is superfluous, or the scenes lack what needs it.
///
/// Groups run one after the other: what two of them do to one word in the same instant, by atomics, is not seen.
#include "bin_scenes/gl/program.hpp"
#include "races/scenes.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace bin_scenes::races {
namespace {

using sphere_gl::Capacity;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

template <class Scene>
Observations watch(Scene scene) {
  Recorder recorder;
  scene(recorder);
  for (const auto& [pass, count] : recorder.seen().counts)
    if (count.needed_barriers == 0)
      std::printf("%s never needs the barrier of the host before it: %u dispatches\n", pass.c_str(), count.dispatches);
  return recorder.seen();
}

const Observations& sphere() {
  static const Observations seen = watch([](Recorder& recorder) {
    watch_waking(recorder, 0.04, 2e-5, 1);  // first: few dispatches of a kind are kept
    watch_waking(recorder, 0.5, 5e-4, 0);
    watch_heaps(recorder, {});
    watch_carpet(recorder, {});
    watch_overflow(recorder, {});
    Capacity as_on_a_gpu;
    as_on_a_gpu.world_group = 256;
    watch_carpet(recorder, as_on_a_gpu);
  });
  return seen;
}
const Observations& thesis() {
  static const Observations seen = watch(watch_spheres);
  return seen;
}

/// What becomes of a pass without one of its barriers, in all its records.
std::string without(const Observations& seen, const Pass& pass, Word barrier) {
  bool reached = false;
  for (const Record& record : seen.records) {
    if (record.pass.name != pass.name) continue;
    Choices choices;
    choices.without = barrier;
    choices.stop_at_first = true;
    choices.most_steps = 4 * record.steps;  // it may wait for something forever
    Outcome outcome;
    Referee referee;
    record.repeat(referee, choices, &outcome);
    if (!referee.findings().empty()) return referee.findings().begin()->kind;
    reached = reached || outcome.left_out;
  }
  return reached ? "nothing" : "never reached";
}

/// Barriers without which nothing goes wrong in these scenes.
std::string unnoticed(const Observations& seen) {
  std::set<std::string> done;
  std::string text;
  for (const Record& record : seen.records) {
    if (!done.insert(record.pass.name).second) continue;
    const Module& module = *record.pass.module;
    for (Word k = 0; k < module.barriers.size(); ++k) {
      const std::string finding = without(seen, record.pass, k);
      const std::string place = module.place_of(module.code[module.barriers[k]].line);
      if (finding == "nothing" || finding == "never reached")
        text += record.pass.name + ": " + place + ": " + finding + "\n";
    }
  }
  return text;
}

TEST(Races, OfTheSphereSolver) {
  EXPECT_EQ(joined(sphere().findings), "");
}

TEST(Races, OfTheThesis) {
  EXPECT_EQ(joined(thesis().findings), "");
}

TEST(Races, WithoutABarrierInTheThesis) {
  EXPECT_EQ(unnoticed(thesis()), "");
}

TEST(Races, WithoutABarrierInTheSphereSolver) {
  EXPECT_EQ(unnoticed(sphere()), "");
}

}  // namespace
}  // namespace bin_scenes::races
