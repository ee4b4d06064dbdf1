// Adds a candidate for a contact to the list of all candidates, and to a chain of its job. Needs the bindings Settings,
// Progress, Jobs, Candidates, and world_index.
uint job;  // job to which the candidates of this invocation belong

void emit(vec3 on_a, vec3 normal, float separation, uint feature) {
  uint at = 1u + atomicAdd(status.candidates, 1u);
  if (at >= settings.candidates) {
    atomicOr(progress[world_index].overflow, SPHERE_CANDIDATE_OVERFLOW);
    atomicMax(progress[world_index].need_candidates, at + 1u);
    jobs[job].incomplete = 1u;
    return;
  }
  uint next = atomicExchange(jobs[job].chains[at % SPHERE_CHAINS], at);
  candidates[at] = SphereCandidate(on_a, separation, normal, 0.0, feature, 0u, next, 0u);
}
