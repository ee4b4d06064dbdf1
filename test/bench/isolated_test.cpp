#include "framework/isolated.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

namespace bin_scenes::bench {
namespace {

TEST(Isolated, HandsTheRowOver) {
  const Isolated one = isolated([] {
    return Row().key("part", "ring").measure("time_s", {1.0, 2.0}).info("note", "two\nlines\tand a tab").exact("n", 3);
  });
  ASSERT_TRUE(one.good);
  ASSERT_EQ(one.row.cells().size(), 5u);
  EXPECT_EQ(one.row.cells()[1].first.role, Role::measure);
  EXPECT_EQ(one.row.at("note"), "two lines and a tab");
  EXPECT_EQ(one.row.number("n"), 3.0);
  EXPECT_EQ(one.row.at("time_s_spread"), "1");
}

TEST(Isolated, MeasuresPeakMemoryOfItsOwn) {
  const auto touch = [](std::size_t megabytes) {
    return isolated([megabytes] {
             std::vector<char> block(megabytes * 1000000);
             for (std::size_t i = 0; i < block.size(); i += 4096) block[i] = static_cast<char>(i);
             return Row().info("sum", static_cast<int>(block[4096 * 7]));
           })
        .peak_mb;
  };
  EXPECT_NEAR(touch(200) - touch(50), 150.0, 15.0);
}

TEST(Isolated, CrashHangAndExceptionBecomeStatus) {
  const Isolated crash = isolated([]() -> Row {
    ::raise(SIGSEGV);
    return {};
  });
  EXPECT_FALSE(crash.good);
  EXPECT_NE(crash.row.at("status").find("crashed"), std::string::npos);
  const Isolated hang = isolated(
      []() -> Row {
        ::pause();
        return {};
      },
      0.01);
  EXPECT_FALSE(hang.good);
  EXPECT_NE(hang.row.at("status").find("stopped after"), std::string::npos);
  const Isolated busy = isolated(
      []() -> Row {
        for (volatile int i = 0;;) i = i + 1;
      },
      1.0);
  EXPECT_FALSE(busy.good);
  EXPECT_NE(busy.row.at("status").find("s of CPU time"), std::string::npos);
  const Isolated thrown = isolated([]() -> Row { throw std::runtime_error("no such part"); });
  EXPECT_FALSE(thrown.good);
  EXPECT_EQ(thrown.row.at("status"), "failed: no such part");
}

}  // namespace
}  // namespace bin_scenes::bench
