// L-bracket bent from 2 mm sheet, two holes in each leg. Bend along y, origin at the outer corner.
$fn = 32;
sheet = 2;
leg_x = 50;
leg_z = 40;
width = 30;
inner_radius = 3;
hole = 5.5;
corner = 5;

module profile() difference() {
  hull() {
    translate([inner_radius + sheet, inner_radius + sheet]) circle(inner_radius + sheet, $fn = 64);
    translate([leg_x - 1, 0]) square([1, 1]);
    translate([0, leg_z - 1]) square([1, 1]);
    translate([leg_x - 1, leg_z - 1]) square([1, 1]);
  }
  hull() {
    translate([inner_radius + sheet, inner_radius + sheet]) circle(inner_radius, $fn = 64);
    translate([leg_x, sheet]) square([1, 1]);
    translate([sheet, leg_z]) square([1, 1]);
    translate([leg_x, leg_z]) square([1, 1]);
  }
}

// Outline of a flat leg seen from its face: two corners cut at the free end.
module outline(length) polygon([[-1, -1], [length - corner, -1], [length - corner, 0], [length, corner],
                                [length, width - corner], [length - corner, width], [length - corner, width + 1],
                                [-1, width + 1]]);

difference() {
  intersection() {
    translate([0, width, 0]) rotate([90, 0, 0]) linear_extrude(width) profile();
    translate([0, 0, -1]) linear_extrude(leg_z + 2) outline(leg_x);
    rotate([0, -90, 0]) translate([0, 0, -leg_x - 1]) linear_extrude(leg_x + 2) outline(leg_z);
  }
  for (y = [width / 4, 3 * width / 4]) {
    translate([leg_x - 14, y, -1]) cylinder(d = hole, h = sheet + 2);
    translate([-1, y, leg_z - 12]) rotate([0, 90, 0]) cylinder(d = hole, h = sheet + 2);
  }
}
