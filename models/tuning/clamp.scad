// Two-sided clamp plate (a bridge): two feet, a raised middle with a slot, a rounded saddle below. Turning it by
// 180 degrees about z leaves it the same; its ends are cut at a slant, so that no mirror does.

length = 78;         // along x [mm]
width = 30;          // along y [mm]
height = 26;         // [mm]
foot = 15;           // length of a foot [mm]
saddle = 17;         // radius of the hollow below [mm]
slot = [22, 9];      // length, width of the slot [mm]
slant = 7;           // by which an end's corner is cut back [mm]
$fn = 64;

module profile() {
  difference() {
    offset(r = 2) offset(delta = -2)
      polygon([[-length / 2, 0], [length / 2, 0], [length / 2, 10], [foot, height], [-foot, height], [-length / 2, 10]]);
    intersection() {
      translate([0, -2]) circle(r = saddle);
      translate([-saddle, -1]) square([2 * saddle, 40]);
    }
    translate([-length / 2 + foot, -1]) square([length - 2 * foot, 4]);
  }
}

module outline() {
  polygon([[-length / 2 - 1, -width / 2], [length / 2 - slant, -width / 2], [length / 2 + 1, -width / 2 + 2 * slant],
           [length / 2 + 1, width / 2], [-length / 2 + slant, width / 2], [-length / 2 - 1, width / 2 - 2 * slant]]);
}

difference() {
  intersection() {
    translate([0, width / 2, 0]) rotate([90, 0, 0]) linear_extrude(height = width) profile();
    translate([0, 0, -1]) linear_extrude(height = height + 2) outline();
  }
  translate([0, 0, -1])
    linear_extrude(height = height + 2)
      hull() for (x = [-1, 1]) translate([x * (slot[0] - slot[1]) / 2, 0]) circle(d = slot[1]);
  for (side = [0, 180]) rotate(side) translate([30, -2, -1]) cylinder(r = 3.2, h = height, $fn = 32);
}
