// U of three boxes, 50 mm: an exact union of convex pieces, so that a referee can judge scenes of it without any
// approximation (pieces/channel_u). Origin in the middle of the base's outer face.
piece = -1;  // one piece, or all of them

boxes = [  // corner, size
  [[-25, -10, 0], [50, 20, 8]],
  [[-25, -10, 8], [8, 20, 27]],
  [[17, -10, 8], [8, 20, 17]]];
pieces = len(boxes);
echo(pieces = pieces);

for (i = [0:pieces - 1]) if (piece < 0 || i == piece) translate(boxes[i][0]) cube(boxes[i][1]);
