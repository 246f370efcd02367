// Plain plate: all that tells how it lies is where it ends.
cube([72, 44, 8], center = true);  // [mm]
