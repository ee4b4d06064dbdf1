/// Depth and validity as pictures to look at, each with what its colours mean beside it.
#include "core/formatted.hpp"
#include "output/png.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace bin_scenes {

namespace {

/// Rows of five pixels from the top, leftmost pixel 16.
using Glyph = std::array<std::uint8_t, 7>;
const std::map<char, Glyph>& glyphs() {
  static const std::map<char, Glyph> table = {
      {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},    {'2', {14, 17, 1, 2, 4, 8, 31}},
      {'3', {31, 2, 4, 2, 1, 17, 14}},     {'4', {2, 6, 10, 18, 31, 2, 2}},   {'5', {31, 16, 30, 1, 1, 17, 14}},
      {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},     {'8', {14, 17, 17, 14, 17, 17, 14}},
      {'9', {14, 17, 17, 15, 1, 2, 12}},   {'.', {0, 0, 0, 0, 0, 12, 12}},    {'m', {0, 0, 26, 21, 21, 21, 21}},
      {'a', {0, 0, 14, 1, 15, 17, 15}},    {'c', {0, 0, 14, 16, 16, 17, 14}}, {'d', {1, 1, 13, 19, 17, 17, 15}},
      {'e', {0, 0, 14, 17, 31, 16, 14}},   {'f', {6, 8, 28, 8, 8, 8, 8}},     {'g', {0, 15, 17, 17, 15, 1, 14}},
      {'h', {16, 16, 22, 25, 17, 17, 17}}, {'i', {4, 0, 12, 4, 4, 4, 14}},    {'k', {16, 16, 18, 20, 24, 20, 18}},
      {'l', {12, 4, 4, 4, 4, 4, 14}},      {'n', {0, 0, 22, 25, 17, 17, 17}}, {'o', {0, 0, 14, 17, 17, 17, 14}},
      {'r', {0, 0, 22, 25, 16, 16, 16}},   {'s', {0, 0, 14, 16, 14, 1, 30}},  {'t', {8, 8, 28, 8, 8, 9, 6}},
      {'u', {0, 0, 17, 17, 17, 19, 13}},   {'v', {0, 0, 17, 17, 17, 10, 4}},  {'w', {0, 0, 17, 17, 21, 21, 10}},
      {'x', {0, 0, 17, 10, 4, 10, 17}},
  };
  return table;
}

constexpr std::uint8_t paper = 0, ink = 1, first_colour = 2;
constexpr int glyph_width = 6, glyph_height = 7;

/// An image with room to its right for what explains it.
class Canvas {
 public:
  Canvas(int width, int height, int letters)
      : size_(std::max(1, height / 240)), right_(width), panel_(size_ * (glyph_width * letters + 24)) {
    picture.width = width + panel_;
    picture.height = height;
    picture.colours = {{250, 250, 252}, {30, 30, 34}};
    picture.pixels.assign(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(height), paper);
  }

  std::uint8_t& at(int x, int y) { return picture.pixels[static_cast<std::size_t>(y) * picture.width + x]; }
  int size() const { return size_; }    ///< pixels a dot of a letter
  int right() const { return right_; }  ///< first column beside the image

  void fill(int x, int y, int width, int height, std::uint8_t colour) {
    for (int row = std::max(y, 0); row < std::min(y + height, picture.height); ++row) {
      for (int column = std::max(x, 0); column < std::min(x + width, picture.width); ++column) at(column, row) = colour;
    }
  }
  void write(int x, int y, const std::string& text) {
    for (const char letter : text) {
      const auto found = glyphs().find(letter);
      for (int row = 0; found != glyphs().end() && row < glyph_height; ++row) {
        for (int dot = 0; dot < 5; ++dot) {
          if (found->second[row] >> (4 - dot) & 1) fill(x + size_ * dot, y + size_ * row, size_, size_, ink);
        }
      }
      x += size_ * glyph_width;
    }
  }

  Palette picture;

 private:
  int size_, right_, panel_;
};

/// From near to far: bright to dark, distinguishable in grey as well.
std::array<std::uint8_t, 3> colour_of_depth(double share) {
  constexpr double anchors[5][3] = {{250, 225, 60}, {105, 200, 95}, {35, 145, 140}, {60, 80, 140}, {65, 10, 85}};
  const double at = 4.0 * std::clamp(share, 0.0, 1.0);
  const int below = std::min(3, static_cast<int>(at));
  std::array<std::uint8_t, 3> colour;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = anchors[below][c] + (at - below) * (anchors[below + 1][c] - anchors[below][c]);
    colour[c] = static_cast<std::uint8_t>(std::lround(value));
  }
  return colour;
}

