/// The table of the keys of optical surfaces; see scene/keys.hpp. Reading, checking, messages and the generated page
/// use it.
#pragma once

#include "bin_scenes/scene/key.hpp"
#include "bin_scenes/scene/request.hpp"

#include <string>

namespace bin_scenes {

template <class Visitor>
void visit(Visitor& v, Texture& texture) {
  v.field({"scratches", "",
           "Mean share of the surface that is scratched; the share differs from part to part. Scratches are rough and "
           "not brushed, and their albedo is 0.8 times that of the surface.",
           at_least(0.0, 1.0)},
          texture.scratches);
  v.field({"oil", "",
           "Mean share of the surface that is covered by oil; the share differs from part to part. Oily places are "
           "smoother, and their albedo is 0.85 times that of the surface.",
           at_least(0.0, 1.0)},
          texture.oil);
  v.field({"rust", "",
           "Mean share of the surface that is covered by rust; the share differs from part to part. Rust is matte and "
           "reddish brown, and its albedo is 0.4 times that of the surface.",
           at_least(0.0, 1.0)},
          texture.rust);
}

template <class Visitor>
void visit(Visitor& v, Surface& surface) {
  std::string material;  // name of a material whose values have been read; the values are written instead of the name
  v.field({"material", "",
           "Name of a file in `config/materials`, for example `steel_brushed` or `plastic_black`. The values in this "
           "file are the defaults of the other keys of this section.",
           anything, false},
          material);
  v.field({"albedo", "",
           "Share of the incident light that the surface reflects. Sensors measure dark surfaces with more noise and "
           "more missing pixels.",
           at_least(0.0, 1.0)},
          surface.albedo);
  v.field({"gloss", "",
           "Share of the reflected light that forms highlights; the rest is scattered in all directions. Shiny "
           "surfaces cause saturated and missing pixels.",
           at_least(0.0, 1.0)},
          surface.gloss);
  v.field({"roughness", "", "Width of the highlights. Smaller values give narrower and brighter highlights.",
           at_least(0.0, 1.0)},
          surface.roughness);
  v.field({"refraction", "",
           "Only for metals: real part n of the complex index of refraction n + i k. The light in highlights is then "
           "multiplied by the reflectance that Fresnel's equations give for its angle. If this value and `extinction` "
           "are both 0, the factor is 1 for all angles.",
           at_least(0.0, 100.0)},
          surface.refraction);
  v.field({"extinction", "",
           "Only for metals: imaginary part k of the complex index of refraction n + i k; its real part n is the key "
           "`refraction`.",
           at_least(0.0, 100.0)},
          surface.extinction);
  v.field({"colour", "",
           "Factors for red, green and blue by which the albedo is multiplied. Only colour images show the colour.",
           at_least(0.0, 1.0)},
          surface.colour);
  v.field({"anisotropy", "",
           "Strength of brushing, from 0 (not brushed) to 1. Highlights of a brushed surface are narrower along the "
           "lines of brushing than across them.",
           at_least(0.0, 1.0)},
          surface.anisotropy);
  v.field({"along", "",
           "Direction of the lines of brushing, in the frame of the model. With [0, 0, 0], the lines follow the "
           "longest axis of the part."},
          surface.along);
  v.section({"texture", "", "Wear of the surface: the shares of its area that are scratched, oily and rusty.", anything,
             surface.texture.any()},
            surface.texture);
}

}  // namespace bin_scenes
