#include "page/svg.hpp"

#include "page/html.hpp"

namespace bin_scenes {

namespace {

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string attribute(const char* name, double value) {
  return attribute(name, short_number(value, 6));
}

}  // namespace

void Svg::bar(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, const std::string& colour) {
  text_ += "<rect" + attribute("x", corner.x()) + attribute("y", corner.y()) + attribute("width", size.x()) +
           attribute("height", size.y()) + attribute("fill", colour) + "/>\n";
}

void Svg::curve(const std::vector<Eigen::Vector2d>& points, const std::string& colour, double width) {
  std::string path;
  for (const Eigen::Vector2d& p : points)
    path += (path.empty() ? "M" : "L") + short_number(p.x(), 6) + " " + short_number(p.y(), 6);
  text_ += "<path" + attribute("d", path) + attribute("fill", "none") + attribute("stroke", colour) +
           attribute("stroke-width", width) + "/>\n";
}

void Svg::text(const Eigen::Vector2d& at, const std::string& text, const std::string& anchor,
               const std::string& colour) {
  text_ += "<text" + attribute("x", at.x()) + attribute("y", at.y()) + attribute("text-anchor", anchor) +
           (colour.empty() ? "" : attribute("fill", colour)) + ">" + escaped(text) + "</text>\n";
}

}  // namespace bin_scenes
