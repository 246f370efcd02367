// Sheet-metal part, 2.5 mm thick: holes, a notch, and a tab bent up at one side. No symmetry.

length = 84;         // along x [mm]
width = 52;          // along y [mm]
sheet = 2.5;         // thickness [mm]
tab = [24, 18];      // width, height [mm]
tab_at = 14;         // x where the tab begins [mm]
corner = 6;          // radius [mm]
$fn = 40;

module outline() {
  difference() {
    hull() {
      for (x = [corner, length - corner]) translate([x, corner]) circle(r = corner);
      translate([0, width - 1]) square([1, 1]);
      translate([length - 14, width - 1]) square([1, 1]);
      translate([length - 1, width - 16]) square([1, 1]);
    }
    translate([16, 15]) circle(r = 5);
    translate([length - 16, 14]) circle(r = 3.2);
    translate([length - 26, width - 14]) circle(r = 8);
    hull() for (x = [32, 46]) translate([x, 16]) circle(r = 3);
    translate([-1, 22]) square([9, 10]);
  }
}

module tab_outline() {
  difference() {
    hull() {
      square([tab[0], 1]);
      for (x = [5, tab[0] - 5]) translate([x, tab[1] - 5]) circle(r = 5);
    }
    translate([tab[0] / 2, tab[1] - 8]) circle(r = 3.4);
  }
}

union() {
  linear_extrude(height = sheet) outline();
  translate([tab_at, width, 0.5]) rotate([90, 0, 0]) linear_extrude(height = sheet) tab_outline();
}
