/// The light that is reflected by the microscopic facets of a rough mirror: by one facet, and by further facets after
/// it. Formulas for a single reflection neglect light that leaves one facet towards another one, which is up to 70 % of
/// all light (Kulla, Conty 2017, "Revisiting physically based shading at Imageworks").
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <optional>

namespace bin_scenes {

/// Returns the reflectance of a rough mirror whose facets are distributed by GGX (Walter et al. 2007, "Microfacet
/// models for refraction"; shadowing correlated by height), relative to a white matte surface that faces the light. A
/// perfect mirror reflects all light that arrives from all directions.
/// @param alpha  width of the GGX distribution (roughness squared), 0.001 to 1
/// @param in, out, half  cosines between the normal and the light, the eye, and the direction halfway between them;
/// above 0
/// @param once   share of the light that a facet reflects at this angle; 1 for a perfect mirror
/// @param often  mean of this share over all angles, for light that several facets reflect
double facet_lobe(double alpha, double in, double out, double half, double once = 1.0, double often = 1.0);

/// Widths of the lobe of a surface with lines of brushing or milling: narrower along them than across (Burley 2012,
/// "Physically based shading at Disney").
struct Widths {
  double along, across;
};
Widths widths_of(const Surface& surface);
/// Returns the axes of a surface at a point: x is the direction of its lines projected to the tangent plane, z the
/// normal. Returns none if the surface has no lines.
std::optional<Mat3> frame_along(const Surface& surface, const Vec3& normal);
/// Returns facet_lobe() for a surface with lines (Heitz 2014, "Understanding the masking-shadowing function in
/// microfacet-based BRDFs").
/// @param in, out  unit directions to the light and to the eye, in the axes of frame_along()
double brushed_lobe(const Surface& surface, const Vec3& in, const Vec3& out, double once = 1.0, double often = 1.0);

/// Returns the share of unpolarised light that a smooth metal reflects (Born, Wolf, "Principles of Optics", 14.2).
/// @param cosine  cosine of the angle between the light and the normal
double fresnel(double cosine, double refraction, double extinction);
/// Returns the mean of fresnel() over a hemisphere with constant radiance.
double mean_fresnel(double refraction, double extinction);

}  // namespace bin_scenes
