// Spring clip bent from 0.8 mm strip: an open ring with flared lips on a flat foot. Bent in the xy plane, width along z.
$fn = 72;
strip = 0.8;
width = 10;
ring_r = 9;       // middle of the strip
opening = 70;     // degrees
lip = 8;
lip_angle = 35;   // outwards, from the direction of the opening
foot = 26;

module ring() difference() {
  circle(ring_r + strip / 2);
  circle(ring_r - strip / 2);
  polygon([[0, 0], 3 * ring_r * [cos(90 - opening / 2), sin(90 - opening / 2)], [0, 3 * ring_r],
           3 * ring_r * [cos(90 + opening / 2), sin(90 + opening / 2)]]);
}
module lip() translate(ring_r * [cos(90 - opening / 2), sin(90 - opening / 2)]) rotate(90 - lip_angle) hull() {
  circle(d = strip, $fn = 16);
  translate([lip, 0]) circle(d = strip, $fn = 16);
}

linear_extrude(width) {
  ring();
  lip();
  mirror([1, 0]) lip();
  translate([-foot / 2, -ring_r - strip / 2 - 0.2]) square([foot, strip]);
}
