// Spur gear, module 2, 20 teeth, involute of 20 degrees, with hub, bore and keyway. Axis z, origin at the lower face.
$fn = 64;
m = 2;
teeth = 20;
pressure = 20;
width = 10;
hub_d = 24;
hub_height = 16;
bore = 12;
flank_points = 6;

pitch_r = m * teeth / 2;
base_r = pitch_r * cos(pressure);
root_r = pitch_r - 1.25 * m;
tip_r = pitch_r + m;

function involute(a) = tan(a) * 180 / PI - a;  // degrees
// Half the angle (degrees) that a tooth covers at radius r; radial below the base circle.
function half_tooth(r) = 90 / teeth + involute(pressure) - (r > base_r ? involute(acos(base_r / r)) : 0);
radii = [root_r, for (i = [0:flank_points - 1]) base_r + (tip_r - base_r) * i / (flank_points - 1)];
function at(r, a) = [r * cos(a), r * sin(a)];

module wheel() polygon([for (t = [0:teeth - 1]) let (a = t * 360 / teeth) each concat(
  [for (r = radii) at(r, a - half_tooth(r))],
  [for (i = [len(radii) - 1:-1:0]) at(radii[i], a + half_tooth(radii[i]))])]);

difference() {
  union() {
    linear_extrude(width) wheel();
    cylinder(d = hub_d, h = hub_height);
  }
  translate([0, 0, -1]) {
    cylinder(d = bore, h = hub_height + 2);
    translate([0, -2, 0]) cube([bore / 2 + 1.8, 4, hub_height + 2]);
  }
}
