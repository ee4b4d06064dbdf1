/// Writes images as PNG files without loss, and writes bytes to a file in one piece. It converts depth, SNR and normals
/// to the integers that files hold, and draws pictures for people; png_reader.hpp reads the files again.
#pragma once

#include "bin_scenes/sensor/range_image.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

using Bytes = std::vector<std::uint8_t>;

/// Row-major samples, `channels` (1 = grey, 3 = RGB) a pixel. Throws an environment Error.
Bytes png8(int width, int height, int channels, const std::vector<std::uint8_t>& samples);
Bytes png16(int width, int height, const std::vector<std::uint16_t>& samples, int channels = 1);
/// Writes a picture with its number of bits.
Bytes png_of(int width, int height, const Picture& picture);
/// Its upper eight bits.
std::vector<std::uint8_t> in_bytes(const Picture& picture);

/// A picture of few colours: a third of the bytes of RGB, and of the time to pack them.
struct Palette {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< at most 256
  std::vector<std::uint8_t> pixels;                  ///< row-major, index into colours
};
Bytes png_of(const Palette& picture);

/// Depth in counts of the sensor's depth_scale, 0 where nothing is valid, 65535 where it is that many or more.
std::vector<std::uint16_t> counted_depth(const std::vector<float>& depth, double scale);

/// Tenths of the SNR, 0 where it is 0, 65535 where it is that many tenths or more.
std::vector<std::uint16_t> counted_snr(const std::vector<float>& snr);

/// Three channels of 8 bits: n = value / 127.5 - 1; black where there is nothing.
std::vector<std::uint8_t> counted_normals(const std::vector<std::array<float, 3>>& normals);

/// The scene as a picture, RGB: a colour a part, light from the upper left, edges and hollows darkened.
std::vector<std::uint8_t> shaded_picture(const RangeImage& image);
/// Depth in colours, with a bar that gives their scale in metres.
Palette depth_picture(const RangeImage& image);
/// Validity in colours, with a legend of the codes that occur.
Palette validity_picture(const RangeImage& image);

/// Through a temporary name.
void write_bytes(const std::string& path, const void* data, std::size_t size);
inline void write_bytes(const std::string& path, const Bytes& bytes) {
  write_bytes(path, bytes.data(), bytes.size());
}

}  // namespace bin_scenes
