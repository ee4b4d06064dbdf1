#!/usr/bin/env python3
"""Prints an OpenSCAD program for the Utah teapot as one closed solid, 100 mm from handle to spout.

Martin Newell's teapot is 32 bicubic Bezier patches on 306 control points (F. Crow, "The origins of the teapot", IEEE
CG&A 7(1), 1987). It is symmetric, so that ten patches and their mirror images give them all: `POINTS` has the control
points with y <= 0, `PATCHES` the ten. The patches are surfaces that meet or pierce each other, not a solid. Here they
become three closed shells, which OpenSCAD unites exactly:
  body    bottom, belly, rim and lid; the slit of 0.1 units between rim and lid is closed by a flat ring
  handle  a tube whose ends are drawn on into the belly and capped
  spout   a tube that starts inside the belly; its mouth is closed by a flat cap, a little below the lip
The solid is full: what a teapot holds belongs to it. Vertical axis z, origin in the middle of the bottom.
"""

SEGMENTS = 8         # per patch and direction
SIZE = 100.0         # mm, longest side: handle to spout, along x

POINTS = [
    (0.2, 0, 2.7), (0.2, -0.112, 2.7), (0.112, -0.2, 2.7), (0, -0.2, 2.7),
    (1.3375, 0, 2.53125), (1.3375, -0.749, 2.53125), (0.749, -1.3375, 2.53125), (0, -1.3375, 2.53125),
    (1.4375, 0, 2.53125), (1.4375, -0.805, 2.53125), (0.805, -1.4375, 2.53125), (0, -1.4375, 2.53125),
    (1.5, 0, 2.4), (1.5, -0.84, 2.4), (0.84, -1.5, 2.4), (0, -1.5, 2.4),
    (1.75, 0, 1.875), (1.75, -0.98, 1.875), (0.98, -1.75, 1.875), (0, -1.75, 1.875),
    (2, 0, 1.35), (2, -1.12, 1.35), (1.12, -2, 1.35), (0, -2, 1.35),
    (2, 0, 0.9), (2, -1.12, 0.9), (1.12, -2, 0.9), (0, -2, 0.9),
    (-2, 0, 0.9),
    (2, 0, 0.45), (2, -1.12, 0.45), (1.12, -2, 0.45), (0, -2, 0.45),
    (1.5, 0, 0.225), (1.5, -0.84, 0.225), (0.84, -1.5, 0.225), (0, -1.5, 0.225),
    (1.5, 0, 0.15), (1.5, -0.84, 0.15), (0.84, -1.5, 0.15), (0, -1.5, 0.15),
    # handle
    (-1.6, 0, 2.025), (-1.6, -0.3, 2.025), (-1.5, -0.3, 2.25), (-1.5, 0, 2.25),
    (-2.3, 0, 2.025), (-2.3, -0.3, 2.025), (-2.5, -0.3, 2.25), (-2.5, 0, 2.25),
    (-2.7, 0, 2.025), (-2.7, -0.3, 2.025), (-3, -0.3, 2.25), (-3, 0, 2.25),
    (-2.7, 0, 1.8), (-2.7, -0.3, 1.8), (-3, -0.3, 1.8), (-3, 0, 1.8),
    (-2.7, 0, 1.575), (-2.7, -0.3, 1.575), (-3, -0.3, 1.35), (-3, 0, 1.35),
    (-2.5, 0, 1.125), (-2.5, -0.3, 1.125), (-2.65, -0.3, 0.9375), (-2.65, 0, 0.9375),
    (-2, -0.3, 0.9), (-1.9, -0.3, 0.6), (-1.9, 0, 0.6),
    # spout
    (1.7, 0, 1.425), (1.7, -0.66, 1.425), (1.7, -0.66, 0.6), (1.7, 0, 0.6),
    (2.6, 0, 1.425), (2.6, -0.66, 1.425), (3.1, -0.66, 0.825), (3.1, 0, 0.825),
    (2.3, 0, 2.1), (2.3, -0.25, 2.1), (2.4, -0.25, 2.025), (2.4, 0, 2.025),
    (2.7, 0, 2.4), (2.7, -0.25, 2.4), (3.3, -0.25, 2.4), (3.3, 0, 2.4),
    (2.8, 0, 2.475), (2.8, -0.25, 2.475), (3.525, -0.25, 2.49375), (3.525, 0, 2.49375),
    (2.9, 0, 2.475), (2.9, -0.15, 2.475), (3.45, -0.15, 2.5125), (3.45, 0, 2.5125),
    (2.8, 0, 2.4), (2.8, -0.15, 2.4), (3.2, -0.15, 2.4), (3.2, 0, 2.4),
    # lid
    (0, 0, 3.15), (0.8, 0, 3.15), (0.8, -0.45, 3.15), (0.45, -0.8, 3.15), (0, -0.8, 3.15),
    (0, 0, 2.85),
    (1.4, 0, 2.4), (1.4, -0.784, 2.4), (0.784, -1.4, 2.4), (0, -1.4, 2.4),
    (0.4, 0, 2.55), (0.4, -0.224, 2.55), (0.224, -0.4, 2.55), (0, -0.4, 2.55),
    (1.3, 0, 2.55), (1.3, -0.728, 2.55), (0.728, -1.3, 2.55), (0, -1.3, 2.55),
    (1.3, 0, 2.4), (1.3, -0.728, 2.4), (0.728, -1.3, 2.4), (0, -1.3, 2.4),
    # bottom
    (0, 0, 0), (1.425, -0.798, 0), (1.5, 0, 0.075), (1.425, 0, 0), (0.798, -1.425, 0), (0, -1.5, 0.075),
    (0, -1.425, 0), (1.5, -0.84, 0.075), (0.84, -1.5, 0.075)]

