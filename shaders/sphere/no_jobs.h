// Returns the status of a step without jobs: its indirect dispatches have no groups. update_sleep.comp stores it at the
// end of a step, and the passes of the next step count their jobs from 0.
SphereStatus no_jobs() {
  uint none[SPHERE_SAMPLE_KINDS] = uint[](0u, 0u, 0u, 0u);
  return SphereStatus(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, none, uvec4(0u, 1u, 1u, 0u), uvec4(0u, 1u, 1u, 0u),
                      uvec4(0u, 1u, 1u, 0u));
}
