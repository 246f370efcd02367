// Plain block, no two of its sides alike.
cube([64, 42, 24], center = true);  // [mm]
