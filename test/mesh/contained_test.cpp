#include "contained.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace bin_scenes {
namespace {

TEST(Contained, GivesBackTheOutputWhole) {
  const std::string output(3'000'000, 'x');  // far more than a pipe holds
  const Contained result = run_contained([&] { return output; }, 10);
  EXPECT_TRUE(result.finished);
  EXPECT_EQ(result.output, output);
  EXPECT_TRUE(run_contained([] { return std::string(); }, 10).finished);
}

TEST(Contained, ACrashIsToldByItsSignal) {
  const Contained result = run_contained(
      []() -> std::string {
        raise(SIGSEGV);
        return "never";
      },
      10);
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.failure, "crashed (Segmentation fault)");
}

TEST(Contained, WhatACrashPrintsIsNotShown) {
  ::testing::internal::CaptureStderr();
  run_contained(
      []() -> std::string {
        static_cast<void>(!write(STDERR_FILENO, "assertion failed", 16));
        abort();
      },
      10);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Contained, AnEndlessLoopIsCutOff) {
  const Contained result = run_contained(
      [] {
        for (volatile int i = 0;; i = i + 1) {
        }
        return std::string();
      },
      1);
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.failure, "did not finish within 1 s");
}

TEST(Contained, AnEarlyEndIsNoSuccess) {
  const Contained result = run_contained(
      []() -> std::string {
        _exit(0);
        return {};
      },
      10);
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.failure, "ended early");
}

TEST(Contained, WorksWhereTheHostIgnoresItsChildren) {
  const auto before = signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_contained([] { return std::string("whole"); }, 10).output, "whole");
  signal(SIGCHLD, before);
}

}  // namespace
}  // namespace bin_scenes
