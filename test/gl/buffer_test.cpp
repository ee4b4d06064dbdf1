#include "bin_scenes/gl/buffer.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/gl/device.hpp"
#include "bin_scenes/gl/program.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace bin_scenes::gl {
namespace {

class BufferTest : public ::testing::Test {
 protected:
  void SetUp() override { Device::current().make_current(); }
};

std::vector<std::uint32_t> counting(std::size_t n) {
  std::vector<std::uint32_t> values(n);
  std::iota(values.begin(), values.end(), 1u);
  return values;
}

TEST_F(BufferTest, StartsAtZeroAndReturnsWhatWasWritten) {
  Buffer<std::uint32_t> buffer("test");
  buffer.resize(7);
  EXPECT_EQ(buffer.download(), std::vector<std::uint32_t>(7, 0));
  buffer.upload(counting(7));
  EXPECT_EQ(buffer.download(), counting(7));
  EXPECT_EQ(buffer.download(2, 3), (std::vector<std::uint32_t>{3, 4, 5}));
}

TEST_F(BufferTest, GrowingKeepsContentsAndZeroesTheRest) {
  Buffer<std::uint32_t> buffer("test");
  buffer.upload(counting(5));
  buffer.grow(8);
  EXPECT_EQ(buffer.download(), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 0, 0, 0}));
}

TEST_F(BufferTest, FillsASubRange) {
  Buffer<std::uint32_t> buffer("test");
  buffer.upload(counting(4));
  buffer.fill(9, 1, 2);
  EXPECT_EQ(buffer.download(), (std::vector<std::uint32_t>{1, 9, 9, 4}));
}

TEST_F(BufferTest, AWriteComesAfterTheClearBeforeIt) {
  for (const std::size_t count : {2000u, 20000u, 1000000u}) {
    Buffer<std::uint32_t> buffer("test");
    buffer.resize(count);
    buffer.clear();
    buffer.upload(counting(count));
    EXPECT_TRUE(buffer.download() == counting(count)) << count;
  }
}

TEST_F(BufferTest, ReadsWhatADispatchHasWrittenBesideItsOwnArguments) {
  const Program ask_groups = Program::compute("test/ask_groups.comp");
  Buffer<std::uint32_t> arguments("test");
  arguments.upload({1, 1, 1});
  EXPECT_EQ(arguments.download()[0], 1u);
  ask_groups.set("groups", 5u);
  arguments.bind(1);
  dispatch_indirect(ask_groups, arguments.storage(), 0, Barrier::arguments);
  EXPECT_EQ(arguments.download()[0], 5u);
}

TEST_F(BufferTest, ReadBackThroughAFenceSeesTheState) {
  Buffer<std::uint32_t> buffer("test");
  buffer.upload(counting(4));
  ReadBack back(16);
  back.request(buffer.storage(), 4, 8);
  buffer.clear();  // after the request: must not be seen
  const auto* values = static_cast<const std::uint32_t*>(back.wait());
  EXPECT_EQ(values[0], 2u);
  EXPECT_EQ(values[1], 3u);
}

TEST_F(BufferTest, ReadBackLaysRangesOfSeveralBuffersOneBehindTheOther) {
  Buffer<std::uint32_t> one("one"), other("other");
  one.upload(counting(8));
  other.upload({70, 80});
  ReadBack back;
  back.request({{&one.storage(), 4, 4}, {&one.storage(), 8, 8}, {&other.storage(), 4, 4}, {&one.storage(), 28, 4}});
  const auto* values = static_cast<const std::uint32_t*>(back.wait());
  EXPECT_EQ(std::vector<std::uint32_t>(values, values + 5), (std::vector<std::uint32_t>{2, 3, 4, 80, 8}));
}

TEST_F(BufferTest, BeyondTheDriversLimitIsAnErrorThatNamesTheBuffer) {
  Storage storage("contacts");
  const auto limit = static_cast<std::size_t>(Device::current().limits().storage_bytes);
  try {
    storage.allocate(limit + 16);
    FAIL() << "allocated more than the driver allows";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
    EXPECT_NE(std::string(error.what()).find("contacts"), std::string::npos);
  }
}

}  // namespace
}  // namespace bin_scenes::gl
