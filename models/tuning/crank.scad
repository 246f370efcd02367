// Hand crank: a hub with a keyed hole, an arm that is bent out of its plane, a handle that stands on its end.
// No symmetry.

hub = 14;            // radius [mm]
hub_height = 18;     // [mm]
shaft = 7;           // radius of the hole [mm]
key = [5, 3];        // width, depth beyond the hole [mm]
reach = 62;          // hub's axis to the handle's axis [mm]
rise = 9;            // of the arm from hub to handle [mm]
arm = [14, 7];       // width, height [mm]
handle = 34;         // length above the arm [mm]
$fn = 48;

module hub_solid() {
  cylinder(r = hub, h = hub_height - 1);
  translate([0, 0, hub_height - 1.01]) cylinder(r1 = hub, r2 = hub - 1, h = 1.01);
}

module step(x, z, radius) { translate([x, 0, z]) cylinder(r = radius, h = arm[1]); }

// Flat at the hub, sloping, flat at the handle.
module arm_solid() {
  hull() { step(0, 2, arm[0] / 2 + 3); step(18, 2, arm[0] / 2); }
  hull() { step(18, 2, arm[0] / 2); step(46, 2 + rise, arm[0] / 2); }
  hull() { step(46, 2 + rise, arm[0] / 2); step(reach, 2 + rise, arm[0] / 2 + 2); }
}

module handle_solid() {
  translate([reach, 0, rise + arm[1] + 1])
    rotate_extrude()
      polygon([[0, 0], [5, 0], [5, 2], [8, 4], [9, 16], [8.2, 24], [7, handle - 4], [4, handle], [0, handle]]);
}

difference() {
  union() {
    hub_solid();
    arm_solid();
    handle_solid();
  }
  translate([0, 0, -1]) cylinder(r = shaft, h = hub_height + 2);
  translate([-key[0] / 2, 0, -1]) cube([key[0], shaft + key[1], hub_height + 2]);
}
