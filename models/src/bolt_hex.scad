// Hex bolt M10 x 40 (head sizes of ISO 4017, shank without thread): an exact union of two convex pieces
// (pieces/bolt_hex). Axis z, origin under the head.
piece = -1;  // one piece, or all of them
pieces = 2;
echo(pieces = pieces);
$fn = 48;
d = 10;
length = 40;
across_flats = 16;
head = 6.4;
chamfer = 1;

module head() intersection() {
  cylinder(d = across_flats / cos(30), h = head, $fn = 6);
  // ISO chamfer of 30 degrees: the corners of the hexagon are turned off at the top.
  cylinder(d1 = across_flats * 0.97 + 2 * head / tan(30), d2 = across_flats * 0.97, h = head);
}

if (piece != 1) head();
// The shank reaches into the head, so that both unite without a shared face.
if (piece != 0) translate([0, 0, -length]) {
  cylinder(d1 = d - 2 * chamfer, d2 = d, h = chamfer);
  translate([0, 0, chamfer]) cylinder(d = d, h = length - chamfer + 1);
}
