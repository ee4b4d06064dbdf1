// Names for constructs that GLSL and C++ write differently. The code in shaders/shared is compiled as both languages.
// It therefore writes the suffix f behind floating-point numbers, does not use components of vectors, and reads parts
// through functions that each side provides. C++ code includes this header within a namespace that contains the
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
// Lists that are indexed at run time: each invocation uses its own part of shared memory. Compilers would place local
// arrays in local memory or replace them by chains of conditions, and spill registers.
#define MEMBER_LIST(T, list, most)
#define LANE_LIST(T, list, most) shared T list[most * SPHERE_PAIR_GROUP];
#define LISTED(member, list, i) list[(i) * SPHERE_PAIR_GROUP + gl_LocalInvocationIndex]
// Types of the quantities of one contact; in C++, they contain the quantities of eight contacts.
#define Real float
#define Real3 vec3
#define Mask bool
#define AND &&
#define OR ||
#define all_lanes(x) (x)
float select(bool condition, float yes, float no) { return condition ? yes : no; }
// Returns the transpose of m times v: the inverse rotation of a rotation matrix m.
vec3 turned_back(mat3 m, vec3 v) { return v * m; }
// Returns the unit vector along v, or 0 if v is 0.
vec3 unit(vec3 v) {
  float size = length(v);
  return size > 0.0 ? v / size : v;
}
#endif
#endif
