#include "output/jpeg.hpp"

#include "bin_scenes/core/error.hpp"

#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include <algorithm>
#include <cstdlib>

namespace bin_scenes {

namespace {

[[noreturn]] void on_error(j_common_ptr encoder) {
  char text[JMSG_LENGTH_MAX];
  encoder->err->format_message(encoder, text);
  throw environment_error(std::string("JPEG encoder: ") + text, "image", "check the image size and free memory");
}

}  // namespace

Bytes rgb_jpeg(int width, int height, const std::vector<std::uint8_t>& samples) {
  struct Writer {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    unsigned char* data = nullptr;
    unsigned long size = 0;
    Writer() {
      jpeg.err = jpeg_std_error(&errors);
      errors.error_exit = on_error;
      jpeg_create_compress(&jpeg);
    }
    ~Writer() {
      jpeg_destroy_compress(&jpeg);
      std::free(data);
    }
  } writer;
  jpeg_compress_struct& jpeg = writer.jpeg;
  jpeg_mem_dest(&jpeg, &writer.data, &writer.size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  constexpr int quality = 95;
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<std::uint8_t> row(3 * static_cast<std::size_t>(width));  // libjpeg wants bytes that are not const
  for (int y = 0; y < height; ++y) {
    std::copy_n(&samples[static_cast<std::size_t>(y) * row.size()], row.size(), row.begin());
    JSAMPROW rows[] = {row.data()};
    jpeg_write_scanlines(&jpeg, rows, 1);
  }
  jpeg_finish_compress(&jpeg);
  return Bytes(writer.data, writer.data + writer.size);
}

}  // namespace bin_scenes
