// Constants that both forms of the default solver use. They are macros, because they are also the sizes of arrays.
#ifndef SHARED_SPHERE_CONSTANTS_H
#define SHARED_SPHERE_CONSTANTS_H
#define SPHERE_MAX_CONTACTS 8   // largest number of contacts of a pair; with more, parts that lie face on face sway
#define SPHERE_CLUSTER 16       // number of nodes in a cluster
#define SPHERE_MAX_EXITS 4u     // largest number of exits (edge.h) of a point near sharp edges
#define SPHERE_MAX_WALLS 6u     // largest number of walls (crease.h) at a point
#define SPHERE_EDGE_BLOCK 4u    // number of field cells along a side of a block; each block has a list of near edges
#define SPHERE_EDGE_REACH 3.0f  // cells: the list of a block contains all edges that are nearer to one of its points
#define SPHERE_AXIS 7u          // value in place of the number of bounds of a normal cone: it has an axis and a spread

#define SPHERE_GROUND 0xffffffffu  // index of the body that stands for the walls and the floor of the bin
#define SPHERE_SIDE_B 0x80000000u  // bit of a feature: the sample is of b, and the field of a gives the normal
#define SPHERE_EDGE 0x40000000u    // bit of a feature: the sample is an edge and not a node
#define SPHERE_TURNED 0x20000000u  // bit of a feature: the normal is that of the sample, and the side bit is inverted
#define SPHERE_PLANE 0x1000000u    // factor in a feature: number of the sample + this x number of the plane or wall

#define SPHERE_BOUNCE_SWEEPS 12u  // number of restitution sweeps; a face that lands flat has many contacts in an impact
#define SPHERE_COLORS 64  // number of colors; manifolds of the last color may share bodies and are solved one by one
#endif
