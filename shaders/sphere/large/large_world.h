// The world that is spread over groups. Needs the bindings Progress and Large, and shared/dispatch.h.
uniform uint large_world;

// Nothing to do in this step, or no room for what there is to do.
bool idle() { return large.awake == 0u || progress[large_world].overflow != 0u; }
