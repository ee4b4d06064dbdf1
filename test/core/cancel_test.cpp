#include "bin_scenes/core/cancel.hpp"

#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace bin_scenes {
namespace {

TEST(Cancel, WorkWithoutAScopeIsAlwaysWanted) {
  EXPECT_EQ(cancel_flag(), nullptr);
  EXPECT_NO_THROW(stop_if_cancelled());
}

TEST(Cancel, ThrowsOnceTheFlagIsSetAndOnlyInsideTheScope) {
  std::atomic<bool> flag{false};
  {
    const CancelScope scope(&flag);
    EXPECT_NO_THROW(stop_if_cancelled());
    flag = true;
    EXPECT_TRUE(cancelled());
    try {
      stop_if_cancelled();
      FAIL() << "went on";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
  }
  EXPECT_NO_THROW(stop_if_cancelled());
}

TEST(Cancel, AnInnerScopeWithoutAFlagLeavesTheOuterOneInForce) {
  const std::atomic<bool> flag{true};
  const CancelScope outer(&flag);
  const CancelScope inner(nullptr);
  EXPECT_TRUE(cancelled());
}

TEST(Cancel, BelongsToOneThread) {
  const std::atomic<bool> flag{true};
  const CancelScope scope(&flag);
  bool elsewhere = true;
  std::thread([&] { elsewhere = cancelled(); }).join();
  EXPECT_FALSE(elsewhere);
}

}  // namespace
}  // namespace bin_scenes
