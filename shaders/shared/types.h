// Defines GLSL's types in C++, so that one struct declaration serves both languages. Members are vec4, uvec4, ivec4,
// vec2, uvec2, uint, int and float. A vec3 is allowed only at a multiple of 16 bytes with a uint or float directly
// behind it; elsewhere the layouts of std430 and C++ differ.
#ifdef __cplusplus
#pragma once
#include <cstdint>
namespace bin_scenes::gpu {
using uint = std::uint32_t;
struct alignas(8) vec2 { float x, y; };
struct alignas(8) uvec2 { uint x, y; };
struct vec3 { float x, y, z; };
struct alignas(16) vec4 { float x, y, z, w; };
struct alignas(16) uvec4 { uint x, y, z, w; };
struct alignas(16) ivec4 { int x, y, z, w; };
}  // namespace bin_scenes::gpu
#define GPU_STRUCTS_BEGIN namespace bin_scenes::gpu {
#define GPU_STRUCTS_END }
#else
#define GPU_STRUCTS_BEGIN
#define GPU_STRUCTS_END
#endif
