/// How much light a rough mirror sends back that met one of its facets, and what the others add: of light that leaves a
/// facet towards another one a single reflection knows nothing, up to 70 % of all (Kulla, Conty 2017, "Revisiting
/// physically based shading at Imageworks").
#pragma once

namespace bin_scenes {

/// Lobe of a mirror with facets distributed by GGX (Walter et al. 2007, "Microfacet models for refraction"; shadowing
/// correlated by height), over a white matte surface that faces the light. It sends back all light from everywhere.
/// @param alpha  width, 0.001 to 1
/// @param in, out, half  cosines of the normal to light, to eye and to what is half way between them; above 0
double facet_lobe(double alpha, double in, double out, double half);

}  // namespace bin_scenes
