#include "framework/compare.hpp"

#include "bin_scenes/core/error.hpp"

#include <gtest/gtest.h>

namespace bin_scenes::bench {
namespace {

Table table_of(const std::vector<Row>& rows) {
  Table table;
  table.header = {{"benchmark", "scenes"}, {"cpu", "one"}};
  for (const Row& row : rows) table.add(row);
  return table;
}
Row timed(const std::string& part, const std::vector<double>& seconds) {
  return Row().key("part", part).measure("time_s", seconds);
}

TEST(Compare, WithinTheSpreadNothingMoves) {
  const Comparison c = compare(table_of({timed("ring", {1.0, 1.1, 1.2})}), table_of({timed("ring", {1.1, 1.2, 1.3})}));
  EXPECT_EQ(c.rows, 1u);
  EXPECT_EQ(c.values, 1u);
  EXPECT_TRUE(c.moved.empty());
}

TEST(Compare, BeyondTheSpreadMoves) {
  const Comparison c = compare(table_of({timed("ring", {1.0, 1.1, 1.2})}), table_of({timed("ring", {1.4, 1.5, 1.6})}));
  ASSERT_EQ(c.moved.size(), 1u);
  EXPECT_EQ(c.moved[0].key, "part=ring");
  EXPECT_EQ(c.moved[0].column, "time_s");
  EXPECT_NEAR(c.moved[0].change, 0.4 / 1.1, 1e-12);
  EXPECT_NE(to_text(c).find("+36.4 %"), std::string::npos) << to_text(c);
}

TEST(Compare, TinyChangesOfSteadyValuesAreNoise) {
  const auto at = [](double s) { return table_of({timed("ring", {s, s, s})}); };
  EXPECT_TRUE(compare(at(1.0), at(1.02)).moved.empty());
  EXPECT_EQ(compare(at(1.0), at(1.02), 0.01).moved.size(), 1u);
}

TEST(Compare, OneSampleMayBeAQuarterOff) {
  EXPECT_TRUE(compare(table_of({timed("ring", {1.0})}), table_of({timed("ring", {1.2})})).moved.empty());
  EXPECT_EQ(compare(table_of({timed("ring", {1.0})}), table_of({timed("ring", {1.4})})).moved.size(), 1u);
}

TEST(Compare, ExactColumnsMoveWithTheirLastDigit) {
  const auto at = [](int escaped) { return table_of({Row().key("part", "ring").exact("escaped", escaped)}); };
  EXPECT_TRUE(compare(at(0), at(0)).moved.empty());
  EXPECT_EQ(compare(at(0), at(1)).moved.size(), 1u);
}

TEST(Compare, RowsAreMatchedByKeyAndInfoIsIgnored) {
  const Table a = table_of({timed("ring", {1, 1}).info("note", "x"), timed("bolt", {2, 2})});
  const Table b = table_of({timed("tee", {3, 3}), timed("ring", {1, 1}).info("note", "y")});
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.rows, 1u);
  EXPECT_TRUE(c.moved.empty());
  EXPECT_EQ(c.only_before, std::vector<std::string>{"scenes: part=bolt"});
  EXPECT_EQ(c.only_after, std::vector<std::string>{"scenes: part=tee"});
}

TEST(Compare, AFigureThatIsGoneHasMoved) {
  EXPECT_EQ(compare(table_of({timed("ring", {1, 1})}), table_of({timed("ring", {})})).moved.size(), 1u);
}

TEST(Compare, AnotherMachineIsSaid) {
  Table other = table_of({timed("ring", {1, 1})});
  other.header[1].second = "two";
  const Comparison c = compare(table_of({timed("ring", {1, 1})}), other);
  ASSERT_EQ(c.notes.size(), 1u);
  EXPECT_NE(c.notes[0].find("cpu differs"), std::string::npos);
}

TEST(Compare, MissingFilesAreAClearError) {
  EXPECT_THROW(compare_paths("no_such_folder", "nor_this_one"), Error);
}

}  // namespace
}  // namespace bin_scenes::bench
