// The index of an invocation or group in a dispatch whose groups may be folded over two axes (gl/program.hpp,
// folded_groups). They are macros, because gl_WorkGroupSize is known only after the layout line of the file that
// includes this header.
#ifndef __cplusplus
#define group_index() (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)
#define thread_index() (group_index() * gl_WorkGroupSize.x + gl_LocalInvocationIndex)
// Returns the arguments of an indirect dispatch of that many groups, folded over x and y.
uvec3 folded_groups(uint groups) {
  uint x = min(groups, 65535u);
  return uvec3(x, x == 0u ? 0u : (groups + x - 1u) / x, 1u);
}
#endif
