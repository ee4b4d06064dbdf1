/// Writes PNG by hand: rows of runs and one Huffman table of fixed lengths, without a search for matches.
#include "bop/masks.hpp"

#include <zlib.h>

#include <algorithm>

namespace bin_scenes {

namespace {

// Deflate (RFC 1951) of runs of equal bytes: a literal, then matches of distance 1. One code serves all masks; it gives
// one bit to the longest match, 258 bytes, of which an empty mask is made.
constexpr int end_of_block = 256, longest = 258, length_codes = 29;
constexpr int first_length[length_codes] = {3,  4,  5,  6,  7,  8,  9,  10, 11,  13,  15,  17,  19,  23, 27,
                                            31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr int extra_bits[length_codes] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                          2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};

struct HuffmanCode {
  std::uint32_t bits = 0;
  int length = 0;
};

/// Codes of given lengths, bits reversed as they are written (RFC 1951, 3.2.2).
std::vector<HuffmanCode> canonical(const std::vector<int>& lengths) {
  std::vector<HuffmanCode> codes(lengths.size());
  std::uint32_t next = 0;
  for (int length = 1; length <= 15; ++length) {
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
      if (lengths[symbol] != length) continue;
      std::uint32_t reversed = 0;
      for (int bit = 0; bit < length; ++bit) reversed |= (next >> bit & 1u) << (length - 1 - bit);
      codes[symbol] = {reversed, length};
      ++next;
    }
    next <<= 1;
  }
  return codes;
}

class BitWriter {
 public:
  explicit BitWriter(Bytes& bytes) : bytes_(bytes) {}
  void put(std::uint32_t bits, int count) {
    pending_ |= static_cast<std::uint64_t>(bits) << filled_;
    for (filled_ += count; filled_ >= 8; filled_ -= 8, pending_ >>= 8) bytes_.push_back(pending_ & 0xff);
  }
  void put(const HuffmanCode& code) { put(code.bits, code.length); }
  void finish() {
    if (filled_ > 0) bytes_.push_back(pending_ & 0xff);
  }

 private:
  Bytes& bytes_;
  std::uint64_t pending_ = 0;
  int filled_ = 0;
};

/// Lengths of the codes of literals 0 and 255, end of block and match lengths; together they fill the code space.
std::vector<int> symbol_lengths() {
  std::vector<int> lengths(end_of_block + 1 + length_codes, 0);
  lengths[0] = lengths[255] = 3;
  for (int symbol = end_of_block; symbol < end_of_block + length_codes; ++symbol) {
    lengths[static_cast<std::size_t>(symbol)] = symbol < end_of_block + 3 ? 6 : 7;
  }
  lengths.back() = 1;
  return lengths;
}

/// A zlib stream of runs.
class RunStream {
 public:
  explicit RunStream(Bytes& bytes) : bytes_(bytes), out_(bytes), codes_(canonical(symbol_lengths())) {
    bytes.push_back(0x78);
    bytes.push_back(0x01);
    out_.put(1, 1);  // last block
    out_.put(2, 2);  // with codes of its own
    header();
  }
  void run(std::uint8_t value, std::size_t count) {
    if (count == 0) return;
    if (value != value_) flush();
    value_ = value;
    count_ += count;
  }
  void finish() {
    flush();
    out_.put(codes_[end_of_block]);
    out_.finish();
    for (const std::uint64_t half : {b_, a_}) {
      bytes_.push_back(static_cast<std::uint8_t>(half >> 8));
      bytes_.push_back(static_cast<std::uint8_t>(half & 0xff));
    }
  }

