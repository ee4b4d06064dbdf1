#include "framework/table.hpp"

#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bin_scenes::bench {
namespace {

Table sample() {
  Table table;
  table.header = {{"benchmark", "sample"}, {"gl", "llvmpipe (LLVM 15.0.6, 256 bits)"}};
  table.add(Row().key("part", "ring, 24 pieces").key("bodies", 150).measure("time_s", {1.0, 3.0, 2.0}));
  table.add(Row().key("part", "the \"bolt\"").key("bodies", 64).measure("time_s", {0.25}).exact("escaped", 0));
  table.add(Row().key("part", "tee").status("not built"));
  return table;
}

TEST(Table, CsvReadsBackAsItWas) {
  const Table table = sample(), back = from_csv(to_csv(table), "sample.csv");
  EXPECT_EQ(to_csv(back), to_csv(table));
  EXPECT_EQ(back.header, table.header);
  ASSERT_EQ(back.rows.size(), 3u);
  EXPECT_EQ(back.rows[0].at("part"), "ring, 24 pieces");
  EXPECT_EQ(back.rows[1].at("part"), "the \"bolt\"");
  EXPECT_EQ(back.rows[0].at("time_s"), "2");
  EXPECT_EQ(back.rows[0].at("time_s_spread"), "2");
  EXPECT_EQ(back.rows[1].at("time_s_spread"), "") << "one sample tells nothing of its spread";
  EXPECT_EQ(back.rows[2].at("time_s"), "");
  EXPECT_EQ(back.key_of(1), "part=the \"bolt\" bodies=64");
}

TEST(Table, RolesSurviveTheFile) {
  const Table back = from_csv(to_csv(sample()), "sample.csv");
  std::string roles;
  for (const Column& column : back.columns) roles += std::string(name_of(column.role)) + " ";
  EXPECT_EQ(roles, "key key measure spread exact info ");
}

TEST(Table, ARowTakesThePlaceOfOneWithItsKeys) {
  Table table = sample();
  table.add(Row().key("part", "tee").info("note", "now built"));
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows[2].at("note"), "now built");
  EXPECT_EQ(table.rows[2].count("status"), 0u);
}

TEST(Table, NotANumberIsNotMeasured) {
  EXPECT_EQ(Row().info("x", std::numeric_limits<double>::quiet_NaN()).at("x"), "");
  EXPECT_TRUE(std::isnan(Row().measure("x", std::vector<double>{}).number("x")));
}

TEST(Table, DamagedFilesNameTheLine) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      from_csv(text, "bad.csv");
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("# roles: key key\na,b\n1,2\n3\n").find("bad.csv:4"), std::string::npos);
  EXPECT_NE(message("# roles: key\na,b\n").find("bad.csv:2"), std::string::npos);
  EXPECT_NE(message("# roles: kea\na\n").find("kea"), std::string::npos);
  EXPECT_NE(message("").find("no column names"), std::string::npos);
}

}  // namespace
}  // namespace bin_scenes::bench
