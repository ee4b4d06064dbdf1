// Structs with which a test verifies that a declaration has the same memory layout in C++ and in std430:
// shaders/test/layout_probe.comp copies each field to the output.
#ifndef LAYOUT_PROBE_H
#define LAYOUT_PROBE_H
#include "shared/types.h"
GPU_STRUCTS_BEGIN
struct LayoutProbe {
  vec4 vector;
  uvec2 pair;
  float number;
  uint word;
  ivec4 signed_words;
  vec2 two;
  uint tail[2];
  vec3 three;
  uint behind;
};
GPU_STRUCTS_END
#ifdef __cplusplus
static_assert(sizeof(bin_scenes::gpu::LayoutProbe) == 80, "std430 layout");
#endif
#endif
