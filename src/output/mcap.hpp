/// Writes the container format MCAP: messages, their definitions and an index in one file. It follows the specification
/// (mcap.dev, version 0), compresses chunks with zstd, and adds checksums to all of them. The caller provides the
/// messages; this writer does not know their contents.
#pragma once

#include "output/whole_file.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bin_scenes {

using McapTexts = std::map<std::string, std::string>;

/// Definition of a message type.
struct McapSchema {
  std::string name, encoding, text;
};

/// A channel: messages of one topic and one type.
struct McapChannel {
  std::string topic;
  std::string encoding;  ///< encoding of the messages
  McapSchema schema;
  McapTexts metadata;
};

/// An MCAP file that is written from front to back and gets its name with close(). Times are in ns since the epoch. A
/// file that is truncated after a chunk can be read up to there, because each chunk declares the types and channels
/// that begin in it. All functions throw an environment Error if the file cannot be written.
class McapFile {
 public:
  McapFile(const std::string& path, const std::string& profile);

  using ChannelId = std::uint16_t;
  ChannelId add_channel(const McapChannel& channel);
  void write(ChannelId channel, std::uint64_t time, const void* data, std::size_t size);
  void attach(const std::string& name, const std::string& media_type, std::uint64_t time, const std::string& data);
  void add_metadata(const std::string& name, const McapTexts& texts);
  void close();

 private:
  struct Span {  ///< times from the earliest to the latest message (ns)
    std::uint64_t first = 0, last = 0;
    bool empty = true;
    void add(std::uint64_t time);
  };
  void put(const std::string& bytes);
  void flush();
  std::uint16_t schema_id(const McapSchema& schema);
  std::string write_message_index();
  std::string statistics() const;
  std::string summary_offsets(std::uint64_t start, std::string& summary) const;

  WholeFile file_;
  std::uint32_t crc_ = 0;  ///< checksum of the bytes written so far
  std::string chunk_;      ///< records of the open chunk
  /// For each channel, time (ns) and offset of each message in the open chunk.
  std::map<ChannelId, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index_;
  Span chunk_span_, span_;  ///< first and last time of the open chunk, and of all messages

  std::vector<McapSchema> schemas_;                         ///< index: id - 1
  std::map<ChannelId, std::uint64_t> counts_;               ///< number of messages of each channel
  std::uint32_t chunks_ = 0, attachments_ = 0, texts_ = 0;  ///< numbers of records of each kind
  /// Records of the summary section that have been collected so far.
  std::string schema_records_, channel_records_, chunk_indices_, attachment_indices_, metadata_indices_;
};

}  // namespace bin_scenes
