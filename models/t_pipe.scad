// T pipe fitting: a run along x and a branch along z, hollow, with a collar at each of the three openings.

outer_radius = 13;   // [mm]
bore_radius = 9.5;   // [mm]
collar_radius = 17;  // [mm]
seat_radius = 12.6;  // inside of a collar [mm]
collar_length = 13;  // [mm]
seat_depth = 11;     // [mm]
run = 84;            // face to face [mm]
branch = 46;         // axis of the run to the face of the branch [mm]
bevel = 1;           // [mm]
$fn = 48;

// The solid from the crossing (0) to a face, turned about its axis.
module arm(length) {
  rotate_extrude()
    polygon([[0, 0], [outer_radius, 0], [outer_radius, length - collar_length - 2],
             [collar_radius, length - collar_length], [collar_radius, length - bevel],
             [collar_radius - bevel, length], [0, length]]);
}

module bore(length) {
  rotate_extrude()
    polygon([[0, 0], [bore_radius, 0], [bore_radius, length - seat_depth],
             [seat_radius, length - seat_depth], [seat_radius, length - bevel],
             [seat_radius + bevel, length], [seat_radius + bevel, length + 1], [0, length + 1]]);
}

// Both halves of the run in one turned body: no seam at the crossing.
module both() {
  rotate([0, 90, 0])
    rotate_extrude()
      for (side = [0, 1]) mirror([0, side]) children();
}

module run_solid() {
  both() polygon([[0, -0.01], [outer_radius, -0.01], [outer_radius, run / 2 - collar_length - 2],
                  [collar_radius, run / 2 - collar_length], [collar_radius, run / 2 - bevel],
                  [collar_radius - bevel, run / 2], [0, run / 2]]);
}

module run_bore() {
  both() polygon([[0, -0.01], [bore_radius, -0.01], [bore_radius, run / 2 - seat_depth],
                  [seat_radius, run / 2 - seat_depth], [seat_radius, run / 2 - bevel],
                  [seat_radius + bevel, run / 2], [seat_radius + bevel, run / 2 + 1], [0, run / 2 + 1]]);
}

difference() {
  union() {
    run_solid();
    arm(branch);
  }
  run_bore();
  bore(branch);
}
