// Plain washer for M12 (sizes of ISO 7089). Axis z, origin in the middle of the lower face.
$fn = 96;
difference() {
  cylinder(d = 24, h = 2.5);
  translate([0, 0, -1]) cylinder(d = 13, h = 5);
}
