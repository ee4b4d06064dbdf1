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

/// Returns a PNG file. `samples` are row-major with `channels` values per pixel (1: grey, 3: RGB).
Bytes png8(int width, int height, int channels, const std::vector<std::uint8_t>& samples);
Bytes png16(int width, int height, const std::vector<std::uint16_t>& samples, int channels = 1);
/// Returns a PNG file with the bit depth of the picture.
Bytes png_of(int width, int height, const Picture& picture);
/// Returns the upper eight bits of each sample.
std::vector<std::uint8_t> in_bytes(const Picture& picture);

/// A picture of few colours: its PNG file needs a third of the bytes and of the compression time of an RGB picture.
struct Palette {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< at most 256
  std::vector<std::uint8_t> pixels;                  ///< row-major, index into colours
};
Bytes png_of(const Palette& picture);

/// Returns depth / `scale` as integers; 0 where depth is not valid, and 65535 for this value and above.
std::vector<std::uint16_t> counted_depth(const std::vector<float>& depth, double scale);

/// Returns 10 * SNR as integers; 65535 for this value and above.
std::vector<std::uint16_t> counted_snr(const std::vector<float>& snr);

/// Returns normals as RGB, 8 bits per channel: n = value / 127.5 - 1; black where there is no surface.
std::vector<std::uint8_t> counted_normals(const std::vector<std::array<float, 3>>& normals);

/// Returns an RGB picture of the scene: one colour per part, light from the upper left, darkened edges and hollows.
std::vector<std::uint8_t> shaded_picture(const RangeImage& image);
/// Returns depth as colours, with a colour bar in metres.
Palette depth_picture(const RangeImage& image);
/// Returns validity codes as colours, with a legend of the codes that occur.
Palette validity_picture(const RangeImage& image);

/// Writes a file under a temporary name and renames it, so that the file is never incomplete.
void write_bytes(const std::string& path, const void* data, std::size_t size);
inline void write_bytes(const std::string& path, const Bytes& bytes) {
  write_bytes(path, bytes.data(), bytes.size());
}

}  // namespace bin_scenes
