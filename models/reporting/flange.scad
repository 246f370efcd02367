// Mounting flange: a plate with three ears, a hole in each, and a round boss with a bore on one side. Turning it by
// 120 degrees about z leaves it the same. Two ears point one way and one the other, so that the middle of its box
// is 10 mm from the axis.

ears = 3;
ear_at = 41.5;       // axis to an ear's hole [mm]
ear = 5.5;           // radius of an ear [mm]
hole = 2.75;         // radius of an ear's hole [mm]
plate = 8;           // height [mm]
body = 25;           // radius of the plate [mm]
root = 12;           // half width of an ear towards the axis [mm]
boss = 18;           // radius at its top [mm]
boss_height = 24;    // from z = 0 [mm]
bore = 10;           // radius [mm]
seat = [14, 6];      // of the bearing, from above: radius, depth [mm]
$fn = 72;

module outline() {
  offset(r = -8) offset(r = 8)
    union() {
      circle(r = body);
      for (i = [0:ears - 1])
        rotate(360 * i / ears)
          hull() {
            circle(r = root);
            translate([ear_at, 0]) circle(r = ear, $fn = 48);
          }
    }
}

module plate_solid() {
  linear_extrude(height = plate - 1) outline();
  translate([0, 0, plate - 1.01]) linear_extrude(height = 1.01, scale = 0.98) outline();
}

module boss_solid() {
  rotate_extrude()
    polygon([[0, 1], [boss + 3, 1], [boss + 3, plate], [boss + 1.2, plate + 1], [boss, plate + 3],
             [boss, boss_height - 1], [boss - 1, boss_height], [0, boss_height]]);
}

module cuts() {
  rotate_extrude()
    polygon([[0, -1], [bore + 2, -1], [bore, 1], [bore, boss_height - seat[1]], [seat[0], boss_height - seat[1]],
             [seat[0], boss_height - 0.8], [seat[0] + 1.8, boss_height + 1], [0, boss_height + 1]]);
  for (i = [0:ears - 1])
    rotate(360 * i / ears) translate([ear_at, 0, -1]) cylinder(r = hole, h = plate + 2, $fn = 32);
}

difference() {
  union() {
    plate_solid();
    boss_solid();
  }
  cuts();
}
