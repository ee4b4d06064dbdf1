/// The table of the keys of filters of a sensor; see scene/keys.hpp. Reading, checking and the generated page use it.
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/sensor/filter.hpp"

namespace bin_scenes {

template <class Visitor>
void visit(Visitor& v, OutlierFilter& outlier) {
  v.field({"neighbours", "",
           "Number of other pixels in the window that must have nearly the depth of a pixel, so that the pixel is "
           "kept. A larger number causes more holes. With 0, the filter is off.",
           at_least(0.0, 1e5)},
          outlier.neighbours);
  v.field({"window", "pixel", "Edge length of the window around a pixel, an odd number.", at_least(3.0, 301.0)},
          outlier.window);
  v.field({"step", "m",
           "Largest difference of depth at which a pixel of the window has nearly the same depth. With smaller values, "
           "pixels on steep faces are removed as well.",
           above(0.0, 10.0)},
          outlier.step);
}

template <class Visitor>
void visit(Visitor& v, ReflectionFilter& reflection) {
  v.field({"step", "m",
           "Largest allowed difference between the depths that the fringes of two periods give. Suitable values are "
           "several times the noise. With 0, the filter is off.",
           at_least(0.0, 10.0)},
          reflection.step);
  v.field({"period", "pixel",
           "Period of the second fringe, in pixels of the projector. A shorter period detects more reflections, but is "
           "noisier.",
           at_least(4.0, 4096.0)},
          reflection.period);
}

template <class Visitor>
void visit(Visitor& v, EdgeFilter& edge) {
  v.field({"reach", "pixel",
           "Distance from a step of depth within which pixels are removed, on both of its sides. Larger values cause "
           "wider gaps around parts. With 0, the filter is off.",
           at_least(0.0, 100.0)},
          edge.reach);
  v.field({"step", "m",
           "Smallest difference between the depths of neighbouring pixels that counts as a step. With smaller values, "
           "pixels on steep faces are removed as well.",
           above(0.0, 10.0)},
          edge.step);
}

template <class Visitor>
void visit(Visitor& v, ClusterFilter& cluster) {
  v.field({"pixels", "", "Number of pixels that a connected region must have to be kept. With 0, the filter is off.",
           at_least(0.0, 1e8)},
          cluster.pixels);
  v.field({"step", "m", "Largest difference between the depths of neighbouring pixels that are connected.",
           above(0.0, 10.0)},
          cluster.step);
}

template <class Visitor>
void visit(Visitor& v, MedianFilter& median) {
  v.field({"window", "pixel",
           "Edge length of the window around a pixel, an odd number. A larger window gives less noise and rounder "
           "corners. With 0, the filter is off.",
           at_least(0.0, 31.0)},
          median.window);
}

template <class Visitor>
void visit(Visitor& v, SmoothingFilter& smoothing) {
  v.field({"sigma", "pixel",
           "Standard deviation of the weights with which neighbouring pixels count. Larger values give less noise and "
           "rounder creases. With 0, the filter is off.",
           at_least(0.0, 20.0)},
          smoothing.sigma);
  v.field(
      {"step", "m",
       "Distance from the local plane beyond which a pixel does not count. A suitable value is ten times the noise.",
       above(0.0, 10.0)},
      smoothing.step);
}

template <class Visitor>
void visit(Visitor& v, FilterSettings& filter) {
  v.field({"snr", "",
           "Smallest allowed signal-to-noise ratio (SNR). Pixels with a smaller SNR are removed (validity code 4). "
           "With 0, the filter is off.",
           at_least(0.0, 1e6)},
          filter.snr);
  v.section({"outlier", "", "Removes pixels that have too few neighbours of similar depth (validity code 9)."},
            filter.outlier);
  v.section({"reflection", "",
             "Only for the model `structured_light`: removes pixels that received light by reflection from other "
             "surfaces (validity code 10)."},
            filter.reflection);
  v.field({"incidence", "rad",
           "Largest allowed angle between the measured normal of a pixel and the direction to the camera. Pixels with "
           "a larger angle are removed (validity code 9). A smaller angle removes more of the steep faces. With 0, the "
           "filter is off.",
           at_least(0.0, 1.5707963267948966)},
          filter.incidence);
  v.section({"edge", "", "Removes pixels near steps of depth (validity code 9)."}, filter.edge);
  v.section({"cluster", "", "Removes small isolated regions (validity code 9)."}, filter.cluster);
  v.section({"median", "",
             "Replaces the depth of each remaining pixel by the median of the depths around it. Holes are not filled."},
            filter.median);
  v.section({"smoothing", "", "Smooths the depth of the remaining pixels. Edges are preserved."}, filter.smoothing);
}

}  // namespace bin_scenes
