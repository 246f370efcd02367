// Hexagon bolt, axis along z, tip at z = 0. The thread is a row of rings without pitch, so that the part
// has exactly the six-fold symmetry of its head.

diameter = 16;      // of the thread's crests [mm]
core = 13.4;        // of its roots [mm]
pitch = 2.5;        // from ring to ring [mm]
rings = 14;
length = 50;        // tip to the head's seat [mm]
flats = 24;         // width of the head across flats [mm]
head = 10;          // height of the head [mm]
washer = 22.5;      // diameter of the seat's washer face [mm]
chamfer = 1.8;      // of the tip [mm]
$fn = 60;

function groove(i) =
  let (z = chamfer + 0.4 + i * pitch)
  [[diameter / 2, z], [core / 2, z + 0.42 * pitch], [core / 2, z + 0.58 * pitch], [diameter / 2, z + 0.95 * pitch]];

module shank() {
  rotate_extrude()
    polygon(concat([[0, 0], [diameter / 2 - chamfer, 0], [diameter / 2, chamfer]],
                   [for (i = [0:rings - 1]) each groove(i)],
                   [[diameter / 2, length - 1], [diameter / 2 + 0.8, length], [diameter / 2 + 0.8, length + 2],
                    [0, length + 2]]));
}

// Corners cut at 30 degrees on top, washer face below.
module head_turned() {
  corner = flats / sqrt(3);
  rotate_extrude($fn = 90)
    polygon([[0, 0], [washer / 2, 0], [washer / 2, 0.6], [corner + 1, 0.6],
             [corner + 1, head - (corner + 1 - flats / 2 + 0.4) * tan(30)], [flats / 2 - 0.4, head], [0, head]]);
}

union() {
  shank();
  translate([0, 0, length])
    intersection() {
      linear_extrude(height = head) circle(d = flats / cos(30), $fn = 6);
      head_turned();
    }
}
