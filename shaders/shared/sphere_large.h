// Data of worlds that are spread over many groups: one such world at a time, its bodies counted in the world.
#ifndef SHARED_SPHERE_LARGE_H
#define SHARED_SPHERE_LARGE_H
#include "shared/sphere.h"

#define BIND_LARGE 23
#define BIND_BOXES 24  // in find_pairs; in the solve the same buffer holds motions
#define BIND_MOTIONS 24
#define BIND_WORK 25
#define BIND_CELL_COUNTS 26
#define BIND_CELL_STARTS 27
#define BIND_SORTED 28
#define BIND_PAIR_COUNTS 29
#define BIND_PAIR_STARTS 30

#define SPHERE_MOST_ROUNDS 64  // of coloring that have dispatches of their own

// What a pass over bodies, pairs or manifolds does.
#define CUT_MEASURE 0u
#define CUT_SET 1u
#define LIST_COUNT 0u
#define LIST_PLACE 1u
#define COLOR_BEGIN 0u
#define COLOR_BID 1u
#define COLOR_TAKE 2u
#define COLOR_ORDER 3u
#define COLOR_JOIN 4u
#define BODIES_BEGIN 0u
#define BODIES_VELOCITIES 1u
#define BODIES_POSITIONS 2u
#define BODIES_KEEP 3u
#define MANIFOLDS_PREPARE 6u  // behind the sweeps
#define MANIFOLDS_STRIKE 7u
#define MANIFOLDS_KEEP 8u
#define MANIFOLDS_NOTE 9u
#define SLEEP_NOTE 0u
#define SLEEP_MARK 1u
#define SLEEP_SETTLE 2u

GPU_STRUCTS_BEGIN

// A world that is spread over many groups, in the step under way.
struct SphereLarge {
  uint awake, extent, big, bounced;  // 0: has nothing to do; largest box (bits of m); bodies too large for the grid
  uint list, speed, turn, narrow_color;  // first pair; of the fastest body (bits of m/s, rad/s); first of the rest
  uvec4 pair_groups, manifold_groups, rest_groups;  // arguments of dispatches over pairs, manifolds, the last colors
  uvec4 round_groups[SPHERE_MOST_ROUNDS + 1];
  uvec4 color_groups[SPHERE_COLORS];
  uint starts[SPHERE_COLORS], members_in[SPHERE_COLORS];  // of each color: its first manifold, how many
  uint members[SPHERE_COLORS * SPHERE_MAX_CONTACTS];      // by color and length: how many, then where the next one goes
  uint row_count, row_top, unused[2];  // vec4 that rows take, and those given out so far
};

struct SphereBox {
  vec4 center, half_size;  // as struct Box of shaders/sphere/box.h
  ivec4 cell;              // shaders/sphere/large/cell.h
};

struct SphereMotion {  // since contacts were found
  vec4 moved, turned;
};

struct SphereWork {
  uint lowest[2];  // coloring: lowest key, by round; update_sleep: label of the island, and whether a body of it moved lately
  uint used_low, used_high;
};

GPU_STRUCTS_END

#ifdef __cplusplus
namespace bin_scenes::gpu {
static_assert(sizeof(SphereBox) == 48 && sizeof(SphereMotion) == 32 && sizeof(SphereWork) == 16, "std430");
static_assert(sizeof(SphereLarge) == 80 + 16 * (SPHERE_MOST_ROUNDS + 1 + SPHERE_COLORS) + 8 * SPHERE_COLORS +
                                       4 * SPHERE_COLORS * SPHERE_MAX_CONTACTS + 16,
              "std430");
}  // namespace bin_scenes::gpu
#endif
#endif
