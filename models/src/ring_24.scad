// Ring of 24 facets, 60 mm: an exact union of 24 convex pieces (pieces/ring_24). Axis z, origin in the middle.
piece = -1;  // one piece, or all of them
pieces = 24;
echo(pieces = pieces);
outer = 30;
inner = 21;
height = 12;

function at(r, i) = let (a = (i % pieces) * 360 / pieces) [r * cos(a), r * sin(a)];
for (i = [0:pieces - 1]) if (piece < 0 || i == piece)
  linear_extrude(height, center = true) polygon([at(inner, i), at(outer, i), at(outer, i + 1), at(inner, i + 1)]);
