/// The indirect light of all pixels of an image. Indirect light varies slowly along a face. It is therefore computed at
/// nodes, and pixels interpolate it from nodes on their own face (Ward, Rubinstein, Clear 1988, "A ray tracing solution
/// for diffuse interreflection"). Nodes are a few pixels apart, and closer together near other surfaces.
/// docs/develop/indirect_light.md derives the interpolation.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/raster/view.hpp"
#include "light/interreflection.hpp"

#include <array>
#include <functional>
#include <vector>

namespace bin_scenes {

class IndirectField {
 public:
  struct Setup {
    int bounces = 0;   ///< largest number of reflections at other surfaces; 0: no indirect light
    int samples = 16;  ///< smallest number of rays that are cast at a node
    /// Standard error of a node's light / Pattern::unit above which it gets more rays; 0: no node does.
    double error = 0.02;
  };
  /// A pattern converts light paths to channels. It adds three values for each channel: the channel itself, which is
  /// interpolated; its change when the ends of the paths move by steps[0] (m); and its change for steps[1].
  using Respond = std::function<void(const std::vector<Path>& paths, const Vec3* steps, float* channels)>;
  struct Pattern {
    int channels;  ///< number of channels that `respond` adds to
    int growing;   ///< number of channels, from the first on, whose change with the pixel's position is interpolated as
                   ///< well; the others are interpolated by value only
    Respond respond;
    double unit = 0.0;  ///< light to which Setup::error is relative: that of typical direct light, in the unit of
                        ///< Path::weight; 0: none
  };

  /// Uses the lamp and the pattern's `respond` only during construction.
  IndirectField(const LitScene& scene, const View& view, const Setup& setup, const Pattern& pattern,
                const Random& random);

  /// Returns the first `count` channels of a pixel; returns false, and zeros, if there is no light.
  bool at(std::size_t pixel, int count, float* channels) const;

 private:
  /// Face that a pixel sees. Two pixels count as seeing the same face if these data agree.
  struct Face {
    Eigen::Vector3f point, normal;  ///< point (m) and unit normal, camera frame
    std::int32_t line;
    std::uint16_t label;
  };
  struct Node {
    Face face;
    float x, y;   ///< position in the image (pixels)
    float reach;  ///< pixels, distance up to which it is averaged with other nodes
    bool lit;
  };
  /// Nodes with channels. `followed`: the first Pattern::growing ones, with their changes to the right and down.
  struct Nodes {
    std::vector<Node> all;
    std::vector<float> followed, others;
  };
  static bool one_face(const Face& a, const Face& b);
  Face face(std::size_t pixel) const;
  bool nearest(std::size_t pixel, int count, float* channels) const;
  std::size_t tile_of(std::size_t pixel) const;
  void fill(Nodes& out, int left, int top) const;
  void divide(Nodes& out, int left, int top, int spacing, std::vector<std::size_t> pixels) const;
  int samples_for(const Gathered& light) const;
  bool look(std::size_t pixel, double too_near, Gathered& light) const;
  std::size_t central_pixel(const std::vector<std::size_t>& pixels) const;
  Vec3 step_on_face(std::size_t pixel, const Vec3& step) const;
  void add_node(Nodes& out, std::size_t pixel, int spacing, const Gathered& light) const;
  void sort_into_tiles();
  template <class Work>
  void for_tiles(const Node& node, const Work& work) const;

  LitScene scene_;
  const View& view_;
  Setup setup_;
  int channels_, growing_;
  double unit_;
  const Respond& respond_;
  Random random_;
  int width_, height_;
  int columns_, rows_;                   ///< numbers of tiles
  std::vector<Eigen::Vector3f> points_;  ///< point that each pixel sees (m), camera frame
  Nodes nodes_;
  std::vector<std::uint32_t> near_;   ///< indices of the nodes whose reach includes a tile, tile by tile
  std::vector<std::uint32_t> first_;  ///< for each tile, and one more at the end: index of its first entry in near_
  std::vector<char> lit_;             ///< for each tile: whether any of its nodes is lit
};

}  // namespace bin_scenes
