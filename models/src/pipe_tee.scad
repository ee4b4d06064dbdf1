// Pipe tee, hollow, with a collar at each mouth. Run along x, branch along z, origin where the axes meet.
$fn = 48;
outer = 20;
inner = 15;
collar = 25;
collar_length = 9;
half_run = 30;
branch = 30;

module arm(length, d) cylinder(d = d, h = length);
module arms() {
  rotate([0, 90, 0]) children();
  rotate([0, -90, 0]) children();
  children();
}

difference() {
  arms() {
    arm(half_run, outer);
    translate([0, 0, half_run - collar_length]) arm(collar_length, collar);
  }
  arms() arm(half_run + 1, inner);
}
