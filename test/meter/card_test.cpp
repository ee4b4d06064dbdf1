/// The meter against what a card measured, and on whatever passes there are now.
#include "meter/recording.hpp"
#include "solver/sphere_gl/handful.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::meter {
namespace {

/// Dispatches of one world of 256 connecting rods, settling, as commit 94d5a298 made them
/// (bin_scenes_record_dispatches), and what the same passes took on an NVIDIA H200:
/// bench/results/nvidia-h200/trial.txt, V0, "256 worlds 1 settle".
struct Measured {
  const char* pass;
  double us;
};
const Measured measured[] = {{"solve", 1418.3}, {"color_manifolds", 207.8}, {"find_pairs", 244.4}};

TEST(MeterOfACard, ReproducesWhatAnH200TookWithinAFactorOfOneAndAHalf) {
  for (const Measured& m : measured) {
    Taken taken = load(std::string(RECORDED) + "/" + m.pass);
    const races::Module module = races::compile(taken.source, taken.pass, races::Optimise::yes);
    Counts counts;
    measure(taken.dispatch(module, taken.buffers), Card(), counts);
    const double ratio = counts.dispatch_us / m.us;
    std::printf("%s: %.0f us for %.0f, %.0f k slots\n", m.pass, counts.dispatch_us, m.us, counts.slots / 1e3);
    EXPECT_GT(ratio, 1 / 1.5) << m.pass;
    EXPECT_LT(ratio, 1.5) << m.pass;
  }
}

/// The two programs whose binaries' sizes are known from the same card: solve alone is still there to be counted.
TEST(MeterOfACard, CodeIsAsLongAsTheDriversBinary) {
  const Taken taken = load(std::string(RECORDED) + "/solve");
  const races::Module module = races::compile(taken.source, taken.pass, races::Optimise::yes);
  EXPECT_NEAR(Card().bytes_of_code * module.instructions, 190600, 0.1 * 190600);
}

/// Passes as they are now, whatever they are called.
TEST(MeterOfPasses, MeasuresEachPassOfAStep) {
  Watch watch;
  sphere_gl::Capacity capacity;
  capacity.as_on_card = true;
  const auto solver = make_gl_sphere_solver(sphere_gl::coarse(), capacity);
  const WorldId world = sphere_gl::Handful(1).add(*solver);
  solver->advance({world}, 0.1);
  std::size_t differing = 0, words = 0;
  watch.on_taken = [&](const Taken& taken, const races::Module& module) {
    Counts again;
    std::vector<races::Memory> first = taken.buffers, second = taken.buffers;
    measure(taken.dispatch(module, first), Card(), again);
    measure(taken.dispatch(module, second), Card(), again);
    for (std::size_t k = 0; k < first.size(); ++k) {
      for (std::size_t w = 0; w < first[k].words.size(); ++w) differing += first[k].words[w] != second[k].words[w];
      words += first[k].words.size();
    }
  };
  watch.begin();
  solver->advance({world}, 2 * solver->step_size());
  watch.end();
  EXPECT_EQ(differing, 0u) << "of " << words;
  EXPECT_GE(watch.passes().size(), 4u);
  for (const auto& [name, c] : watch.passes()) {
    EXPECT_GT(c.slots, 0) << name;
    EXPECT_GT(c.lanes(), 0) << name;
    EXPECT_LE(c.lanes(), 32) << name;
    EXPECT_GT(c.dispatches, 0u) << name;
    EXPECT_GE(c.warps, c.groups) << name;
    EXPECT_GT(c.sectors.loaded, 0u) << name;
    EXPECT_LE(c.l1_hits, c.sectors.loaded) << name;
    EXPECT_LE(c.divergent, c.branches) << name;
    EXPECT_GE(c.latency * 1.0001, c.longest) << name;
    EXPECT_GT(c.code_bytes, 500) << name;
    double lines = 0;
    for (const auto& [line, cost] : c.lines) lines += cost.slots;
    EXPECT_NEAR(lines / c.slots, 1, 1e-9) << name;
  }
}

}  // namespace
}  // namespace bin_scenes::meter
