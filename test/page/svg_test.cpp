#include "page/svg.hpp"
#include "page/html.hpp"

#include <gtest/gtest.h>

namespace bin_scenes {
namespace {

TEST(Svg, HoldsBarsCurvesAndTexts) {
  Svg svg("width=\"20\" height=\"10\"");
  svg.bar({1.0, 2.0}, {3.0, 0.125}, "red");
  svg.curve({{0.0, 1e-9}, {2.5, 3.0}}, "#000", 2.0);
  svg.text({4.0, 5.0}, "a < b & c", "end");
  EXPECT_EQ(svg.str(),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"20\" height=\"10\">\n"
            "<rect x=\"1\" y=\"2\" width=\"3\" height=\"0.125\" fill=\"red\"/>\n"
            "<path d=\"M0 1e-09L2.5 3\" fill=\"none\" stroke=\"#000\" stroke-width=\"2\"/>\n"
            "<text x=\"4\" y=\"5\" text-anchor=\"end\">a &lt; b &amp; c</text>\n"
            "</svg>\n");
}

TEST(Html, DataCannotEndItsScript) {
  EXPECT_EQ(
      filled_page("<script>/*THREE*/</script><script>/*DATA*/null</script>", "three()", "{\"name\": \"</script>\"}"),
      "<script>three()</script><script>{\"name\": \"<\\/script>\"}</script>");
}

TEST(Html, NumbersArePackedLittleEndian) {
  EXPECT_EQ(packed(std::vector<std::uint16_t>{1, 0x0203}), "AQADAg==");
  EXPECT_EQ(packed(std::vector<float>{}), "");
}

}  // namespace
}  // namespace bin_scenes
