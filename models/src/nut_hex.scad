// Hex nut M12 (sizes of ISO 4032, bore at the minor diameter, no thread). Axis z, origin in the middle.
$fn = 48;
across_flats = 18;
height = 10.8;
bore = 10.4;
mouth = 13;

module edge_cone() cylinder(d1 = across_flats * 0.97, d2 = across_flats * 0.97 + 2 * height / tan(30), h = height);

translate([0, 0, -height / 2]) difference() {
  intersection() {
    cylinder(d = across_flats / cos(30), h = height, $fn = 6);
    edge_cone();
    translate([0, 0, height]) mirror([0, 0, 1]) edge_cone();
  }
  translate([0, 0, -1]) cylinder(d = bore, h = height + 2);
  for (z = [0, height]) translate([0, 0, z]) mirror([0, 0, z > 0 ? 1 : 0])
    translate([0, 0, -0.1]) cylinder(d1 = mouth + 0.2, d2 = bore - 0.2, h = (mouth - bore) / 2 + 0.2);
}
