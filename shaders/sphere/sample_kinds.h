// Positions in the list of samples for the pass test_samples. Samples of a kind (as SPHERE_SAMPLE_RESTS) are stored
// together, so that neighbouring invocations do the same work. Two kinds share a region with room for all samples: one
// fills it from its start, the other from its end. Needs the bindings Settings and Jobs.

uint place_of_sample(uint kind, uint of_kind) {
  uint place = kind % 2u == 0u ? of_kind : settings.samples - 1u - of_kind;
  return kind / 2u * settings.samples + place;
}

// Returns the number of work groups that test the samples of a kind.
uint blocks_of_kind(uint kind) { return (status.sample_kinds[kind] + SPHERE_PAIR_GROUP - 1u) / SPHERE_PAIR_GROUP; }
