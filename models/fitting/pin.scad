// Headed pin: a solid of revolution about z, the head's face at z = 0. Only turning about z leaves it the same.

shank = 6;           // radius [mm]
length = 60;         // with the head [mm]
head = 9;            // radius [mm]
head_height = 4;     // [mm]
chamfer = 0.8;       // of the tip [mm]
edge = 0.6;          // chamfer of the head's edges [mm]
$fn = 72;

rotate_extrude()
  polygon([[0, 0], [head - edge, 0], [head, edge], [head, head_height - edge], [head - edge, head_height],
           [shank, head_height], [shank, length - chamfer], [shank - chamfer, length], [0, length]]);
