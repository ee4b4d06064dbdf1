// Mug with handle, 70 mm high, wall 3 mm. Axis z, origin in the middle of the foot.
$fn = 64;
height = 70;
d = 58;
wall = 3;

module cup() rotate_extrude() polygon([
  [0, 2], [19, 2], [21, 0], [25, 0], [d / 2, 5], [d / 2, height - 1], [d / 2 - 1, height],
  [d / 2 - wall + 0.6, height], [d / 2 - wall, height - 1], [d / 2 - wall, 8], [22, 5], [0, 5]]);

module handle() translate([d / 2 - 3, 0, height / 2]) rotate([90, 0, 0]) scale([1, 1.15, 1])
  rotate_extrude($fn = 48) translate([18, 0]) scale([0.7, 1]) circle(5, $fn = 20);

cup();
// Only what sticks out of the cup's middle surface: the handle must not reach into the mug.
difference() {
  handle();
  translate([0, 0, -1]) cylinder(d = d - wall, h = height + 2);
}
