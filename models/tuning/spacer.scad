// Spacer between two plates: a ring carried by three tubes for the screws, both sides alike. Turning it by 120
// degrees about z leaves it the same, and so does a half turn about the line through the middle of a tube.

tubes = 3;
tube_at = 31;        // axis to a tube's axis [mm]
tube = 8;            // radius of a tube [mm]
hole = 3.3;          // radius of a tube's hole [mm]
length = 32;         // of a tube, along z [mm]
ring = [19, 26];     // inner, outer radius [mm]
ring_height = 14;    // [mm]
bevel = 1;           // [mm]
$fn = 72;

module ring_solid() {
  h = ring_height / 2;
  rotate_extrude()
    polygon([[1, -h], [ring[1] - bevel, -h], [ring[1], bevel - h], [ring[1], h - bevel], [ring[1] - bevel, h], [1, h]]);
}

module tube_solid() {
  h = length / 2;
  translate([tube_at, 0, 0])
    rotate_extrude($fn = 48)
      polygon([[0, -h], [tube - bevel, -h], [tube, bevel - h], [tube, h - bevel], [tube - bevel, h], [0, h]]);
}

// Between ring and tube, lower than both.
module web() {
  linear_extrude(height = ring_height - 4, center = true)
    hull() {
      circle(r = 16);
      translate([tube_at, 0]) circle(r = tube - 1.5, $fn = 48);
    }
}

difference() {
  union() {
    ring_solid();
    for (i = [0:tubes - 1]) rotate(360 * i / tubes) {
      tube_solid();
      web();
    }
  }
  cylinder(r = ring[0], h = length, center = true);
  for (i = [0:tubes - 1])
    rotate(360 * i / tubes) translate([tube_at, 0, 0]) cylinder(r = hole, h = length + 2, center = true, $fn = 32);
}
