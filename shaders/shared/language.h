// What GLSL and C++ call differently. Code in shaders/shared is compiled as both: with f behind its numbers, without
// components of vectors, and with what it reads of a part through functions of either side. In C++ it is included
// within a namespace that has what stands below; vectors are Eigen's.
#ifndef SHARED_LANGUAGE_H
#define SHARED_LANGUAGE_H
#ifdef __cplusplus
#define IN(T) const T&
#define OUT(T) T&
#define INOUT(T) T&
#define INLINE inline
#else
#define IN(T) T
#define OUT(T) out T
#define INOUT(T) inout T
#define INLINE
// By the transpose: back out of the frame that m carries into.
vec3 turned_back(mat3 m, vec3 v) { return v * m; }
// Of 0: 0.
vec3 unit(vec3 v) {
  float size = length(v);
  return size > 0.0 ? v / size : v;
}
#endif
#endif
