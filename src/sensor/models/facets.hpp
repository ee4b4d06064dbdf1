/// The light that is reflected by the microscopic facets of a rough mirror: by one facet, and by further facets after
/// it. Formulas for a single reflection neglect light that leaves one facet towards another one, which is up to 70 % of
/// all light (Kulla, Conty 2017, "Revisiting physically based shading at Imageworks").
#pragma once

#include "bin_scenes/scene/request.hpp"

#include <optional>

namespace bin_scenes {

/// Lobe of a mirror with facets distributed by GGX (Walter et al. 2007, "Microfacet models for refraction"; shadowing
/// correlated by height), over a white matte surface that faces the light. It sends back all light from everywhere.
/// @param alpha  width, 0.001 to 1
/// @param in, out, half  cosines of the normal to light, to eye and to what is halfway between them; above 0
/// @param once   share that a facet sends on at this angle, 1 of a perfect mirror
/// @param often  mean of that share over all angles
double facet_lobe(double alpha, double in, double out, double half, double once = 1.0, double often = 1.0);

/// Widths of the lobe of a surface with lines of brushing or milling: narrower along them than across (Burley 2012,
/// "Physically based shading at Disney").
struct Widths {
  double along, across;
};
Widths widths_of(const Surface& surface);
/// Axes of a surface at a point: x as far along its lines as the surface goes, z the normal. None where it has no
/// lines.
std::optional<Mat3> frame_along(const Surface& surface, const Vec3& normal);
/// facet_lobe() of such a surface (Heitz 2014, "Understanding the masking-shadowing function in microfacet-based
/// BRDFs").
/// @param in, out  unit, in the surface's axes
double brushed_lobe(const Surface& surface, const Vec3& in, const Vec3& out, double once = 1.0, double often = 1.0);

/// Share of unpolarised light that a smooth metal mirrors (Born, Wolf, "Principles of Optics", 14.2).
/// @param cosine  of the angle to the normal
double fresnel(double cosine, double refraction, double extinction);
/// Its mean over a hemisphere of even light.
double mean_fresnel(double refraction, double extinction);

}  // namespace bin_scenes
