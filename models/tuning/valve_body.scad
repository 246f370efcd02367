// Body of an angle valve, hollow: the pipe comes in from below along z and goes out along x; the bonnet leans back
// at 40 degrees from the vertical. Square flange at the inlet, round one at the outlet, a drain boss on one side
// only, so that no rotation leaves it the same.

chamber = 17;        // radius of the middle [mm]
pipe = 12;           // radius of both arms [mm]
bore = 8.5;          // radius of the water's way [mm]
inlet = 34;          // middle to the inlet's face [mm]
outlet = 42;         // middle to the outlet's face [mm]
bonnet = 36;         // middle to the bonnet's top [mm]
flange = 36;         // width of the square flange [mm]
flange_height = 6;   // [mm]
$fn = 32;

module along_bonnet() { rotate([0, -40, 0]) children(); }

module square_flange() {
  translate([0, 0, -inlet])
    difference() {
      linear_extrude(height = flange_height) offset(r = 5) square(flange - 10, center = true);
      for (x = [-1, 1], y = [-1, 1])
        translate([x * 12.5, y * 12.5, -1]) cylinder(r = 2.4, h = flange_height + 2, $fn = 20);
    }
}

module outside() {
  sphere(r = chamber);
  translate([0, 0, -inlet]) cylinder(r = pipe, h = inlet);
  square_flange();
  rotate([0, 90, 0]) cylinder(r = pipe, h = outlet);
  translate([outlet - 11, 0, 0]) rotate([0, 90, 0]) cylinder(r = 16, h = 11);
  along_bonnet() {
    cylinder(r = 13, h = bonnet - 9);
    translate([0, 0, bonnet - 10]) cylinder(d = 36, h = 10, $fn = 6);
  }
  translate([4, 0, -2]) rotate([90, 0, 0]) cylinder(r = 7, h = 25);
}

module inside() {
  sphere(r = 11);
  translate([0, 0, -inlet - 1]) cylinder(r = bore, h = inlet);
  rotate([0, 90, 0]) cylinder(r = bore, h = outlet + 1);
  translate([outlet - 8, 0, 0]) rotate([0, 90, 0]) cylinder(r = 12, h = 9);
  along_bonnet() cylinder(r = 9, h = bonnet + 1);
  translate([4, 0, -2]) rotate([90, 0, 0]) cylinder(r = 3, h = 26);
}

difference() {
  outside();
  inside();
}
