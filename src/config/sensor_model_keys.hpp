/// The keys of the sensor models (scene/sensor_models.hpp), visited by keys.hpp.
#pragma once

#include "bin_scenes/scene/sensor_models.hpp"
#include "config/key.hpp"

namespace bin_scenes::config {

inline Names<MixedPixels> names(MixedPixels) {
  return {{"remove", MixedPixels::remove}, {"keep", MixedPixels::keep}};
}
inline Names<LaserLineSettings::Peak> names(LaserLineSettings::Peak) {
  return {{"strongest", LaserLineSettings::Peak::strongest}, {"nearest", LaserLineSettings::Peak::nearest}};
}

template <class Visitor>
void visit(Visitor& v, ImagerSettings& s) {
  v.field(
      {"exposure", "",
       "signal / full well of a white matte surface that faces the light at reference_distance; more = less noise on "
       "dark parts, and bright or shiny ones saturate"},
      s.exposure);
  v.field(
      {"reference_distance", "m",
       "from the light; 0 = automatic exposure: for a white surface parallel to the image at the median distance of "
       "what is lit"},
      s.reference_distance);
  v.field({"ambient", "", "signal / full well of a white surface without the sensor's light; adds shot noise"},
          s.ambient);
  v.field({"full_well", "electrons", "at saturation; shot noise of a signal s is sqrt(s / full_well)"}, s.full_well);
  v.field({"read_noise", "electrons", "standard deviation; 0 = none"}, s.read_noise);
  v.field({"blur", "pixel",
           "structured_light: standard deviation of the camera's blur; depth errs where bright meets dark; 0 = sharp"},
          s.blur);
  v.field({"bits", "", "of the analogue-digital converter, 1 to 16; fewer = coarser steps"}, s.bits);
}

template <class Visitor>
void visit(Visitor& v, StructuredLightSettings& s) {
  v.field({"steps", "", "images of the phase shift, at least 3; noise falls with the square root"}, s.steps);
  v.field({"period", "pixel", "projector pixels a fringe; shorter = less noise, more Gray images, sooner blurred"},
          s.period);
  v.field({"gray_bits", "", "Gray-code images; 0 = as many as the projector's width needs"}, s.gray_bits);
  v.field({"contrast", "", "(white - black) / (white + black) of the projector"}, s.contrast);
  v.field({"defocus", "pixel", "standard deviation of the projector's blur, its pixels; 0 = sharp"}, s.defocus);
  v.field({"gamma", "", "decoded: exponent of the projector that nobody calibrated away; 1 = linear"}, s.gamma);
  v.field({"min_modulation", "", "amplitude / full well below which a pixel has too little signal (code 4)"},
          s.min_modulation);
  v.field({"mixed", "", "pixels that see foreground and background: remove = invalid (code 6), keep = flying points"},
          s.mixed);
  v.field({"edge_step", "m", "depth step inside a pixel's footprint from which on it is a mixed pixel"}, s.edge_step);
}

template <class Visitor>
void visit(Visitor& v, LaserLineSettings& s) {
  v.field({"fan", "rad", "opening of the sheet about its z axis"}, s.fan);
  v.field({"power", "", "signal / full well at the line's peak on a white matte surface that faces the laser"},
          s.power);
  v.field({"blur", "pixel", "standard deviation of the camera's blur; adds to the line's width"}, s.blur);
  v.field({"speckle", "", "contrast of speckle in one pixel, 0 to 1; moves the peak; 0 = none"}, s.speckle);
  v.field({"min_signal", "", "peak signal / full well below which a line is missing (code 4)"}, s.min_signal);
  v.field({"peak", "", "which of two lines in a column is reported"}, s.peak);
}

template <class Visitor>
void visit(Visitor& v, StereoSettings& s) {
  v.field({"baseline", "m", "to the second camera along the first one's x; longer = less noise, more occlusion"},
          s.baseline);
  v.field(
      {"disparities", "pixel",
       "multiple of 16; what lies nearer than focal length * baseline / disparities is unmatched; time grows with it"},
      s.disparities);
  v.field({"window", "pixel", "odd: the matcher's block; larger = less noise, rounder edges"}, s.window);
  v.field({"dots", "", "share of the projector's pixels that are dots; 0 = no pattern, passive stereo"}, s.dots);
  v.field({"uniqueness", "%", "by which the best match must beat the second; more = more holes, fewer outliers"},
          s.uniqueness);
  v.field({"max_difference", "pixel", "left-right check; smaller = more holes, fewer outliers"}, s.max_difference);
  v.field({"min_texture", "grey levels",
           "of 255: standard deviation in a window, beyond noise, below which nothing is matched; 0 = noise is matched "
           "as well"},
          s.min_texture);
  v.field({"speckle_size", "pixel", "smaller islands of disparity are removed; 0 = none are"}, s.speckle_size);
  v.field({"disparity_noise", "pixel", "analytic: standard deviation at full signal"}, s.disparity_noise);
  v.field({"min_signal", "", "analytic: signal / full well below which nothing is matched (code 8)"}, s.min_signal);
}

template <class Visitor>
void visit(Visitor& v, TimeOfFlightSettings& s) {
  v.field({"axial", "m", "standard deviation at axial_distance, facing"}, s.axial);
  v.field({"axial_growth", "1/m", "times (z - axial_distance) squared"}, s.axial_growth);
  v.field({"axial_distance", "m", "distance at which noise begins to grow"}, s.axial_distance);
  v.field({"axial_angle", "m^1.5", "times t^2 / (pi/2 - t)^2 / sqrt(z), t the angle of incidence"}, s.axial_angle);
  v.field({"lateral", "pixel", "jitter of the ray; moves edges, never a plane"}, s.lateral);
  v.field({"lateral_angle", "pixel", "times t / (pi/2 - t)"}, s.lateral_angle);
  v.field(
      {"albedo", "", "for which the figures hold: noise goes with sqrt(albedo / signal); 0 = the same noise for all"},
      s.albedo);
  v.field(
      {"min_signal", "", "share of a white facing surface's signal at 1 m below which nothing is measured (code 4)"},
      s.min_signal);
  v.field({"mixed", "", "pixels that see foreground and background: keep = flying points, remove = invalid (code 6)"},
          s.mixed);
  v.field({"edge_step", "m", "depth step inside a pixel's footprint from which on it is a mixed pixel"}, s.edge_step);
}

}  // namespace bin_scenes::config
