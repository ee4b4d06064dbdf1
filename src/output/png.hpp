/// Lossless images, and bytes to a file in one go.
#pragma once

#include "bin_scenes/sensor/range_camera.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace bin_scenes {

/// Row-major samples, `channels` (1 = grey, 3 = RGB) a pixel. Throws an environment Error.
void write_png8(const std::string& path, int width, int height, int channels, const std::vector<std::uint8_t>& samples);
void write_png16(const std::string& path, int width, int height, const std::vector<std::uint16_t>& samples);

/// Depth in units of 0.1 mm, 0 where nothing was seen, 65535 where it is 6.5535 m or more.
std::vector<std::uint16_t> depth_in_tenth_mm(const RangeImage& image);

/// The scene as a picture, RGB: a colour a part, light from the upper left, edges and hollows darkened.
std::vector<std::uint8_t> shaded_picture(const RangeImage& image);

/// Through a temporary name.
void write_bytes(const std::string& path, const void* data, std::size_t size);

}  // namespace bin_scenes
