#include "core/byte_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bin_scenes {
namespace {

struct Item {
  std::string name;
  bool good = false;
};
template <class Stream>
void members(Stream& stream, Item& item) {
  stream(item.name, item.good);
}

struct All {
  double number = 0.0;
  std::uint16_t count = 0;
  Vec3 place = Vec3::Zero();
  std::array<int, 3> nodes{};
  std::vector<Vec3> places;
  std::vector<Item> items;
};
template <class Stream>
void members(Stream& stream, All& all) {
  stream(all.number, all.count, all.place, all.nodes, all.places, all.items);
}

std::string written() {
  All all{
      0.1, 7, {1, 2, 3}, {4, 5, 6}, {{7, 8, 9}, {std::numeric_limits<double>::infinity(), 0, 0}}, {{"a", true}, {}}};
  WriterInto<std::string> out;
  out(all);
  return out.take();
}

TEST(ByteStream, MembersComeBackInTheirOrderWithoutPadding) {
  const std::string bytes = written();
  EXPECT_EQ(bytes.size(), 8u + 2u + 24u + 12u + (8u + 48u) + 8u + (8u + 1u + 1u) + (8u + 1u));
  ByteReader in(bytes);
  All back;
  in(back);
  EXPECT_TRUE(in.complete());
  EXPECT_EQ(back.number, 0.1);
  EXPECT_EQ(back.count, 7);
  EXPECT_EQ(back.place, Vec3(1, 2, 3));
  EXPECT_EQ(back.nodes[2], 6);
  ASSERT_EQ(back.places.size(), 2u);
  EXPECT_TRUE(std::isinf(back.places[1].x()));
  ASSERT_EQ(back.items.size(), 2u);
  EXPECT_EQ(back.items[0].name, "a");
  EXPECT_TRUE(back.items[0].good);
  EXPECT_FALSE(back.items[1].good);
}

TEST(ByteStream, CutBytesAreNeverCompleteAndNeverReadPastTheEnd) {
  const std::string bytes = written();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<char> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    ByteReader in(cut);
    All back;
    in(back);
    EXPECT_FALSE(in.complete()) << size;
  }
  const std::string longer = bytes + "x";
  ByteReader in(longer);
  All back;
  in(back);
  EXPECT_TRUE(in.ok());
  EXPECT_FALSE(in.complete());
}

TEST(ByteStream, ANumberOfItemsThatTheBytesCannotHoldIsRefused) {
  std::string bytes(8, '\xff');
  ByteReader in(bytes);
  std::vector<Item> items;
  in(items);
  EXPECT_FALSE(in.ok());
  EXPECT_TRUE(items.empty());
}

TEST(ByteStream, AByteThatIsNeitherTrueNorFalseIsRefused) {
  const std::string bytes = "\2";
  ByteReader in(bytes);
  bool value = true;
  in(value);
  EXPECT_FALSE(in.ok());
  EXPECT_FALSE(value);
}

}  // namespace
}  // namespace bin_scenes
