// Connecting rod, 80 mm long: big end with bolt bosses, I-beam shank, small end. Rod along x, bores along z,
// origin in the middle of the big bore.
$fn = 48;
centres = 56;
big_outer = 30;
big_bore = 22;
big_height = 13;
small_outer = 18;
small_bore = 11;
small_height = 11;
web = 3;
beam_height = 8;

module bar(w0, w1, h) linear_extrude(h, center = true) polygon([
  [big_outer / 2 - 3, -w0 / 2], [centres - small_outer / 2 + 2, -w1 / 2],
  [centres - small_outer / 2 + 2, w1 / 2], [big_outer / 2 - 3, w0 / 2]]);
module pocket() translate([0, 0, web / 2]) linear_extrude(beam_height) offset(r = 1.5) polygon([
  [big_outer / 2 + 4, -4], [centres - small_outer / 2 - 3, -1.8],
  [centres - small_outer / 2 - 3, 1.8], [big_outer / 2 + 4, 4]]);

difference() {
  union() {
    cylinder(d = big_outer, h = big_height, center = true);
    translate([centres, 0, 0]) cylinder(d = small_outer, h = small_height, center = true);
    bar(17, 12, beam_height);
    for (s = [-1, 1]) translate([0, s * 15.5, 0]) cube([16, 7, big_height - 2], center = true);
  }
  cylinder(d = big_bore, h = big_height + 2, center = true);
  translate([centres, 0, 0]) cylinder(d = small_bore, h = small_height + 2, center = true);
  pocket();
  mirror([0, 0, 1]) pocket();
  for (s = [-1, 1]) translate([0, s * 15.5, 0]) rotate([0, 90, 0]) cylinder(d = 3.5, h = 20, center = true, $fn = 24);
}
