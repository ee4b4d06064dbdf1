/// Builds an SVG picture from bars, curves and texts, in the order in which they are added. The plots of the pages use
/// it. There are no axes or scales: the caller converts values to lengths of the picture.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace bin_scenes {

/// All lengths are in the units of the picture; y points down.
class Svg {
 public:
  /// @param attributes  attributes of the element <svg>, such as its size
  explicit Svg(const std::string& attributes)
      : text_("<svg xmlns=\"http://www.w3.org/2000/svg\" " + attributes + ">\n") {}

  void bar(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const std::string& colour);
  void curve(const std::vector<Eigen::Vector2d>& points, const std::string& colour, double width = 1.0);
  /// @param anchor  which point of the text is at `at`: start, middle or end
  void text(const Eigen::Vector2d& at, const std::string& text, const std::string& anchor = "start",
            const std::string& colour = "");
  std::string str() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

}  // namespace bin_scenes
