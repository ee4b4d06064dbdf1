/// Records as the specification numbers them. A chunk is kept in memory until it is full; what the summary needs of it
/// is remembered then.
#include "output/mcap.hpp"

#include "bin_scenes/core/error.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>

namespace bin_scenes {

namespace {

const std::string magic("\x89MCAP0\r\n", 8);
constexpr std::size_t chunk_size = 1 << 20;  // bytes; a larger message has a chunk of its own
constexpr int compression_level = 1;         // clouds and depths are noise below some digit, which no level packs

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0a,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

/// Fields one behind another, as all records hold them: numbers with the low byte first, texts behind their lengths.
class Fields {
 public:
  template <class Number>
  Fields& number(Number value) {
    for (std::size_t i = 0; i < sizeof(value); ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
    return *this;
  }
  Fields& text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes += value;
    return *this;
  }
  Fields& texts(const McapTexts& values) {
    Fields inside;
    for (const auto& [key, value] : values) inside.text(key).text(value);
    return text(inside.bytes);
  }

  std::string bytes;
};

/// What stands before the content of a record.
std::string head(Op op, std::uint64_t size) {
  return Fields().number(static_cast<std::uint8_t>(op)).number(size).bytes;
}

std::string record(Op op, const Fields& content) {
  return head(op, content.bytes.size()) + content.bytes;
}

std::uint32_t crc_of(const std::string& bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string packed(const std::string& bytes) {
  std::string result(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), compression_level);
  if (ZSTD_isError(size)) throw environment_error(ZSTD_getErrorName(size), "zstd", "free memory");
  result.resize(size);
  return result;
}

}  // namespace

void McapFile::Span::add(std::uint64_t time) {
  first = empty ? time : std::min(first, time);
  last = std::max(last, time);
  empty = false;
}

McapFile::McapFile(const std::string& path, const std::string& profile) : file_(path) {
  put(magic);
  put(record(Op::header, Fields().text(profile).text("bin_scenes")));
}

void McapFile::put(const std::string& bytes) {
  crc_ = crc_of(bytes, crc_);
  file_.append(bytes.data(), bytes.size());
}

std::uint16_t McapFile::schema_id(const McapSchema& schema) {
  const auto same = [&](const McapSchema& known) {
    return known.name == schema.name && known.encoding == schema.encoding && known.text == schema.text;
  };
  const auto known = std::find_if(schemas_.begin(), schemas_.end(), same);
  const auto id = static_cast<std::uint16_t>(known - schemas_.begin() + 1);  // 0 stands for none
  if (known != schemas_.end()) return id;
  schemas_.push_back(schema);
  const std::string one =
      record(Op::schema, Fields().number(id).text(schema.name).text(schema.encoding).text(schema.text));
  chunk_ += one;
  schema_records_ += one;
  return id;
}

McapFile::ChannelId McapFile::add_channel(const McapChannel& channel) {
  const std::uint16_t schema = schema_id(channel.schema);
  const auto id = static_cast<ChannelId>(counts_.size());
  counts_[id] = 0;
  const std::string one =
      record(Op::channel,
             Fields().number(id).number(schema).text(channel.topic).text(channel.encoding).texts(channel.metadata));
  chunk_ += one;
  channel_records_ += one;
  return id;
}

void McapFile::write(ChannelId channel, std::uint64_t time, const void* data, std::size_t size) {
  std::uint64_t& count = counts_.at(channel);
  Fields fields;
  fields.number(channel).number(static_cast<std::uint32_t>(count)).number(time).number(time);
  index_[channel].emplace_back(time, chunk_.size());
  chunk_ += head(Op::message, fields.bytes.size() + size) + fields.bytes;
  chunk_.append(static_cast<const char*>(data), size);
  chunk_span_.add(time);
  span_.add(time);
  ++count;
  if (chunk_.size() >= chunk_size) flush();
}

/// Behind its chunk. Returns the map from channels to places in the file that the chunk's index has.
std::string McapFile::write_message_index() {
  Fields places;
  for (const auto& [channel, messages] : index_) {
    places.number(channel).number(file_.size());
    Fields entries;
    for (const auto& [time, offset] : messages) entries.number(time).number(offset);
    put(record(Op::message_index, Fields().number(channel).text(entries.bytes)));
  }
  return places.bytes;
}

void McapFile::flush() {
  if (chunk_.empty()) return;
  const std::string records = packed(chunk_);
  Fields fields;
  fields.number(chunk_span_.first).number(chunk_span_.last).number(std::uint64_t{chunk_.size()});
  fields.number(crc_of(chunk_)).text("zstd").number(std::uint64_t{records.size()});
  const std::uint64_t start = file_.size();
  put(head(Op::chunk, fields.bytes.size() + records.size()) + fields.bytes);
  put(records);
  const std::uint64_t end = file_.size();
  const std::string places = write_message_index();
  chunk_indices_ += record(Op::chunk_index, Fields()
                                                .number(chunk_span_.first)
                                                .number(chunk_span_.last)
                                                .number(start)
                                                .number(end - start)
                                                .text(places)
                                                .number(file_.size() - end)
                                                .text("zstd")
                                                .number(std::uint64_t{records.size()})
                                                .number(std::uint64_t{chunk_.size()}));
  ++chunks_;
  chunk_.clear();
  index_.clear();
  chunk_span_ = Span();
}

void McapFile::attach(const std::string& name, const std::string& media_type, std::uint64_t time,
                      const std::string& data) {
  Fields fields;
  fields.number(time).number(time).text(name).text(media_type).number(std::uint64_t{data.size()});
  fields.bytes += data;
  fields.number(crc_of(fields.bytes));
  const std::string whole = record(Op::attachment, fields);
  Fields index;
  index.number(file_.size()).number(std::uint64_t{whole.size()}).number(time).number(time);
  index.number(std::uint64_t{data.size()}).text(name).text(media_type);
  attachment_indices_ += record(Op::attachment_index, index);
  put(whole);
  ++attachments_;
}

void McapFile::add_metadata(const std::string& name, const McapTexts& texts) {
  const std::string whole = record(Op::metadata, Fields().text(name).texts(texts));
  metadata_indices_ +=
      record(Op::metadata_index, Fields().number(file_.size()).number(std::uint64_t{whole.size()}).text(name));
  put(whole);
  ++texts_;
}

std::string McapFile::statistics() const {
  std::uint64_t messages = 0;
  Fields counts;
  for (const auto& [channel, count] : counts_) {
    messages += count;
    counts.number(channel).number(count);
  }
  Fields fields;
  fields.number(messages).number(static_cast<std::uint16_t>(schemas_.size()));
  fields.number(static_cast<std::uint32_t>(counts_.size())).number(attachments_).number(texts_).number(chunks_);
  return record(Op::statistics, fields.number(span_.first).number(span_.last).text(counts.bytes));
}

/// Fills the summary, which begins at `start`, and returns the places of its groups.
std::string McapFile::summary_offsets(std::uint64_t start, std::string& summary) const {
  std::string offsets;
  const auto group = [&](Op op, const std::string& records) {
    if (records.empty()) return;
    offsets += record(Op::summary_offset, Fields()
                                              .number(static_cast<std::uint8_t>(op))
                                              .number(start + summary.size())
                                              .number(std::uint64_t{records.size()}));
    summary += records;
  };
  group(Op::schema, schema_records_);
  group(Op::channel, channel_records_);
  group(Op::statistics, statistics());
  group(Op::chunk_index, chunk_indices_);
  group(Op::attachment_index, attachment_indices_);
  group(Op::metadata_index, metadata_indices_);
  return offsets;
}

void McapFile::close() {
  flush();
  put(record(Op::data_end, Fields().number(crc_)));
  const std::uint64_t start = file_.size();
  std::string summary;
  const std::string offsets = summary_offsets(start, summary);
  const std::uint64_t offsets_start = start + summary.size();
  // The checksum is over the summary and over the footer up to itself.
  Fields footer;
  footer.number(start).number(offsets_start);
  summary += offsets + head(Op::footer, footer.bytes.size() + sizeof(std::uint32_t)) + footer.bytes;
  put(summary + Fields().number(crc_of(summary)).bytes + magic);
  file_.commit();
}

std::string mcap_profile_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(magic.size() + 1 + 8 + 4 + 16, '\0');  // head of the record, length, a profile of at most 16 bytes
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (begin.compare(0, magic.size(), magic) != 0) return "";
  const std::size_t length_at = magic.size() + 1 + 8;
  return begin.substr(length_at + 4, static_cast<unsigned char>(begin[length_at]));
}

}  // namespace bin_scenes
