// Labels of islands: the way up to the lowest body of an island, shortened as it is walked. Needs the binding Work.
#define label_of(i) work[i].lowest[0]
#define moved_lately_of(i) work[i].lowest[1]

// While others may lower it.
uint label_now(uint i) { return atomicOr(label_of(i), 0u); }

uint root_of(uint i) {
  for (;;) {
    uint up = label_now(i);
    if (up == i) return i;
    uint above = label_now(up);
    if (above != up) atomicMin(label_of(i), above);
    i = up;
  }
}
