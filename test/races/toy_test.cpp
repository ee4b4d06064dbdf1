/// The referee on passes of a few lines, each with one mistake, and on the same without it.
#include "races/referee.hpp"
#include "races/run.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::races {
namespace {

/// What is found in a pass of two groups of 8 that has a buffer `data` of 64 words.
std::string found(const std::string& body, const std::string& before = "", const std::string& flags = "coherent") {
  const Module module =
      compile("#version 450 core\nlayout(local_size_x = 8) in;\nlayout(std430, binding = 0) " + flags +
                  " buffer Data { uint data[64]; };\n" + before +
                  "\nvoid main() { uint i = gl_LocalInvocationIndex, g = gl_WorkGroupID.x; " + body + " }",
              "toy");
  Memory data{"Data", std::vector<Word>(64), {}};
  data.watch();
  Dispatch dispatch;
  dispatch.module = &module;
  dispatch.groups = {2, 1, 1};
  dispatch.buffers = {&data};
  Referee referee;
  run(dispatch, referee);
  std::string kinds;
  for (const Finding& finding : referee.findings()) kinds += (kinds.empty() ? "" : ", ") + finding.kind;
  return kinds;
}

TEST(Referee, TakesWhatIsInOrder) {
  EXPECT_EQ(found("data[8u * g + i] = i; data[8u * g + i] += 1u;"), "");
  EXPECT_EQ(found("s[i] = i; barrier(); data[8u * g + i] = s[i ^ 1u];", "shared uint s[8];"), "");
  EXPECT_EQ(
      found(
          "data[8u * g + i] = i; memoryBarrierBuffer(); barrier(); data[16u + 8u * g + i] = data[8u * g + (i ^ 1u)];"),
      "");
  EXPECT_EQ(found("atomicAdd(data[0], 1u);"), "");
  EXPECT_EQ(found("data[0] = 7u;"), "");
  EXPECT_EQ(
      found("uvec4 v = uvec4(i); switch (i) { case 1u: v.y = 2u; break; case 2u: v.z = 3u; break; default: break; } "
            "data[8u * g + i] = v[i & 3u];"),
      "");
}

TEST(Referee, FindsWhatIsNot) {
  EXPECT_EQ(found("data[g] = i;"), "written by two");
  EXPECT_EQ(found("if (i == 0u) data[0] = g;"), "written by two");
  EXPECT_NE(found("s[i] = i; data[8u * g + i] = s[i ^ 1u];", "shared uint s[8];").find("read while written"),
            std::string::npos);
  EXPECT_EQ(found("s[i] = i; barrier(); uint k = s[i ^ 1u]; s[i] = k;", "shared uint s[8];").find("written by two"),
            std::string::npos);
  EXPECT_NE(found("s[i] = i; barrier(); uint k = s[i ^ 1u]; s[i] = k;", "shared uint s[8];"), "");
  EXPECT_EQ(found("data[8u * g + i] = i; barrier(); data[16u + 8u * g + i] = data[8u * g + (i ^ 1u)];"),
            "read while written");
  EXPECT_EQ(
      found("data[8u * g + i] = i; memoryBarrierBuffer(); barrier(); data[16u + 8u * g + i] = data[8u * g + (i ^ 1u)];",
            "", ""),
      "read of what another wrote, not coherent");
  EXPECT_NE(found("atomicAdd(data[0], 1u); if (i == 3u) data[1] = data[0];"), "");
  EXPECT_EQ(found("data[64u + i] = 0u;").substr(0, 5), "index");
  EXPECT_EQ(found("data[i] = s[i];", "shared uint s[8];").find("read before it is written"), 0u);
  EXPECT_EQ(found("if (i < 4u) barrier();"), "barrier that not all come to");
}

TEST(Referee, SeesALockBetweenGroups) {
  const std::string lock =
      "if (i == 0u) { while (atomicExchange(data[0], 1u) == 1u); } memoryBarrierBuffer(); barrier(); ";
  const std::string unlock = "memoryBarrierBuffer(); barrier(); if (i == 0u) atomicExchange(data[0], 0u);";
  EXPECT_EQ(found(lock + "data[8u + i] = g;" + unlock), "");
  EXPECT_EQ(found(lock + "data[8u + i] = g; barrier(); if (i == 0u) atomicExchange(data[0], 0u);"), "written by two");
}

TEST(Referee, WantsABarrierOfTheHostBetweenDispatches) {
  for (const bool has_barrier : {true, false}) {
    const Module module = compile(
        "#version 450 core\nlayout(local_size_x = 8) in;\nlayout(std430, binding = 0) buffer Data "
        "{ uint data[8]; };\nvoid main() { ++data[7u - gl_LocalInvocationIndex]; }",
        "toy");
    Memory data{"Data", std::vector<Word>(8), {}};
    data.watch();
    Dispatch dispatch;
    dispatch.module = &module;
    dispatch.buffers = {&data};
    Referee referee;
    run(dispatch, referee);
    if (has_barrier) referee.host_barrier();
    dispatch.groups = {1, 1, 1};
    run(dispatch, referee);
    EXPECT_EQ(referee.findings().empty(), has_barrier);
    EXPECT_TRUE(referee.needs_barrier());
    EXPECT_EQ(data.words, std::vector<Word>(8, 2));
  }
}

}  // namespace
}  // namespace bin_scenes::races
