// Dowel: a plain rod along z, both ends chamfered and alike. As thick as the shank of clevis_pin and longer than it,
// so that the shank of a pin whose head is out of sight can be taken for a piece of it.

use <../fitting/rod.scad>

// Radius, length, and the chamfer of both ends along z and along the radius [mm].
plain_rod(radius = 7, length = 150, chamfer = [2, 1.2]);
