// Star knob on a threaded stud: five lobes, a cone below them, a stud (rings without pitch). Turning it by 72
// degrees about z leaves it the same.

lobes = 5;
lobe_at = 20;        // axis to a lobe's centre [mm]
lobe = 8;            // radius of a lobe [mm]
head = 16;           // height of the lobes [mm]
neck = 10;           // height of the cone below them [mm]
stud = 6;            // radius [mm]
stud_length = 30;    // [mm]
rings = 9;
$fn = 36;

pitch = (stud_length - 4) / rings;

function ring(i) = let (z = 1.5 + i * pitch)
  [[stud, z], [stud - 1, z + 0.45 * pitch], [stud - 1, z + 0.55 * pitch], [stud, z + 0.95 * pitch]];

module star(grow) {
  offset(r = -5) offset(r = 5)
    union() {
      circle(r = 16 + grow);
      for (i = [0:lobes - 1]) rotate(360 * i / lobes) translate([lobe_at, 0]) circle(r = lobe + grow);
    }
}

module head_solid() {
  translate([0, 0, stud_length + neck]) {
    linear_extrude(height = 1.5, scale = 1.04) star(-1.2);
    translate([0, 0, 1.5]) linear_extrude(height = head - 4) star(0);
    translate([0, 0, head - 2.5]) linear_extrude(height = 2.5, scale = 0.9) star(0);
  }
}

module turned() {
  rotate_extrude()
    polygon(concat([[0, 0], [stud - 1.4, 0], [stud, 1.4]], [for (i = [0:rings - 1]) each ring(i)],
                   [[stud, stud_length], [10, stud_length], [15, stud_length + neck + 2], [0, stud_length + neck + 2]]));
}

union() {
  turned();
  head_solid();
}
