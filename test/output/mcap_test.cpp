/// MCAP files against the specification (mcap.dev): a reader of its own, written from the tables of records.
#include "output/mcap.hpp"

#include "bin_scenes/output/scene_writer.hpp"
#include "output/output_fixture.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>
#include <zstd.h>

#include <csignal>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

namespace bin_scenes {
namespace {

const std::string magic("\x89MCAP0\r\n", 8);

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Reads fields one behind another; throws where the bytes end.
class Reader {
 public:
  explicit Reader(std::string bytes, std::size_t at = 0) : bytes_(std::move(bytes)), at(at) {}
  std::uint64_t number(std::size_t size) {
    const std::string part = take(size);
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(part[i]);
    return value;
  }
  std::string text() { return take(number(4)); }
  std::string take(std::size_t size) {
    if (size > bytes_.size() - at) throw std::out_of_range("cut off");
    at += size;
    return bytes_.substr(at - size, size);
  }
  bool done() const { return at == bytes_.size(); }

 private:
  std::string bytes_;

 public:
  std::size_t at;
};

struct Record {
  int op = 0;
  std::size_t start = 0, size = 0;  ///< in the file or chunk, with op and length
  std::string content;
  Reader read() const { return Reader(content); }
};

std::vector<Record> records_of(const std::string& bytes, std::size_t from, std::size_t to) {
  std::vector<Record> records;
  for (Reader reader(bytes.substr(0, to), from); !reader.done();) {
    Record one;
    one.start = reader.at;
    one.op = static_cast<int>(reader.number(1));
    one.content = reader.take(reader.number(8));
    one.size = reader.at - one.start;
    records.push_back(one);
  }
  return records;
}

struct Chunk {
  std::uint64_t first, last;
  std::string bytes;
};

Chunk unpacked(const Record& record) {
  Reader reader = record.read();
  Chunk chunk{reader.number(8), reader.number(8), ""};
  chunk.bytes.resize(reader.number(8));
  const std::uint64_t crc = reader.number(4);
  EXPECT_EQ(reader.text(), "zstd");
  const std::string packed = reader.take(reader.number(8));
  EXPECT_TRUE(reader.done());
  EXPECT_EQ(ZSTD_decompress(chunk.bytes.data(), chunk.bytes.size(), packed.data(), packed.size()), chunk.bytes.size());
  EXPECT_EQ(crc, crc_of(chunk.bytes));
  return chunk;
}

struct Message {
  std::uint64_t channel, sequence, log_time, publish_time;
  std::string data;
};

Message message_of(const Record& record) {
  Reader reader = record.read();
  return {reader.number(2), reader.number(4), reader.number(8), reader.number(8), record.content.substr(22)};
}

constexpr std::uint64_t begin = 1735689600000000000;  // ns

class Mcap : public OutputTest {
 protected:
  /// 300 messages of three channels, 20 kB of noise each, a second apart, but every tenth is late: 6 chunks.
  void SetUp() override {
    OutputTest::SetUp();
    McapFile file(path("a.mcap"), "ros1");
    const McapSchema point{"geometry/Point", "ros1msg", "float64 x\n"},
        string{"std/String", "ros1msg", "string data\n"};
    for (const char* topic : {"/a", "/b"}) file.add_channel({topic, "ros1", point, {{"latching", "true"}}});
    file.attach("note.txt", "text/plain", begin, "a note");
    std::uint32_t random = 1;
    for (int i = 0; i < 300; ++i) {
      if (i == 150) file.add_channel({"/c", "ros1", string, {}});
      std::string data = std::to_string(i) + ":";
      while (data.size() < 20000) data += static_cast<char>((random = random * 1664525 + 1013904223) >> 24);
      const int channel = i < 150 ? i % 2 : i % 3;
      const std::uint64_t time = begin + 1'000'000'000ull * static_cast<std::uint64_t>(i % 10 == 9 ? i - 9 : i);
      sent.push_back({static_cast<std::uint64_t>(channel), counts[channel]++, time, time, data});
      file.write(static_cast<McapFile::ChannelId>(channel), time, data.data(), data.size());
    }
    file.add_metadata("facts", {{"seed", "7"}, {"solver", "sphere"}});
    file.close();
    bytes = text("a.mcap");
    Reader footer(bytes, bytes.size() - magic.size() - 20);
    summary = footer.number(8);
    offsets = footer.number(8);
    summary_crc = footer.number(4);
  }
  std::vector<Record> data_section() const { return records_of(bytes, magic.size(), summary); }
  std::vector<Record> of(int op, const std::vector<Record>& records) const {
    std::vector<Record> found;
    for (const Record& one : records)
      if (one.op == op) found.push_back(one);
    return found;
  }
  std::vector<Record> summary_records() const { return records_of(bytes, summary, offsets); }

