/// A PNG as libpng reads it, with what its header says.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace bin_scenes {

struct Png {
  int width = 0, height = 0, depth = 0, channels = 0;
  std::vector<std::uint16_t> samples;
  std::uint16_t at(int x, int y, int c = 0) const { return samples[(std::size_t(y) * width + x) * channels + c]; }
};

inline Png read_png(const std::string& path) {
  Png image;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (!file) {
    ADD_FAILURE() << "no file " << path;
    return image;
  }
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  image.width = static_cast<int>(png_get_image_width(png, info));
  image.height = static_cast<int>(png_get_image_height(png, info));
  image.depth = png_get_bit_depth(png, info);
  image.channels = png_get_channels(png, info);
  png_bytepp rows = png_get_rows(png, info);
  for (int y = 0; y < image.height; ++y) {
    for (int i = 0; i < image.width * image.channels; ++i) {
      const png_bytep p = rows[y] + i * image.depth / 8;
      image.samples.push_back(image.depth == 16 ? static_cast<std::uint16_t>(p[0] << 8 | p[1]) : p[0]);
    }
  }
  png_destroy_read_struct(&png, &info, nullptr);
  std::fclose(file);
  return image;
}

}  // namespace bin_scenes
