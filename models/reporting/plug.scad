// Screw plug with a wing: threaded shank (rings without pitch), collar, two wings to turn it by. Turning it by 180
// degrees about z leaves it the same.

shank = 13;          // radius of the thread's crests [mm]
root = 11.4;         // radius of its roots [mm]
shank_length = 24;   // [mm]
rings = 6;
collar = 20;         // radius [mm]
collar_height = 8;   // [mm]
wing = [56, 8, 22];  // span, thickness, height [mm]
bore = 6;            // radius of the blind hole in the shank [mm]
$fn = 60;

pitch = (shank_length - 5) / rings;

function ring(i) = let (z = 2.5 + i * pitch)
  [[shank, z], [root, z + 0.45 * pitch], [root, z + 0.6 * pitch], [shank, z + 0.95 * pitch]];

module turned() {
  rotate_extrude()
    polygon(concat([[bore, 0], [shank - 2, 0], [shank, 2]], [for (i = [0:rings - 1]) each ring(i)],
                   [[root, shank_length - 2], [root, shank_length], [collar - 1, shank_length], [collar, shank_length + 1],
                    [collar, shank_length + collar_height - 1], [collar - 1, shank_length + collar_height],
                    [0, shank_length + collar_height], [0, 16], [bore, 16]]));
}

module wings() {
  translate([0, wing[1] / 2, shank_length + collar_height - 1])
    rotate([90, 0, 0])
      linear_extrude(height = wing[1])
        difference() {
          hull() {
            translate([-collar + 3, 0]) square([2 * collar - 6, 1]);
            for (x = [-1, 1]) translate([x * (wing[0] / 2 - 8), wing[2] - 7]) circle(r = 8);
          }
          translate([0, wing[2] + 8]) circle(r = 17);
        }
}

union() {
  turned();
  wings();
}
