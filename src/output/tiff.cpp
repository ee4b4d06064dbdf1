#include "output/tiff.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "core/read_file.hpp"

#include <zlib.h>

#include <cstring>
#include <map>

namespace bin_scenes {

namespace {

constexpr std::size_t entry_bytes = 12;
enum Tag : std::uint16_t {
  columns = 256,
  rows = 257,
  sample_bits = 258,
  packing = 259,
  meaning = 262,
  strip_begin = 273,
  samples_a_pixel = 277,
  strip_rows = 278,
  strip_bytes = 279
};

template <class Number>
void put(Bytes& bytes, Number value) {
  for (std::size_t i = 0; i < sizeof value; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xff));
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value = 0;
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// `samples`: little-endian, as the header says.
Bytes encode(int width, int height, int channels, int bits, const std::vector<std::uint8_t>& samples) {
  BIN_SCENES_ASSERT(8 * samples.size() ==
                    static_cast<std::size_t>(width * channels * bits) * static_cast<std::size_t>(height));
  uLongf size = compressBound(static_cast<uLong>(samples.size()));
  Bytes packed(size);
  if (compress2(packed.data(), &size, samples.data(), static_cast<uLong>(samples.size()), 1) != Z_OK)
    throw environment_error("zlib cannot pack an image", "image", "check free memory");
  packed.resize(size);
  if (packed.size() % 2 != 0) packed.push_back(0);  // what follows begins at an even byte
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count, value;
  };
  constexpr std::uint16_t shorts = 3, longs = 4;
  const auto many = static_cast<std::uint32_t>(channels);
  // Three numbers of bits do not fit into their entry: they lie between the image and the directory.
  const std::uint32_t bits_at = 8 + static_cast<std::uint32_t>(packed.size());
  const std::uint32_t directory = bits_at + (channels > 1 ? 2 * many : 0);
  const std::vector<Entry> entries = {{columns, longs, 1, static_cast<std::uint32_t>(width)},
                                      {rows, longs, 1, static_cast<std::uint32_t>(height)},
                                      {sample_bits, shorts, many, channels > 1 ? bits_at : std::uint32_t(bits)},
                                      {packing, shorts, 1, 8},                       // deflate
                                      {meaning, shorts, 1, channels > 1 ? 2u : 1u},  // RGB, or 0 is black
                                      {strip_begin, longs, 1, 8},
                                      {samples_a_pixel, shorts, 1, many},
                                      {strip_rows, longs, 1, static_cast<std::uint32_t>(height)},
                                      {strip_bytes, longs, 1, static_cast<std::uint32_t>(size)}};
  Bytes bytes = {'I', 'I', 42, 0};
  put(bytes, directory);
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  for (int i = 0; channels > 1 && i < channels; ++i) put(bytes, static_cast<std::uint16_t>(bits));
  put(bytes, static_cast<std::uint16_t>(entries.size()));
  for (const Entry& entry : entries) {
    put(bytes, entry.tag);
    put(bytes, entry.type);
    put(bytes, entry.count);
    put(bytes, entry.value);
  }
  put(bytes, std::uint32_t{0});
  return bytes;
}

}  // namespace

Bytes tiff8(int width, int height, int channels, const std::vector<std::uint8_t>& samples) {
  return encode(width, height, channels, 8, samples);
}

Bytes tiff16(int width, int height, const std::vector<std::uint16_t>& samples) {
  Bytes little_endian;
  little_endian.reserve(2 * samples.size());
  for (const std::uint16_t sample : samples) put(little_endian, sample);
  return encode(width, height, 1, 16, little_endian);
}

LoadedImage load_tiff(const std::string& path) {
  const std::string bytes = read_file(path);
  std::map<std::uint16_t, std::uint32_t> tags;
  const std::size_t directory = number_at<std::uint32_t>(bytes, 4);
  const std::size_t count = number_at<std::uint16_t>(bytes, directory);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = directory + 2 + entry_bytes * i;
    tags[number_at<std::uint16_t>(bytes, entry)] = number_at<std::uint32_t>(bytes, entry + 8);
  }
  LoadedImage image;
  image.width = static_cast<int>(tags[columns]);
  image.height = static_cast<int>(tags[rows]);
  image.channels = static_cast<int>(tags[samples_a_pixel]);
  image.bits = image.channels == 1 ? static_cast<int>(tags[sample_bits])
                                   : static_cast<int>(number_at<std::uint16_t>(bytes, tags[sample_bits]));
  const std::size_t begin = tags[strip_begin], size = tags[strip_bytes], wide = image.bits == 16 ? 2 : 1;
  constexpr double most_packed = 1040.0;  // bytes of zlib in one: a damaged header must not ask for all memory
  const double stated = 1.0 * tags[columns] * tags[rows] * tags[samples_a_pixel] * static_cast<double>(wide);
  const bool there =
      bytes.rfind("II*", 0) == 0 && begin + size <= bytes.size() && stated <= most_packed * static_cast<double>(size);
  std::string plain(there ? static_cast<std::size_t>(stated) : 0, '\0');
  uLongf length = plain.size();
  if (!there ||
      uncompress(reinterpret_cast<Bytef*>(plain.data()), &length, reinterpret_cast<const Bytef*>(bytes.data() + begin),
                 size) != Z_OK ||
      length != plain.size())
    throw input_error("is no whole TIFF of this project", path, "make the scene anew");
  for (std::size_t i = 0; i < plain.size(); i += wide)
    image.samples.push_back(wide == 2 ? number_at<std::uint16_t>(plain, i) : static_cast<std::uint8_t>(plain[i]));
  return image;
}

}  // namespace bin_scenes