  std::vector<Message> sent;
  std::map<int, std::uint64_t> counts;
  std::string bytes;
  std::size_t summary = 0, offsets = 0;
  std::uint64_t summary_crc = 0;
};

void expect_same(const Message& got, const Message& sent) {
  EXPECT_EQ(got.channel, sent.channel);
  EXPECT_EQ(got.sequence, sent.sequence);
  EXPECT_EQ(got.log_time, sent.log_time);
  EXPECT_EQ(got.publish_time, sent.publish_time);
  EXPECT_TRUE(got.data == sent.data) << "data of message " << sent.data.substr(0, 4);
}

TEST_F(Mcap, ReadFromFrontToBackGivesWhatWasWritten) {
  EXPECT_EQ(bytes.substr(0, magic.size()), magic);
  EXPECT_EQ(bytes.substr(bytes.size() - magic.size()), magic);
  const std::vector<Record> records = data_section();
  ASSERT_EQ(records.front().op, 0x01);
  Reader header = records.front().read();
  EXPECT_EQ(header.text(), "ros1");
  EXPECT_EQ(header.text(), "bin_scenes");
  EXPECT_TRUE(header.done());
  EXPECT_EQ(records.back().op, 0x0f);

  std::size_t next = 0;
  std::set<std::uint64_t> schemas, channels;
  for (const Record& record : of(0x06, records)) {
    const Chunk chunk = unpacked(record);
    for (const Record& inside : records_of(chunk.bytes, 0, chunk.bytes.size())) {
      Reader reader = inside.read();
      const std::uint64_t id = reader.number(2);
      if (inside.op == 0x03) {
        EXPECT_NE(id, 0u);
        schemas.insert(id);
      } else if (inside.op == 0x04) {
        EXPECT_EQ(schemas.count(reader.number(2)), 1u) << "a type is told before its channel";
        channels.insert(id);
      } else {
        ASSERT_EQ(inside.op, 0x05);
        ASSERT_LT(next, sent.size());
        EXPECT_EQ(channels.count(id), 1u) << "a channel is told before its messages";
        expect_same(message_of(inside), sent[next++]);
      }
    }
  }
  EXPECT_EQ(next, sent.size());
  EXPECT_EQ(schemas.size(), 2u);
  EXPECT_EQ(channels.size(), 3u);
}

TEST_F(Mcap, TheIndexPointsAtEveryMessage) {
  std::size_t found = 0;
  const std::vector<Record> chunks = of(0x08, summary_records());
  EXPECT_EQ(chunks.size(), of(0x06, data_section()).size());
  EXPECT_GE(chunks.size(), 5u);
  for (const Record& record : chunks) {
    Reader index = record.read();
    const std::uint64_t first = index.number(8), last = index.number(8), start = index.number(8),
                        size = index.number(8);
    const std::vector<Record> at = records_of(bytes, start, start + size);
    ASSERT_EQ(at.size(), 1u);
    ASSERT_EQ(at[0].op, 0x06);
    const Chunk chunk = unpacked(at[0]);
    EXPECT_EQ(chunk.first, first);
    EXPECT_EQ(chunk.last, last);
    std::uint64_t earliest = ~0ull, latest = 0;
    Reader places(index.text());
    const std::uint64_t index_size = index.number(8);
    for (const Record& one : records_of(bytes, start + size, start + size + index_size)) {
      const std::uint64_t channel = places.number(2);
      EXPECT_EQ(places.number(8), one.start);
      ASSERT_EQ(one.op, 0x07);
      Reader entries = one.read();
      EXPECT_EQ(entries.number(2), channel);
      for (Reader list(entries.text()); !list.done(); ++found) {
        const std::uint64_t time = list.number(8), offset = list.number(8);
        Reader message(chunk.bytes, offset);
        ASSERT_EQ(message.number(1), 0x05u);
        message.number(8);
        EXPECT_EQ(message.number(2), channel);
        message.number(4);
        EXPECT_EQ(message.number(8), time);
        earliest = std::min(earliest, time);
        latest = std::max(latest, time);
      }
    }
    EXPECT_TRUE(places.done());
    EXPECT_EQ(first, earliest);
    EXPECT_EQ(last, latest);
    EXPECT_EQ(index.text(), "zstd");
    index.number(8);
    EXPECT_EQ(index.number(8), chunk.bytes.size());
    EXPECT_TRUE(index.done());
  }
  EXPECT_EQ(found, sent.size());
}

TEST_F(Mcap, ChecksumsAreThoseOfTheBytes) {
  const Record end = data_section().back();
  EXPECT_EQ(end.read().number(4), crc_of(bytes.substr(0, end.start)));
  EXPECT_EQ(summary_crc, crc_of(bytes.substr(summary, bytes.size() - magic.size() - 4 - summary)));
  const Record note = of(0x09, data_section()).at(0);
  EXPECT_EQ(Reader(note.content, note.content.size() - 4).number(4),
            crc_of(note.content.substr(0, note.content.size() - 4)));
}

TEST_F(Mcap, StatisticsCount) {
  Reader statistics = of(0x0b, summary_records()).at(0).read();
  EXPECT_EQ(statistics.number(8), 300u);
  EXPECT_EQ(statistics.number(2), 2u);
  EXPECT_EQ(statistics.number(4), 3u);
  EXPECT_EQ(statistics.number(4), 1u) << "attachments";
  EXPECT_EQ(statistics.number(4), 1u) << "metadata";
  EXPECT_EQ(statistics.number(4), of(0x06, data_section()).size());
  EXPECT_EQ(statistics.number(8), begin);
  EXPECT_EQ(statistics.number(8), begin + 298'000'000'000ull);
  Reader list(statistics.text());
  for (const auto& [channel, count] : counts) {
    EXPECT_EQ(list.number(2), static_cast<std::uint64_t>(channel));
    EXPECT_EQ(list.number(8), count);
  }
  EXPECT_TRUE(list.done());
  EXPECT_TRUE(statistics.done());
}

TEST_F(Mcap, SummaryIsGroupedAndItsOffsetsTellWhere) {
  std::set<int> seen;
  std::size_t place = summary;
  for (const Record& record : records_of(bytes, offsets, bytes.size() - magic.size() - 29)) {
    ASSERT_EQ(record.op, 0x0e);
    Reader reader = record.read();
    const int op = static_cast<int>(reader.number(1));
    EXPECT_TRUE(seen.insert(op).second);
    EXPECT_EQ(reader.number(8), place) << "groups are one behind another";
    const std::size_t size = reader.number(8);
    for (const Record& one : records_of(bytes, place, place + size)) EXPECT_EQ(one.op, op);
    place += size;
  }
  EXPECT_EQ(place, offsets);
  EXPECT_EQ(seen, (std::set<int>{0x03, 0x04, 0x08, 0x0a, 0x0b, 0x0d}));
}

TEST_F(Mcap, AttachmentsAndMetadataAreFoundByTheirIndex) {
  Reader index = of(0x0a, summary_records()).at(0).read();
  const std::size_t start = index.number(8), size = index.number(8);
  const Record note = records_of(bytes, start, start + size).at(0);
  ASSERT_EQ(note.op, 0x09);
  Reader reader = note.read();
  EXPECT_EQ(reader.number(8), index.number(8));
  EXPECT_EQ(reader.number(8), index.number(8));
  EXPECT_EQ(index.number(8), 6u);
  EXPECT_EQ(index.text(), reader.text());
  EXPECT_EQ(index.text(), reader.text());
  EXPECT_EQ(reader.take(reader.number(8)), "a note");

  Reader facts_index = of(0x0d, summary_records()).at(0).read();
  const std::size_t facts_start = facts_index.number(8), facts_size = facts_index.number(8);
  Reader facts = records_of(bytes, facts_start, facts_start + facts_size).at(0).read();
  EXPECT_EQ(facts.text(), facts_index.text());
  Reader list(facts.text());
  for (const char* text : {"seed", "7", "solver", "sphere"}) EXPECT_EQ(list.text(), text);
}

TEST_F(Mcap, AFileThatIsCutOffIsReadUpToItsLastWholeChunk) {
  const std::vector<Record> chunks = of(0x06, data_section());
  const Record& last = chunks.at(3);
  const std::string cut = bytes.substr(0, last.start + last.size / 2);
  std::size_t next = 0;
  Reader reader(cut, magic.size());
  EXPECT_THROW(
      while (true) {
        Record record;
        record.op = static_cast<int>(reader.number(1));
        record.content = reader.take(reader.number(8));
        if (record.op != 0x06) continue;
        const Chunk chunk = unpacked(record);
        for (const Record& inside : records_of(chunk.bytes, 0, chunk.bytes.size()))
          if (inside.op == 0x05) expect_same(message_of(inside), sent.at(next++));
      },
      std::out_of_range);
  EXPECT_GT(next, 100u) << "three chunks";
}

TEST_F(Mcap, AFullDiskIsOneErrorAndLeavesNothing) {
  std::filesystem::remove(dir / "a.mcap");
  rlimit old;
  getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  // Full at once, in a chunk, and in the summary.
  for (const std::size_t room : {std::size_t{4}, bytes.size() / 2, bytes.size() - 100}) {
    const rlimit little = {room, old.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
    const ErrorKind kind = kind_of_failure([&] { SetUp(); });
    setrlimit(RLIMIT_FSIZE, &old);
    EXPECT_EQ(kind, ErrorKind::environment) << room;
    EXPECT_EQ(entries(), 0u) << room;
  }
  std::signal(SIGXFSZ, handler);
}

TEST_F(Mcap, OfNothingIsAFileToo) {
  McapFile file(path("none.mcap"), "ros2");
  file.close();
  EXPECT_EQ(mcap_profile_in(path("none.mcap")), "ros2");
  EXPECT_EQ(mcap_profile_in(path("a.mcap")), "ros1");
  EXPECT_EQ(mcap_profile_in(path("missing.mcap")), "");
  write_text(path("short.mcap"), "\x89MCAP");
  EXPECT_EQ(mcap_profile_in(path("short.mcap")), "");
  const std::string none = text("none.mcap");
  EXPECT_EQ(records_of(none, magic.size(), none.size() - magic.size()).back().op, 0x02);
}

}  // namespace
}  // namespace bin_scenes
