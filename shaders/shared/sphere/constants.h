// Constants that both forms of the default solver use. They are macros, because they are also the sizes of arrays.
#ifndef SHARED_SPHERE_CONSTANTS_H
#define SHARED_SPHERE_CONSTANTS_H
#define SPHERE_MAX_CONTACTS 8   // per pair, after reduction; with more, faces on each other sway
#define SPHERE_CLUSTER 16       // nodes
#define SPHERE_MAX_EXITS 4u     // out of a point near sharp edges
#define SPHERE_MAX_WALLS 6u     // that a point in a crease stands before
#define SPHERE_EDGE_BLOCK 4u    // cells of the field on a side of a block of edges
#define SPHERE_EDGE_REACH 3.0f  // cells: edges within it of a point are in the list of its block
#define SPHERE_AXIS 7u          // in place of the number of a cone's bounds: it is an axis with its spread

#define SPHERE_GROUND 0xffffffffu  // body index of the bin's walls and floor
#define SPHERE_SIDE_B 0x80000000u  // feature: sample of b against the field of a, whose normal it is
#define SPHERE_EDGE 0x40000000u    // feature: edge, not node
#define SPHERE_TURNED 0x20000000u  // feature: the normal is the sample's, and the side as if it were the field's
#define SPHERE_PLANE 0x1000000u  // feature of a ground contact: node + plane times this; in a crease: + wall times this

#define SPHERE_BOUNCE_SWEEPS 12u  // a face that lands flat shares its impact among many contacts
#define SPHERE_COLORS 64          // the last one is for manifolds that find no other: they are solved one by one
#endif
