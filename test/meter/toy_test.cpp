/// The meter on shaders of a few lines, whose slots, lanes, sectors, barriers and cycles are counted by hand.
#include "meter/meter.hpp"
#include "races/referee.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::meter {
namespace {

using races::Memory;
using races::Module;

struct Measured {
  Counts counts;
  std::vector<Word> data;
};

/// A pass of `groups` groups of `lanes` invocations that has a buffer `data` of 4096 words, in which word k is k.
Measured measured(const std::string& body, Word lanes = 64, const std::string& before = "",
                  const std::string& flags = "", Word groups = 1) {
  const std::string source = "#version 450 core\nlayout(local_size_x = " + std::to_string(lanes) +
                             ") in;\nlayout(std430, binding = 0) " + flags + " buffer Data { uint data[]; };\n" +
                             before + "\nvoid main() { uint i = gl_LocalInvocationIndex; " + body + " }";
  const Module module = races::compile(source, "toy", races::Optimise::yes);
  Memory memory{"Data", std::vector<Word>(4096), {}};
  for (Word k = 0; k < memory.words.size(); ++k) memory.words[k] = k;
  races::Dispatch dispatch;
  dispatch.module = &module;
  dispatch.groups = {groups, 1, 1};
  dispatch.buffers = {&memory};
  Measured out;
  measure(dispatch, Card(), out.counts);
  out.data = std::move(memory.words);
  return out;
}

double latency(const std::string& body, const std::string& before = "", const std::string& flags = "") {
  return measured(body, 32, before, flags).counts.longest;
}

TEST(Meter, CountsSlotsAndSectorsOfOneLoadAndOneStore) {
  const Measured m = measured("data[i] = data[i] + 5u;");
  EXPECT_EQ(m.data[63], 68u);
  EXPECT_EQ(m.data[64], 64u);
  // Two warps; each: an address (2), a load of one word (2), an addition (1), a store (2), the end (1).
  EXPECT_NEAR(m.counts.slots, 2 * 8, 1e-4);
  EXPECT_NEAR(m.counts.lanes(), 32, 1e-4);
  EXPECT_EQ(m.counts.groups, 1u);
  EXPECT_EQ(m.counts.warps, 2u);
  EXPECT_EQ(m.counts.loads, 2u);
  EXPECT_EQ(m.counts.sectors.loaded, 8u);  // 64 words of 4 bytes in sectors of 32
  EXPECT_EQ(m.counts.sectors.stored, 8u);
  EXPECT_EQ(m.counts.l1_hits, 0u);
  EXPECT_EQ(m.counts.l2_bytes(), 512.0);
}

TEST(Meter, CountsASectorForEachLaneOfAScatteredAccess) {
  EXPECT_EQ(measured("data[8u * i] = 1u;", 32).counts.sectors.stored, 32u);
  EXPECT_EQ(measured("data[7u] = 1u;", 32).counts.sectors.stored, 1u);
  EXPECT_EQ(measured("data[4u + i] = 1u;", 32).counts.sectors.stored, 5u);
  EXPECT_EQ(measured("data[4096u + i] = 1u;", 32).counts.sectors.stored, 0u);  // beyond the end
}

TEST(Meter, CountsTheLanesOfABranch) {
  // Eight lanes store, each a constant at an address of its own: 2 + 2 slots. All compare (1) and branch (2), the eight
  // branch back (1), all end (1).
  const Counts some = measured("if (i < 8u) data[i] = 7u;", 32).counts;
  EXPECT_NEAR(some.slots, 9, 1e-4);
  EXPECT_NEAR(some.lane_slots, 4 * 32 + 5 * 8, 1e-3);
  EXPECT_EQ(some.branches, 1u);
  EXPECT_EQ(some.divergent, 1u);
  EXPECT_EQ(measured("if (i < 32u) data[i] = 7u;", 64).counts.divergent, 0u);  // by warps, not within one
}

TEST(Meter, LanesMeetAgainBehindALoop) {
  // Lane i makes i + 1 rounds; what follows the loop is issued once, for all.
  const Measured m = measured("uint n = 0u; for (uint k = 0u; k <= i; ++k) n += data[k]; atomicAdd(data[100], n);", 32);
  EXPECT_EQ(m.counts.atomics, 1u);
  EXPECT_EQ(m.counts.loads, 32u);
  EXPECT_EQ(m.counts.divergent, 31u);  // a lane leaves after each round but the last, when the last one goes
  Word sum = 100;
  for (Word i = 0; i < 32; ++i) sum += i * (i + 1) / 2;
  EXPECT_EQ(m.data[100], sum);
}

TEST(Meter, CountsBarriersOfAGroup) {
  const std::string round = "s[i] += s[i ^ 33u]; barrier();";
  const std::string loop =
      "s[i] = i; barrier(); for (uint k = 0u; k < data[5]; ++k) { " + round + " } data[1024u + i] = s[i];";
  EXPECT_EQ(measured(loop, 64, "shared uint s[64];").counts.barriers, 6u);
  EXPECT_EQ(measured(loop, 64, "shared uint s[64];", "", 3).counts.barriers, 18u);
  EXPECT_EQ(measured(loop, 64, "shared uint s[64];").counts.shared_words, 64u);
}

TEST(Meter, L1ServesWhatWasLoadedBefore) {
  // `coherent` memory is read from L2 each time.
  const std::string twice = "uint a = data[i]; data[2048u + i] = a; data[1024u + i] = data[i];";
  EXPECT_EQ(measured(twice, 32).counts.l1_hits, 4u);
  EXPECT_EQ(measured(twice, 32, "", "coherent").counts.l1_hits, 0u);
  // 1,024 words are 4 kB and stay in L1; a second group finds them there.
  EXPECT_EQ(measured("data[2048u + i] = data[i];", 1024, "", "", 2).counts.l1_hits, 128u);
}

TEST(Meter, DependentMultiplicationsWaitForEachOther) {
  const auto chain = [](int length) {
    std::string body = "float x = uintBitsToFloat(data[i]), y = uintBitsToFloat(data[1024u + i]);";
    for (int k = 0; k < length; ++k) body += " x = x * y;";
    return latency(body + " data[i] = floatBitsToUint(x);");
  };
  EXPECT_NEAR(chain(30) - chain(20), 10 * Card().arithmetic, 1e-2);
}

TEST(Meter, APointerChaseTakesTheLatencyOfItsMemory) {
  // Each step is a load and an address that depends on it.
  const auto chase = [](int length, const std::string& flags) {
    std::string body = "uint at = data[0];";
    for (int k = 0; k < length; ++k) body += " at = data[at];";
    return latency(body + " data[1024u + i] = at;", "", flags);
  };
  const double address = 2 * Card().arithmetic;
  EXPECT_NEAR(chase(30, "coherent") - chase(20, "coherent"), 10 * (Card().l2 + address), 1e-1);
  EXPECT_NEAR(chase(30, "") - chase(20, ""), 10 * (Card().l1 + address), 1e-1);
}

TEST(Meter, IndependentLoadsWaitTogether) {
  const auto sum = [](int loads) {
    std::string body = "uint sum = 0u;";
    for (int k = 0; k < loads; ++k) body += " sum += data[i + " + std::to_string(32 * k) + "u];";
    return latency(body + " data[i] = sum;", "", "coherent");
  };
  // The next load goes out three slots after the one before: an addition of the index and an address are the rest of
  // what a further term costs, and the sum itself.
  EXPECT_LT(sum(12) - sum(4), 8 * 8);
  EXPECT_GT(sum(12), Card().l2);
}

TEST(Meter, AWarpWaitsAtABarrierForTheSlowest) {
  // The second warp loads once before it; both end 30 cycles and a few slots after that.
  const std::string barrier = "shared uint s[64]; ";
  const double with_load =
      measured("s[i] = i; if (i >= 32u) s[i] = data[i]; barrier(); data[i] = s[i ^ 32u];", 64, barrier).counts.longest;
  const double without = measured("s[i] = i; barrier(); data[i] = s[i ^ 32u];", 64, barrier).counts.longest;
  EXPECT_GT(with_load - without, Card().l2);
  EXPECT_LT(with_load - without, Card().l2 + 2 * Card().branch + 40);
}

TEST(Meter, LinesAddUpToThePass) {
  const Counts counts = measured("data[i] = 3u;\nif (i > 3u)\n data[i] = data[i + 1u] / 3u;\n").counts;
  double slots = 0, lane_slots = 0;
  for (const auto& [line, cost] : counts.lines) slots += cost.slots, lane_slots += cost.lane_slots;
  EXPECT_NEAR(slots, counts.slots, 1e-3);
  EXPECT_NEAR(lane_slots, counts.lane_slots, 1e-2);
  EXPECT_GE(counts.lines.size(), 3u);
}

/// The interpreter that looks for races runs each invocation alone; both must come to the same.
TEST(Meter, ComputesWhatTheInterpreterOfRacesComputes) {
  const std::string source =
      "#version 450 core\nlayout(local_size_x = 64) in;\nlayout(std430, binding = 0) coherent buffer Data "
      "{ uint data[]; };\nshared float s[64];\nfloat step_of(float x, uint k) { return k % 3u == 0u ? sqrt(x) + 1.0 : "
      "x * 0.5; }\nvoid main() { uint i = gl_LocalInvocationIndex; vec4 v = vec4(data[i], i, 1.0, 2.0); s[i] = v[i & "
      "3u]; barrier(); float x = s[63u - i]; for (uint k = 0u; k < i; ++k) { if (x > 40.0) break; x = step_of(x, k + "
      "data[k]); } mat3 m = mat3(x); m[1] = cross(m[0], vec3(1.0, x, 2.0)); data[64u + i] = floatBitsToUint((m * "
      "vec3(1.0, 2.0, 3.0)).z); atomicMax(data[200], uint(x)); switch (i & 3u) { case 1u: data[300u + i] = 9u; "
      "break; case 2u: data[300u + i] = 8u; default: data[400u + i] = 7u; } }";
  std::vector<Word> results[2];
  for (const bool lockstep : {true, false}) {
    const Module module = races::compile(source, "toy", lockstep ? races::Optimise::yes : races::Optimise::no);
    Memory memory{"Data", std::vector<Word>(512, 30u), {}};
    memory.watch();
    races::Dispatch dispatch;
    dispatch.module = &module;
    dispatch.buffers = {&memory};
    Counts counts;
    races::Referee referee;
    if (lockstep)
      measure(dispatch, Card(), counts);
    else
      races::run(dispatch, referee);
    results[lockstep] = memory.words;
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(Meter, FullIssueIsThatOfAllSchedulers) {
  // 132 multiprocessors of four schedulers at 1,755 MHz issue 926.6 instructions a nanosecond.
  EXPECT_NEAR(full_issue_us(926640, 1, Card()), 1.0, 1e-9);
  EXPECT_NEAR(full_issue_us(1000, 264, Card()), 0.2849, 1e-4);
}

}  // namespace
}  // namespace bin_scenes::meter