 private:
  /// The table of code lengths, itself in codes (RFC 1951, 3.2.7).
  void header() {
    constexpr int order[19] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
    std::vector<int> lengths(19, 0);
    lengths[7] = 1;
    lengths[1] = lengths[3] = lengths[6] = lengths[18] = 3;
    const std::vector<HuffmanCode> codes = canonical(lengths);
    const std::vector<int> symbols = symbol_lengths();
    out_.put(static_cast<std::uint32_t>(symbols.size()) - 257u, 5);
    out_.put(0, 5);  // one distance
    out_.put(19 - 4, 4);
    for (const int symbol : order) out_.put(static_cast<std::uint32_t>(lengths[static_cast<std::size_t>(symbol)]), 3);
    for (std::size_t i = 0; i < symbols.size(); ++i) {
      if (i == 1) {  // 254 literals that do not occur
        for (const std::uint32_t zeros : {138u, 116u}) {
          out_.put(codes[18]);
          out_.put(zeros - 11u, 7);
        }
        i = 255;
      }
      out_.put(codes[static_cast<std::size_t>(symbols[i])]);
    }
    out_.put(codes[1]);  // the distance's code has one bit
  }

  void flush() {
    if (count_ == 0) return;
    out_.put(codes_[value_]);
    for (std::size_t left = count_ - 1; left > 0;) {
      if (left < 3) {
        out_.put(codes_[value_]);
        --left;
        continue;
      }
      const int length = static_cast<int>(std::min<std::size_t>(left, longest));
      const int* found = std::upper_bound(first_length, first_length + length_codes, length) - 1;
      const auto index = static_cast<std::size_t>(found - first_length);
      out_.put(codes_[end_of_block + 1 + index]);
      if (extra_bits[index]) out_.put(static_cast<std::uint32_t>(length - *found), extra_bits[index]);
      out_.put(0, 1);  // distance 1
      left -= static_cast<std::size_t>(length);
    }
    // Adler-32 of the run, in closed form.
    constexpr std::uint64_t prime = 65521;
    const std::uint64_t n = count_, v = value_;
    b_ = (b_ + n % prime * a_ + n * (n + 1) / 2 % prime * v) % prime;
    a_ = (a_ + n % prime * v) % prime;
    count_ = 0;
  }

  Bytes& bytes_;
  BitWriter out_;
  const std::vector<HuffmanCode> codes_;
  std::uint8_t value_ = 0;
  std::size_t count_ = 0;
  std::uint64_t a_ = 1, b_ = 0;
};

void put32(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xff));
}

void chunk(Bytes& bytes, const char* type, const Bytes& data) {
  put32(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = bytes.size();
  bytes.insert(bytes.end(), type, type + 4);
  bytes.insert(bytes.end(), data.begin(), data.end());
  put32(bytes, static_cast<std::uint32_t>(crc32(0, &bytes[start], static_cast<uInt>(bytes.size() - start))));
}

}  // namespace

Bytes mask_png(int width, int height, const MaskBox& box) {
  Bytes data;
  RunStream runs(data);
  const auto row = static_cast<std::size_t>(width) + 1;  // a filter byte of 0 before each row's pixels
  runs.run(0, row * static_cast<std::size_t>(box.top));
  for (int y = 0; y < box.height; ++y) {
    runs.run(0, 1 + static_cast<std::size_t>(box.left));
    const std::uint8_t* at = box.inside.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(box.width);
    const std::uint8_t* const end = at + box.width;
    while (at < end) {
      const std::uint8_t* const next = std::find(at, end, static_cast<std::uint8_t>(!*at));
      runs.run(*at ? 255 : 0, static_cast<std::size_t>(next - at));
      at = next;
    }
    runs.run(0, static_cast<std::size_t>(width - box.left - box.width));
  }
  runs.run(0, row * static_cast<std::size_t>(height - box.top - box.height));
  runs.finish();

  Bytes header, bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  put32(header, static_cast<std::uint32_t>(width));
  put32(header, static_cast<std::uint32_t>(height));
  header.insert(header.end(), {8, 0, 0, 0, 0});  // bits, grey, deflate, filters, not interlaced
  chunk(bytes, "IHDR", header);
  chunk(bytes, "IDAT", data);
  chunk(bytes, "IEND", {});
  return bytes;
}

}  // namespace bin_scenes
