#include "contained.hpp"

#include "bin_scenes/core/cancel.hpp"
#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace bin_scenes {
namespace {

TEST(Contained, GivesBackTheOutputWhole) {
  const std::string output(3'000'000, 'x');  // far more than a pipe holds
  const Contained result = run_contained([&] { return output; }, {10});
  EXPECT_TRUE(result.finished);
  EXPECT_EQ(result.output, output);
  EXPECT_TRUE(run_contained([] { return std::string(); }, {10}).finished);
}

TEST(Contained, ACrashIsToldByItsSignal) {
  const Contained result = run_contained(
      []() -> std::string {
        raise(SIGSEGV);
        return "never";
      },
      {10});
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
      {10});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Contained, AnEndlessLoopIsCutOff) {
  const Contained result = run_contained(
      [] {
        for (volatile unsigned i = 0;; i = i + 1) {
        }
        return std::string();
      },
      {1});
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.failure, "did not finish within 1 s");
}

TEST(Contained, MemoryWithoutEndIsCutOff) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer's allocator ends the process";
#endif
  const Contained result = run_contained([] { return std::string(std::size_t{1} << 30, 'x'); }, {10, 100 << 20});
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.failure, "wanted more than 100 MiB of memory");
}

TEST(Contained, ItEndsAtOnceWhenNobodyWantsItAnyMore) {
  std::atomic<bool> flag{false};
  const CancelScope scope(&flag);
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    flag = true;
  });
  EXPECT_THROW(run_contained(
                   []() -> std::string {
                     for (;;) pause();
                   },
                   {10}),
               Error);
  stopper.join();
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST(Contained, ItDiesWithItsParent) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    run_contained(
        [&]() -> std::string {
          const pid_t self = getpid();
          static_cast<void>(!write(ends[1], &self, sizeof self));
          for (;;) pause();
        },
        {10});
    _exit(0);
  }
  pid_t child = 0;
  ASSERT_EQ(read(ends[0], &child, sizeof child), static_cast<ssize_t>(sizeof child));
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  close(ends[1]);
  char byte;
  EXPECT_EQ(read(ends[0], &byte, 1), 0) << "ends only once the child's end of the pipe is closed";
}

TEST(Contained, AnEarlyEndIsNoSuccess) {
  const Contained result = run_contained(
      []() -> std::string {
        _exit(0);
        return {};
      },
      {10});
  EXPECT_FALSE(result.finished);
  EXPECT_EQ(result.failure, "ended early");
}

TEST(Contained, WorksWhereTheHostIgnoresItsChildren) {
  const auto before = signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_contained([] { return std::string("whole"); }, {10}).output, "whole");
  signal(SIGCHLD, before);
}

}  // namespace
}  // namespace bin_scenes
