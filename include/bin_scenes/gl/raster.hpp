/// Rasterisation into images that are read back: triangles, render targets, and counts of covered pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bin_scenes::gl {

/// Triangles on the device. Six floats a corner, three corners a triangle: position (attribute 0), normal (1).
class Triangles {
 public:
  explicit Triangles(const std::vector<float>& corners);
  ~Triangles();
  Triangles(const Triangles&) = delete;
  Triangles& operator=(const Triangles&) = delete;

  void draw() const;

 private:
  unsigned buffer_ = 0, array_ = 0;
  int count_;
};

/// Channels of an image, by the number of the fragment shader's output, with a z-buffer and a stencil.
/// Row 0 of a channel is row 0 of the framebuffer; the centre of pixel (0, 0) has window coordinates (0.5, 0.5).
class Target {
 public:
  enum class Channel { float1, float4, uint16 };
  /// Throws an environment Error if the driver cannot render into such an image.
  Target(int width, int height, const std::vector<Channel>& channels);
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  /// Clears float channels to NaN, integer ones to 0, and makes the following draws go here: both sides of every
  /// triangle, the largest clip z / w in 0 .. 1 in front.
  void begin() const;
  void read(int channel, float* to) const;          ///< width * height * components
  void read(int channel, std::uint16_t* to) const;  ///< width * height

  /// From now on nothing is written; the following draws are what count() asks about.
  void begin_counting();
  /// Pixels that `draw` covers, each once however many triangles lie in it, in whatever depth. Only asks: results of
  /// all calls so far, in order, come from counts().
  template <class Draw>
  void count(Draw&& draw) {
    begin_count();
    draw();
    end_count();
  }
  std::vector<std::size_t> counts();

 private:
  void begin_count();
  void end_count();
  void release();

  int width_, height_, mark_ = 0;
  std::vector<Channel> channels_;
  unsigned frame_ = 0;
  std::vector<unsigned> buffers_, queries_;
};

}  // namespace bin_scenes::gl
