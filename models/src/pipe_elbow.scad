// Pipe elbow of 90 degrees, hollow, with a collar at each mouth. Bend in the xz plane, origin in the bend's centre.
$fn = 32;
outer = 20;
inner = 15;
collar = 25;
collar_length = 10;
bend = 26;

module bent(d) rotate([90, 0, 0]) rotate_extrude(angle = 90, $fn = 48) translate([bend, 0]) circle(d = d);
module mouths() {
  translate([bend, 0, 0]) mirror([0, 0, 1]) children();
  translate([0, 0, bend]) rotate([0, -90, 0]) children();
}

// Straight pieces overlap the bend a little: no two solids only share a face.
difference() {
  union() {
    bent(outer);
    mouths() translate([0, 0, -0.5]) cylinder(d = collar, h = collar_length + 0.5);
  }
  bent(inner);
  mouths() translate([0, 0, -0.01]) cylinder(d = inner, h = collar_length + 1);
}