struct Code {
  const char* name;
  std::array<std::uint8_t, 3> colour;
};
/// By Validity.
constexpr Code codes[] = {{"valid", {205, 210, 205}},   {"nothing", {255, 255, 255}}, {"shadow", {70, 75, 95}},
                          {"outside", {150, 165, 200}}, {"dark", {120, 70, 30}},      {"saturated", {250, 210, 40}},
                          {"mixed", {225, 60, 50}},     {"decoding", {170, 60, 190}}, {"unmatched", {30, 150, 190}},
                          {"outlier", {190, 20, 110}},  {"reflection", {0, 120, 60}}};

}  // namespace

namespace {

/// Depths (m) between which the colours run. The outermost half per cent on each side is left out: a few wrong matches
/// or flying pixels would leave one colour for all the rest.
std::pair<float, float> range_of_colours(std::vector<float> depths) {
  depths.erase(std::remove_if(depths.begin(), depths.end(), [](float z) { return !std::isfinite(z); }), depths.end());
  if (depths.empty()) return {0.0f, 0.0f};
  const std::ptrdiff_t left_out = static_cast<std::ptrdiff_t>(depths.size()) / 200;
  std::nth_element(depths.begin(), depths.begin() + left_out, depths.end());
  const float nearest = depths[static_cast<std::size_t>(left_out)];
  std::nth_element(depths.begin(), depths.end() - 1 - left_out, depths.end());
  return {nearest, *(depths.end() - 1 - left_out)};
}

}  // namespace

Palette depth_picture(const RangeImage& image) {
  const auto [nearest, farthest] = range_of_colours(image.depth);
  Canvas canvas(image.width, image.height, 7);
  if (!(farthest > 0.0f)) return canvas.picture;  // nothing is valid
  constexpr int steps = 250;
  for (int i = 0; i < steps; ++i) canvas.picture.colours.push_back(colour_of_depth((i + 0.5) / steps));
  const double range = std::max(1e-9, static_cast<double>(farthest) - nearest);
  const float* depth = image.depth.data();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++depth) {
      if (!std::isfinite(*depth)) continue;
      const int step = static_cast<int>(std::clamp(steps * (*depth - nearest) / range, 0.0, steps - 1.0));
      canvas.at(x, y) = static_cast<std::uint8_t>(first_colour + step);
    }
  }
  const int size = canvas.size(), top = 8 * size, bar = std::max(1, image.height - 16 * size);
  for (int y = 0; y < bar; ++y) {
    canvas.fill(canvas.right() + 4 * size, top + y, 8 * size, 1,
                static_cast<std::uint8_t>(first_colour + y * steps / bar));
  }
  constexpr int ticks = 4;
  for (int i = 0; i <= ticks; ++i) {
    canvas.fill(canvas.right() + 12 * size, top + (bar - 1) * i / ticks, 3 * size, size, ink);
    canvas.write(canvas.right() + 17 * size, top + (bar - 1) * i / ticks - 3 * size,
                 formatted("%.3fm", nearest + range * i / ticks));
  }
  return canvas.picture;
}

Palette validity_picture(const RangeImage& image) {
  std::array<std::size_t, std::size(codes)> count{};
  Canvas canvas(image.width, image.height, 10);
  for (const Code& code : codes) canvas.picture.colours.push_back(code.colour);
  const std::uint8_t* code = image.validity.data();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x, ++code) {
      ++count[*code];
      canvas.at(x, y) = static_cast<std::uint8_t>(first_colour + *code);
    }
  }
  const int size = canvas.size(), line = 12 * size;
  int y = 6 * size;
  for (std::size_t i = 0; i < std::size(codes); ++i) {
    if (count[i] == 0) continue;
    canvas.fill(canvas.right() + 4 * size, y, 10 * size, 8 * size, ink);
    canvas.fill(canvas.right() + 5 * size, y + size, 8 * size, 6 * size, static_cast<std::uint8_t>(first_colour + i));
    canvas.write(canvas.right() + 17 * size, y + size, codes[i].name);
    y += line;
  }
  return canvas.picture;
}

}  // namespace bin_scenes
