/// Images as PNG: grey or colour of 8 and 16 bits, and labels by a palette.
#include "output/png.hpp"

#include "bin_scenes/core/assertion.hpp"
#include "bin_scenes/core/error.hpp"
#include "bin_scenes/output/image_channel.hpp"
#include "bin_scenes/output/scene_writer.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace bin_scenes {

namespace {

[[noreturn]] void on_error(png_structp, png_const_charp message) {
  throw environment_error(std::string("PNG encoder: ") + message, "image", "check the image size and free memory");
}
void on_warning(png_structp, png_const_charp) {}
void append(png_structp png, png_bytep data, png_size_t size) {
  auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}
void flush(png_structp) {}

struct Layout {
  int width, height, depth, colour;
  int filter;  ///< one filter for all rows: trying all five costs more than it saves
  std::size_t row_bytes;
  const std::vector<std::array<std::uint8_t, 3>>* palette = nullptr;
};

/// Rows big-endian for 16 bits, as PNG stores them.
Bytes encode(const Layout& layout, const std::uint8_t* rows) {
  Bytes bytes;
  struct Writer {
    png_structp png = nullptr;
    png_infop info = nullptr;
    ~Writer() { png_destroy_write_struct(&png, &info); }
  } writer;
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning);
  writer.info = png_create_info_struct(writer.png);
  png_set_write_fn(writer.png, &bytes, append, flush);
  png_set_IHDR(writer.png, writer.info, layout.width, layout.height, layout.depth, layout.colour, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (layout.palette) {
    std::vector<png_color> colours;
    for (const auto& [r, g, b] : *layout.palette) colours.push_back({r, g, b});
    png_set_PLTE(writer.png, writer.info, colours.data(), static_cast<int>(colours.size()));
  }
  png_set_filter(writer.png, 0, layout.filter);
  png_set_compression_level(writer.png, 1);  // a third of the time of the default for a tenth of size
  png_write_info(writer.png, writer.info);
  for (int y = 0; y < layout.height; ++y)
    png_write_row(writer.png, rows + static_cast<std::size_t>(y) * layout.row_bytes);
  png_write_end(writer.png, nullptr);
  return bytes;
}

}  // namespace

Bytes png8(int width, int height, int channels, const std::vector<std::uint8_t>& samples) {
  BIN_SCENES_ASSERT(samples.size() == static_cast<std::size_t>(width * channels) * static_cast<std::size_t>(height));
  const int colour = channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY;
  return encode({width, height, 8, colour, channels == 3 ? PNG_FILTER_SUB : PNG_FILTER_NONE,
                 static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)},
                samples.data());
}

Bytes png16(int width, int height, const std::vector<std::uint16_t>& samples, int channels) {
  BIN_SCENES_ASSERT(samples.size() == static_cast<std::size_t>(width * channels) * static_cast<std::size_t>(height));
  Bytes big_endian(2 * samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    big_endian[2 * i] = static_cast<std::uint8_t>(samples[i] >> 8);
    big_endian[2 * i + 1] = static_cast<std::uint8_t>(samples[i] & 0xff);
  }
  const int colour = channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY;
  const std::size_t row = 2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  return encode({width, height, 16, colour, PNG_FILTER_UP, row}, big_endian.data());
}

std::vector<std::uint8_t> in_bytes(const Picture& picture) {
  std::vector<std::uint8_t> bytes(picture.counts.size());
  std::transform(picture.counts.begin(), picture.counts.end(), bytes.begin(),
                 [&](std::uint16_t count) { return static_cast<std::uint8_t>(count >> (picture.bits - 8)); });
  return bytes;
}

Bytes png_of(int width, int height, const Picture& picture) {
  return picture.bits == 16 ? png16(width, height, picture.counts, picture.channels)
                            : png8(width, height, picture.channels, in_bytes(picture));
}

Bytes png_of(const Palette& picture) {
  BIN_SCENES_ASSERT(each_is(picture.pixels, [&](std::uint8_t pixel) { return pixel < picture.colours.size(); }));
  return encode({picture.width, picture.height, 8, PNG_COLOR_TYPE_PALETTE, PNG_FILTER_NONE,
                 static_cast<std::size_t>(picture.width), &picture.colours},
                picture.pixels.data());
}

std::vector<std::uint16_t> counted_depth(const std::vector<float>& depth, double scale) {
  std::vector<std::uint16_t> samples(depth.size());
  std::transform(depth.begin(), depth.end(), samples.begin(), [&](float z) {
    const double counts = static_cast<double>(z) / scale + 0.5;
    return std::isfinite(z) ? static_cast<std::uint16_t>(std::clamp(counts, 1.0, 65535.0)) : std::uint16_t{0};
  });
  return samples;
}

std::vector<std::uint16_t> counted_snr(const std::vector<float>& snr) {
  std::vector<std::uint16_t> samples(snr.size());
  std::transform(snr.begin(), snr.end(), samples.begin(), [](float ratio) {
    return ratio > 0.0f ? static_cast<std::uint16_t>(std::clamp(10.0f * ratio + 0.5f, 1.0f, 65535.0f))
                        : std::uint16_t{0};
  });
  return samples;
}

std::vector<std::uint8_t> counted_normals(const std::vector<std::array<float, 3>>& normals) {
  std::vector<std::uint8_t> samples;
  samples.reserve(3 * normals.size());
  for (const auto& normal : normals) {
    for (const float n : normal) {
      samples.push_back(std::isnan(n) ? std::uint8_t{0} : static_cast<std::uint8_t>(std::lround(127.5f * (n + 1.0f))));
    }
  }
  return samples;
}

void write_pngs(const std::string& directory, const RangeImage& image) {
  const std::string base = (std::filesystem::path(directory) / image.sensor.name).string();
  struct Made {
    int width;
    Picture counts;
    Bytes png;
  };
  std::vector<Made> made;  // exact sensors measure the truth: it is encoded once
  for (const ImageChannel& channel : image_channels()) {
    Picture counts = channel.counts(image);
    if (counts.channels == 0) continue;
    const int width = channel.width(image), height = channel.height(image);
    auto equal = std::find_if(made.begin(), made.end(), [&](const Made& other) {
      return other.width == width && other.counts.channels == counts.channels && other.counts.bits == counts.bits &&
             other.counts.counts == counts.counts;
    });
    if (equal == made.end()) {
      Bytes png = png_of(width, height, counts);
      equal = made.insert(made.end(), {width, std::move(counts), std::move(png)});
    }
    write_bytes(base + "_" + channel.name + ".png", equal->png);
  }
  write_bytes(base + ".png", png8(image.width, image.height, 3, shaded_picture(image)));
  write_bytes(base + "_depth_picture.png", png_of(depth_picture(image)));
  write_bytes(base + "_validity_picture.png", png_of(validity_picture(image)));
}

}  // namespace bin_scenes
