// Names for what GLSL and C++ write differently. The code in shaders/shared is compiled as both languages. It therefore
// writes the suffix f behind floating-point numbers, does not use the components of vectors, and reads the data of a
// part through functions that each side provides. C++ code includes this header within a namespace that contains the
// names listed below; its vectors are Eigen's.
#ifndef SHARED_LANGUAGE_H
#define SHARED_LANGUAGE_H
#ifdef __cplusplus
#define IN(T) const T&
#define OUT(T) T&
#define INOUT(T) T&
#define INLINE inline
#define MEMBER_LIST(T, list, most) T list[most];
#define LANE_LIST(T, list, most)
#define LISTED(member, list, i) member[i]
#define AND &
#define OR |
#else
#define IN(T) T
#define OUT(T) out T
#define INOUT(T) inout T
#define INLINE
// Lists that are indexed at run time: each invocation has its part of shared memory. Arrays of its own would lie in
// local memory, or become ladders of conditions, and spill registers.
#define MEMBER_LIST(T, list, most)
#define LANE_LIST(T, list, most) shared T list[most * SPHERE_PAIR_GROUP];
#define LISTED(member, list, i) list[(i) * SPHERE_PAIR_GROUP + gl_LocalInvocationIndex]
// What is computed of a contact: in C++ of eight at once.
#define Real float
#define Real3 vec3
#define Mask bool
#define AND &&
#define OR ||
#define all_lanes(x) (x)
float select(bool condition, float yes, float no) { return condition ? yes : no; }
// Rotates a vector by the transpose of m: from the frame into which m rotates back to the original one.
vec3 turned_back(mat3 m, vec3 v) { return v * m; }
// The unit vector along v; 0 if v is 0.
vec3 unit(vec3 v) {
  float size = length(v);
  return size > 0.0 ? v / size : v;
}
#endif
#endif
