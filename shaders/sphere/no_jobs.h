SphereStatus no_jobs() {
  return SphereStatus(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, uvec4(0u, 1u, 1u, 0u), uvec4(0u, 1u, 1u, 0u),
                      uvec4(0u, 1u, 1u, 0u));
}
