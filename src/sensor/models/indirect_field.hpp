/// Indirect light of all pixels of an image. It varies slowly along a face: it is gathered at nodes, and pixels take it
/// from the nodes of their own face (Ward, Rubinstein, Clear 1988, "A ray tracing solution for diffuse
/// interreflection"). Nodes lie a few pixels apart, closer together where other surfaces are near.
#pragma once

#include "bin_scenes/core/random.hpp"
#include "bin_scenes/sensor/view.hpp"
#include "sensor/models/interreflection.hpp"

#include <array>
#include <functional>
#include <vector>

namespace bin_scenes {

class IndirectField {
 public:
  struct Setup {
    int bounces = 0;   ///< 0: no indirect light
    int samples = 24;  ///< rays a node
  };
  /// What a pattern makes of light by some paths: adds to the first `count` channels, which interpolation mixes.
  using Respond = std::function<void(const std::vector<Path>& paths, int count, float* channels)>;

  /// Asks `lamp` and `respond` while it is made only.
  /// @param channels  of `respond`
  /// @param growing   how many of them, the first ones, are followed between nodes as paths move with the pixel;
  ///                  others are interpolated only
  IndirectField(const Scenery& scenery, const View& view, const Surfaces& surfaces, const Lamp& lamp,
                const Setup& setup, int channels, int growing, const Respond& respond, const Random& random);

  /// The first `count` channels of a pixel; false and zeros if there is no light.
  bool at(std::size_t pixel, int count, float* channels) const;

 private:
  struct Node {
    std::size_t pixel;
    float x, y;   ///< its place (pixel)
    float reach;  ///< pixel, over which it is averaged with others
    bool lit;
  };
  struct Tile {
    std::vector<Node> nodes;
    std::vector<float> values;        ///< of its nodes: channels, and their growth to the right and down
    std::vector<std::uint32_t> near;  ///< nodes of this tile and those around it; none if no one is lit
  };
  bool reaches(const Node& node, int column, int row) const;
  bool nearest(std::size_t pixel, int count, float* channels) const;
  std::size_t tile_of(std::size_t pixel) const;
  Vec3 position(std::size_t pixel) const { return points_[pixel].cast<double>(); }
  bool one_face(std::size_t a, std::size_t b) const;
  void fill(Tile& tile, int left, int top) const;
  void divide(Tile& tile, int left, int top, int spacing, std::vector<std::size_t> pixels) const;
  Vec3 step_on_face(std::size_t pixel, const Vec3& step) const;
  SeenPoint point_of(std::size_t pixel) const;
  double nearness(std::size_t pixel, int spacing) const;
  void add_node(Tile& tile, std::size_t pixel, int spacing) const;

  const Scenery& scenery_;
  const View& view_;
  const Surfaces& surfaces_;
  const Lamp& lamp_;
  Setup setup_;
  int channels_, growing_;
  const Respond& respond_;
  Random random_;
  int width_, height_, columns_;
  std::vector<Eigen::Vector3f> points_;  ///< m, camera frame, by pixel
  std::vector<Tile> tiles_;
  std::vector<Node> nodes_;
  std::vector<float> values_;  ///< of nodes_, as of a tile's
};

}  // namespace bin_scenes
