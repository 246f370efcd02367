// Mounting bracket without any symmetry: base plate and wall joined by a fillet, a rib near one end, a boss
// with a blind hole near the other, a slot in the base and a large hole off-centre in the wall.
// Base on z = 0, wall along y at x = 0. fitting/angle.scad takes its plates and openings from here.

width = 64;        // along y [mm]
depth = 56;        // of the base along x [mm]
height = 46;       // of the wall [mm]
thickness = 6;     // [mm]
fillet = 6;        // between base and wall [mm]
rib_at = 6;        // y of the rib [mm]
rib_width = 6;     // [mm]
boss_at = [38, 47];
boss_radius = 9;   // [mm]
boss_height = 14;  // above the base's underside [mm]
$fn = 64;

module profile() {
  offset(r = -fillet) offset(r = fillet)
    union() {
      square([depth, thickness]);
      square([thickness, height]);
    }
}

// Wall and base, corners of both plates cut or rounded differently.
module plates() {
  intersection() {
    translate([0, width, 0]) rotate([90, 0, 0]) linear_extrude(height = width) profile();
    linear_extrude(height = height)
      hull() {
        square([1, width]);
        translate([depth - 12, width - 12]) circle(r = 12);
        translate([depth - 9, 0]) square([1, 1]);
        translate([depth - 1, 8]) square([1, 1]);
      }
    rotate([90, 0, 90]) linear_extrude(height = depth)
      hull() {
        square([width, 1]);
        translate([0, height - 1]) square([1, 1]);
        translate([width - 18, height - 18]) circle(r = 18);
      }
  }
}

module rib() {
  translate([0, rib_at + rib_width, 0]) rotate([90, 0, 0])
    linear_extrude(height = rib_width)
      polygon([[1, 1], [depth - 14, 1], [depth - 14, thickness + 1], [thickness + 1, height - 10], [1, height - 10]]);
}

// Slot in the base, hole in the wall.
module openings() {
  translate([0, 0, -1]) linear_extrude(height = thickness + 2)
    hull() for (y = [24, 30]) translate([depth - 14, y - 2]) circle(r = 4);
  translate([-1, width - 22, height - 18]) rotate([0, 90, 0]) cylinder(r = 10, h = thickness + 2);
}

difference() {
  union() {
    plates();
    rib();
    translate([boss_at[0], boss_at[1], 0.5]) cylinder(r = boss_radius, h = boss_height - 1.5);
    translate([boss_at[0], boss_at[1], boss_height - 1.01]) cylinder(r1 = boss_radius, r2 = boss_radius - 1, h = 1.01);
  }
  translate([boss_at[0], boss_at[1], 4]) cylinder(r = 4, h = boss_height);
  openings();
}
