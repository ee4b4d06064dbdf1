#include "output/png.hpp"

#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/scene_writer.hpp"

#include <png.h>

#include <cmath>
#include <filesystem>

namespace bin_scenes {

namespace {

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  throw environment_error(std::string("PNG encoder: ") + message, *static_cast<std::string*>(png_get_error_ptr(png)),
                          "check the image size and free memory");
}
void on_warning(png_structp, png_const_charp) {}
void append(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}
void flush(png_structp) {}

/// `rows` are big-endian for 16 bits, as PNG stores them.
void write_png(const std::string& path, int width, int height, int depth, int colour,
               const std::vector<const std::uint8_t*>& rows) {
  std::string where = path;
  std::vector<std::uint8_t> bytes;
  struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;
    ~Writer() { png_destroy_write_struct(&png, &info); }
  } writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &where, on_error, on_warning);
  writer.info = png_create_info_struct(writer.png);
  png_set_write_fn(writer.png, &bytes, append, flush);
  png_set_IHDR(writer.png, writer.info, width, height, depth, colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(writer.png, 3);  // half the time of the default for some percent of size
  png_write_info(writer.png, writer.info);
  for (const std::uint8_t* row : rows) png_write_row(writer.png, row);
  png_write_end(writer.png, nullptr);
  write_bytes(path, bytes.data(), bytes.size());
}

}  // namespace

void write_png8(const std::string& path, int width, int height, int channels,
                const std::vector<std::uint8_t>& samples) {
  std::vector<const std::uint8_t*> rows;
  for (int y = 0; y < height; ++y) rows.push_back(&samples[static_cast<std::size_t>(y) * width * channels]);
  write_png(path, width, height, 8, channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, rows);
}

void write_png16(const std::string& path, int width, int height, const std::vector<std::uint16_t>& samples) {
  std::vector<std::uint8_t> big_endian;
  big_endian.reserve(2 * samples.size());
  for (const std::uint16_t sample : samples) {
    big_endian.push_back(static_cast<std::uint8_t>(sample >> 8));
    big_endian.push_back(static_cast<std::uint8_t>(sample & 0xff));
  }
  std::vector<const std::uint8_t*> rows;
  for (int y = 0; y < height; ++y) rows.push_back(&big_endian[static_cast<std::size_t>(y) * width * 2]);
  write_png(path, width, height, 16, PNG_COLOR_TYPE_GRAY, rows);
}

std::vector<std::uint16_t> depth_in_tenth_mm(const RangeImage& image) {
  std::vector<std::uint16_t> samples;
  samples.reserve(image.depth.size());
  for (const float z : image.depth) {
    const double steps = std::round(static_cast<double>(z) * 1e4);
    samples.push_back(std::isfinite(z) ? static_cast<std::uint16_t>(std::min(std::max(steps, 1.0), 65535.0)) : 0);
  }
  return samples;
}

void write_pngs(const std::string& directory, const RangeImage& image) {
  const int width = image.sensor.width, height = image.sensor.height;
  const std::string base = (std::filesystem::path(directory) / image.sensor.name).string();
  write_png16(base + "_depth.png", width, height, depth_in_tenth_mm(image));
  write_png16(base + "_labels.png", width, height, image.label);
  write_png8(base + ".png", width, height, 3, shaded_picture(image));
}

}  // namespace bin_scenes
