/// Scenes are prepared in other threads and handed over in order, as soon as they are finished.
#include "generator_fixture.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <mutex>
#include <thread>

namespace bin_scenes {
namespace {

TEST_F(GeneratorTest, ScenesArePreparedBesideThePourAndHandedOverInOrder) {
  Request request = boxes(2);
  request.scenes = 6;
  std::mutex mutex;
  std::map<std::size_t, std::size_t> prepared;  // parts by index of the scene
  Generator::Options options;
  options.prepare = [&](Generator::Result& result) {
    const std::lock_guard<std::mutex> lock(mutex);
    prepared[result.scene.index] = result.scene.parts.size();
    EXPECT_TRUE(result.scene.report.at_rest) << "it has been judged";
  };
  const auto caller = std::this_thread::get_id();
  std::size_t next = 0;
  generator.generate(request, options, [&](Generator::Result&& result) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(result.scene.index, next);
    const std::lock_guard<std::mutex> lock(mutex);
    EXPECT_EQ(prepared.count(next++), 1u) << "before it is handed over";
  });
  EXPECT_EQ(prepared.size(), 6u);
  EXPECT_EQ(next, 6u);
}

/// For Options::prepare: all scenes are poured while the first one is prepared.
void prepare_first_slowly(const Generator::Result& result) {
  if (result.scene.index == 0) std::this_thread::sleep_for(std::chrono::seconds(2));
}

TEST_F(GeneratorTest, ASceneIsHandedOverAsSoonAsItIsFinished) {
  // All others are prepared only after scene 0 was handed over; a generator that waits for all waits in vain.
  std::promise<void> handed;
  const std::shared_future<void> first = handed.get_future().share();
  std::atomic<bool> in_vain{false};
  Generator::Options options;
  options.prepare = [&](Generator::Result& result) {
    prepare_first_slowly(result);
    if (result.scene.index > 0 && first.wait_for(std::chrono::seconds(20)) != std::future_status::ready) in_vain = true;
  };
  Request request = boxes(2);
  request.scenes = 3;
  generator.generate(request, options, [&](Generator::Result&& result) {
    if (result.scene.index == 0) handed.set_value();
  });
  EXPECT_FALSE(in_vain);
}

TEST_F(GeneratorTest, ScenesDoNotPileUpBeforeASlowOne) {
  std::atomic<int> prepared{0};
  int handed = 0, most = 0;
  Generator::Options options;
  options.prepare = [&](Generator::Result& result) {
    prepare_first_slowly(result);
    ++prepared;
  };
  Request request = boxes(1);
  request.scenes = 60;
  generator.generate(request, options, [&](Generator::Result&&) { most = std::max(most, prepared.load() - handed++); });
  EXPECT_EQ(handed, 60);
  EXPECT_LE(most, 2 * tbb::this_task_arena::max_concurrency() + 1);
}

TEST_F(GeneratorTest, WhatCannotBePreparedEndsTheRunAndLeavesEarlierScenes) {
  Request request = boxes(2);
  request.scenes = 4;
  Generator::Options options;
  options.prepare = [](Generator::Result& result) {
    if (result.scene.index == 2) throw environment_error("the disk is full", "somewhere", "free space");
  };
  std::size_t handed_over = 0;
  try {
    generator.generate(request, options, [&](Generator::Result&&) { ++handed_over; });
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
  }
  EXPECT_EQ(handed_over, 2u);
}

}  // namespace
}  // namespace bin_scenes
