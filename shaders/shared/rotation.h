// Functions for quaternions (x, y, z, w) and for the inertia of rigid bodies in GLSL. A rotation vector has the
// direction of the axis and the length of the angle (rad). The C++ side uses Eigen and solver/sphere/math.hpp instead.
#ifndef SHARED_ROTATION_H
#define SHARED_ROTATION_H
vec4 quat_multiply(vec4 a, vec4 b) {
  return vec4(a.w * b.xyz + b.w * a.xyz + cross(a.xyz, b.xyz), a.w * b.w - dot(a.xyz, b.xyz));
}
vec4 quat_conjugate(vec4 q) { return vec4(-q.xyz, q.w); }
vec3 rotate(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.xyz, v);
  return v + q.w * t + cross(q.xyz, t);
}
// Returns the product of a symmetric matrix with v. diagonal: elements xx, yy, zz; mixed: elements xy, xz, yz.
vec3 symmetric_times(vec3 diagonal, vec3 mixed, vec3 v) {
  return diagonal * v + vec3(mixed.x, mixed.x, mixed.y) * v.yxx + vec3(mixed.y, mixed.z, mixed.z) * v.zzy;
}
// Returns the quaternion of a rotation vector (rad). Half angles of up to 0.5 rad use the power series: on some
// hardware, sin and cos have an absolute error of 5e-7, which is 1e-4 of the rotation of a slow part in a step.
vec4 quat_of_turn(vec3 turn) {
  vec3 h = 0.5 * turn;
  float x2 = dot(h, h);
  if (x2 < 0.25) {
    float s = 1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0));
    float c = 1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0)));
    return vec4(s * h, c);
  }
  float x = sqrt(x2);
  return vec4(sin(x) / x * h, cos(x));
}
#endif
