// What is to be done about a listed pair. Needs the bindings Settings, Progress, Manifolds, Jobs, and sphere/pair.h.

uint recycled = 0u, tested = 0u, asleep = 0u, sleepers = 0u;

// Puts the pair at `place` of the list on the list of jobs, unless it sleeps or has hardly moved.
void enlist(SphereWorld world, uint w, SpherePair pair, uint place) {
  if (!moves(pair.a) && (pair.b == SPHERE_GROUND || !moves(pair.b))) {
    ++asleep;
    return;
  }
  ++tested;
  if (recyclable(manifolds[world.pairs.x + pair.slot], pair, progress[w].fine != 0u)) {
    ++recycled;
    return;
  }
  uint job = atomicAdd(status.jobs, 1u);
  jobs[job] = place;
  uint groups = job < settings.contact_groups ? job + 1u : job / SPHERE_GROUP_JOBS + 1u;
  // A dispatch takes 65,535 groups an axis; groups that find no job end at once.
  atomicMax(status.groups.x, min(groups, 65535u));
  atomicMax(status.groups.y, (groups + 65534u) / 65535u);
}

// What this invocation saw: pairs, and bodies that sleep.
void count_pairs(uint w) {
  atomicAdd(progress[w].pairs_tested, tested);
  atomicAdd(progress[w].pairs_recycled, recycled);
  atomicAdd(progress[w].pairs_asleep, asleep);
  atomicAdd(progress[w].asleep_steps, sleepers);
}
