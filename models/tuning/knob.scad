// Clamping knob: a round plate with five finger hollows in its rim, a conical boss below, a hole through both with
// a recess for the nut from above. Turning it by 72 degrees about z leaves it the same.

hollows = 5;
radius = 33;         // of the plate [mm]
hollow_at = 41;      // axis to a hollow's middle [mm]
hollow = 14;         // radius of a hollow [mm]
plate = 15;          // height at the rim [mm]
crown = 3;           // by which the middle is higher [mm]
boss = [11, 17];     // radius at its foot, at the plate [mm]
boss_height = 16;    // below the plate [mm]
bore = 5.2;          // radius of the hole [mm]
recess = [10, 8];    // radius, depth [mm]
$fn = 72;

module outline() {
  offset(r = 3) offset(delta = -3)
    difference() {
      circle(r = radius);
      for (i = [0:hollows - 1]) rotate(360 * i / hollows) translate([hollow_at, 0]) circle(r = hollow, $fn = 60);
    }
}

// Rounded rim below and above, a crown up to the recess.
module rim() {
  rotate_extrude()
    polygon([[0, 0], [radius - 4, 0], [radius - 1.2, 1.2], [radius + 0.5, 4], [radius + 0.5, plate - 4],
             [radius - 1.2, plate - 1.2], [radius - 4, plate], [recess[0] + 4, plate + crown], [0, plate + crown]]);
}

module head() {
  intersection() {
    translate([0, 0, -1]) linear_extrude(height = plate + crown + 2) outline();
    rim();
  }
}

module boss_solid() {
  rotate_extrude()
    polygon([[0, -boss_height], [boss[0] - 1, -boss_height], [boss[0], 1 - boss_height], [boss[1], 0], [boss[1], 1], [0, 1]]);
}

module cuts() {
  translate([0, 0, -boss_height - 1]) cylinder(r = bore, h = boss_height + plate + crown + 2, $fn = 40);
  translate([0, 0, plate + crown - recess[1]]) cylinder(r = recess[0], h = recess[1] + 1, $fn = 60);
}

difference() {
  union() {
    head();
    boss_solid();
  }
  cuts();
}
