#include "output/png_reader.hpp"

#include "bin_scenes/core/error.hpp"
#include "core/read_file.hpp"

#include <png.h>

#include <cstring>

namespace bin_scenes {

namespace {

struct Source {
  const std::string* bytes;
  std::size_t at;
};

void read_some(png_structp png, png_bytep to, png_size_t size) {
  auto& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (size > source.bytes->size() - source.at) png_error(png, "it is cut off");
  std::memcpy(to, source.bytes->data() + source.at, size);
  source.at += size;
}
[[noreturn]] void on_read_error(png_structp png, png_const_charp message) {
  throw input_error(std::string("is no whole PNG: ") + message, *static_cast<std::string*>(png_get_error_ptr(png)),
                    "make the scene anew");
}
void on_read_warning(png_structp, png_const_charp) {}

}  // namespace

LoadedImage load_png(const std::string& path) {
  return png_from(read_file(path), path);
}

LoadedImage png_from(const std::string& bytes, const std::string& where) {
  std::string name = where;
  Source source{&bytes, 0};
  struct Reader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  } reader;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &name, on_read_error, on_read_warning);
  reader.info = png_create_info_struct(reader.png);
  png_set_read_fn(reader.png, &source, read_some);
  png_read_info(reader.png, reader.info);
  png_set_palette_to_rgb(reader.png);
  png_set_expand_gray_1_2_4_to_8(reader.png);
  png_read_update_info(reader.png, reader.info);
  LoadedImage image;
  image.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  image.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  image.channels = png_get_channels(reader.png, reader.info);
  image.bits = png_get_bit_depth(reader.png, reader.info);
  std::vector<std::uint8_t> row(png_get_rowbytes(reader.png, reader.info));
  image.samples.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                        static_cast<std::size_t>(image.channels));
  for (int y = 0; y < image.height; ++y) {
    png_read_row(reader.png, row.data(), nullptr);
    if (image.bits == 8)
      image.samples.insert(image.samples.end(), row.begin(), row.end());
    else
      for (std::size_t i = 0; i + 1 < row.size(); i += 2)
        image.samples.push_back(static_cast<std::uint16_t>(row[i] << 8 | row[i + 1]));
  }
  png_read_end(reader.png, nullptr);
  return image;
}

}  // namespace bin_scenes
