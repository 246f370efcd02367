// Clevis pin: a head, a shank along z, a hole for the split pin across it near the tip. Turning it by 180 degrees
// about z leaves it the same.

shank = 7;           // radius [mm]
length = 70;         // with the head [mm]
head = 11;           // radius [mm]
head_height = 6;     // [mm]
hole = 2.25;         // radius of the cross hole [mm]
hole_at = 62;        // z of its axis [mm]
chamfer = [2, 1.2];  // of the tip, along z, along the radius [mm]
edge = 0.8;          // chamfer of the head's edges [mm]
$fn = 64;

module turned() {
  rotate_extrude()
    polygon([[0, 0], [head - edge, 0], [head, edge], [head, head_height - edge], [head - edge, head_height],
             [shank, head_height], [shank, length - chamfer[0]], [shank - chamfer[1], length], [0, length]]);
}

difference() {
  turned();
  translate([0, 0, hole_at]) rotate([90, 0, 0]) cylinder(r = hole, h = 2 * shank + 2, center = true, $fn = 32);
}
