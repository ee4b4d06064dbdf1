// Constants that both forms of the default solver use. They are macros, because they are also the sizes of arrays.
#ifndef SHARED_SPHERE_CONSTANTS_H
#define SHARED_SPHERE_CONSTANTS_H
#define SPHERE_MAX_CONTACTS 8   // per pair, after reduction; with more contacts, parts that lie face on face sway
#define SPHERE_CLUSTER 16       // nodes in a cluster
#define SPHERE_MAX_EXITS 4u     // exits of a point near sharp edges
#define SPHERE_MAX_WALLS 6u     // walls of a crease at a point
#define SPHERE_EDGE_BLOCK 4u    // cells of the field along a side of a block, for which there is a list of edges
#define SPHERE_EDGE_REACH 3.0f  // cells: the list of a block contains all edges that are nearer to one of its points
#define SPHERE_AXIS 7u          // value of the number of bounds that stands for an axis with its spread

#define SPHERE_GROUND 0xffffffffu  // index of the body that stands for the walls and the floor of the bin
#define SPHERE_SIDE_B 0x80000000u  // bit of a feature: sample of b against the field of a, which gives the normal
#define SPHERE_EDGE 0x40000000u    // bit of a feature: an edge and not a node
#define SPHERE_TURNED 0x20000000u  // bit of a feature: the normal is that of the sample, and the side bit is inverted
#define SPHERE_PLANE 0x1000000u    // factor in a feature: node + plane times this; in a crease, + wall times this

#define SPHERE_BOUNCE_SWEEPS 12u  // sweeps of restitution: a face that lands flat shares its impact among many contacts
#define SPHERE_COLORS 64  // the last color is for manifolds that fit into no other one and are solved one by one
#endif