# Sixteen control points each, four rows of four; rows run along the profile (body) or along the tube (handle, spout).
PATCHES = {
    "lid_knob": [96, 96, 96, 96, 97, 98, 99, 100, 101, 101, 101, 101, 0, 1, 2, 3],
    "lid": [0, 1, 2, 3, 106, 107, 108, 109, 110, 111, 112, 113, 114, 115, 116, 117],
    "rim": [102, 103, 104, 105, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15],
    "belly_upper": [12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27],
    "belly_lower": [24, 25, 26, 27, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40],
    "bottom": [37, 38, 39, 40, 120, 125, 126, 123, 121, 119, 122, 124, 118, 118, 118, 118],
    "handle_upper": [41, 42, 43, 44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56],
    "handle_lower": [53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 64, 28, 65, 66, 67],
    "spout_lower": [68, 69, 70, 71, 72, 73, 74, 75, 76, 77, 78, 79, 80, 81, 82, 83],
    "spout_upper": [80, 81, 82, 83, 84, 85, 86, 87, 88, 89, 90, 91, 92, 93, 94, 95]}


def bernstein(t):
    s = 1.0 - t
    return s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t


def evaluate(patch, u, v):
    """Point of a patch; u along its rows, v across them."""
    bu, bv = bernstein(u), bernstein(v)
    corner = [POINTS[i] for i in PATCHES[patch]]
    return tuple(sum(bu[r] * bv[c] * corner[4 * r + c][axis] for r in range(4) for c in range(4)) for axis in range(3))


def turned(point, quarter):
    """Point turned about z by quarters of a turn; exact, so that neighbours meet in equal coordinates."""
    x, y, z = point
    return ((x, y, z), (y, -x, z), (-x, -y, z), (-y, x, z))[quarter]


def ring_of_body(patch, u):
    """A closed ring about z: one quarter of it is on the patch, clockwise seen from above."""
    quarter = [evaluate(patch, u, v / SEGMENTS) for v in range(SEGMENTS)]
    return [turned(p, q) for q in range(4) for p in quarter]


def ring_of_tube(patch, u):
    """A closed ring about a tube: half of it on the patch (y <= 0), the other half its mirror image."""
    half = [evaluate(patch, u, v / SEGMENTS) for v in range(SEGMENTS + 1)]
    return half + [(x, -y, z) for x, y, z in half[-2:0:-1]]


def rings(patches, ring_of):
    """Rings along several patches, the seams between them once."""
    out = []
    for number, patch in enumerate(patches):
        out += [ring_of(patch, u / SEGMENTS) for u in range(0 if number == 0 else 1, SEGMENTS + 1)]
    return out


def shell(rings):
    """Closed surface through rings of equal size, a point at each end (the middle of the end ring).

    Returns (vertices, triangles), outwards if the rings turn clockwise seen from the end they run to.
    """
    vertices, triangles, n = [], [], len(rings[0])
    middle = lambda ring: tuple(sum(p[axis] for p in ring) / n for axis in range(3))
    for ring in rings:
        vertices += ring
    first, last = len(vertices), len(vertices) + 1
    vertices += [middle(rings[0]), middle(rings[-1])]
    for r in range(len(rings) - 1):
        for i in range(n):
            a, b = r * n + i, r * n + (i + 1) % n
            triangles += [(a, a + n, b), (b, a + n, b + n)]
    end = (len(rings) - 1) * n
    for i in range(n):
        j = (i + 1) % n
        triangles += [(first, i, j), (last, end + j, end + i)]
    return vertices, triangles


def body():
    upwards = lambda patch: [ring_of_body(patch, 1 - u / SEGMENTS) for u in range(SEGMENTS + 1)]
    # Poles and seams fall together; the end points of shell() take the place of the rings of radius 0.
    out = upwards("bottom")[1:] + upwards("belly_lower")[1:] + upwards("belly_upper")[1:] + upwards("rim")[1:]
    out += upwards("lid") + upwards("lid_knob")[1:-1]
    return shell(out)


def handle():
    tube = rings(["handle_upper", "handle_lower"], ring_of_tube)
    # The ends just touch the belly's surface: draw them on into it.
    inwards = lambda ring: [(x + 0.3, y, z) for x, y, z in ring]
    return shell([inwards(tube[0])] + tube + [inwards(tube[-1])])


def spout():
    return shell(rings(["spout_lower", "spout_upper"], ring_of_tube))


def volume(vertices, triangles):
    total = 0.0
    for a, b, c in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = vertices[a], vertices[b], vertices[c]
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


def main():
    shells = [body(), handle(), spout()]
    xs = [p[0] for vertices, _ in shells for p in vertices]
    scale = SIZE / (max(xs) - min(xs))
    print("union() {")
    for vertices, triangles in shells:
        if volume(vertices, triangles) > 0:  # OpenSCAD wants faces clockwise seen from outside
            triangles = [(a, c, b) for a, b, c in triangles]
        points = ",".join("[%.9g,%.9g,%.9g]" % tuple(scale * c for c in p) for p in vertices)
        faces = ",".join("[%d,%d,%d]" % t for t in triangles)
        print("polyhedron(points = [%s],\n  faces = [%s]);" % (points, faces))
    print("}")


if __name__ == "__main__":
    main()
