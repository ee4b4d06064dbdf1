SphereStatus no_jobs() {
  uint none[SPHERE_SAMPLE_KINDS] = uint[](0u, 0u, 0u, 0u);
  return SphereStatus(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, none, uvec4(0u, 1u, 1u, 0u), uvec4(0u, 1u, 1u, 0u),
                      uvec4(0u, 1u, 1u, 0u));
}
