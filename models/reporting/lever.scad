// Lever: a hub with a clamping slit at one end, a fork with a pin's hole at the other, a web with a pocket on one
// side between them. No symmetry.

reach = 66;          // hub's axis to the pin's axis [mm]
hub = 15;            // radius [mm]
hub_height = 26;     // from z = 0 [mm]
bore = 8;            // radius [mm]
fork_width = 22;     // over both cheeks, along z [mm]
cheek = 5.5;         // thickness of a cheek [mm]
fork = 10;           // radius around the pin [mm]
pin = 4;             // radius [mm]
$fn = 56;

fork_base = 2;       // z where the fork begins [mm]

module body() {
  cylinder(r = hub, h = hub_height);
  translate([0, 0, fork_base + 4])
    linear_extrude(height = fork_width - 8)
      hull() {
        circle(r = 10);
        translate([reach - 20, 0]) circle(r = 7.5);
      }
  translate([0, 0, fork_base])
    linear_extrude(height = fork_width)
      hull() {
        translate([reach - 20, 0]) circle(r = 8);
        translate([reach, 0]) circle(r = fork);
      }
  // Clamp screw's ears beside the slit.
  translate([-hub - 9, -8, 5]) cube([14, 16, hub_height - 10]);
}

module cuts() {
  translate([0, 0, -1]) cylinder(r = bore, h = hub_height + 2);
  translate([-hub - 10, -1.5, -1]) cube([hub + 10, 3, hub_height + 2]);
  translate([-hub - 4, 15, hub_height / 2]) rotate([90, 0, 0]) cylinder(r = 3, h = 30, $fn = 24);
  translate([reach - 14, -fork - 1, fork_base + cheek]) cube([30, 2 * fork + 2, fork_width - 2 * cheek]);
  translate([reach, 0, -1]) cylinder(r = pin, h = fork_width + 4);
  translate([0, 0, fork_base + fork_width - 7])
    linear_extrude(height = 10)
      hull() {
        translate([hub + 7, 0]) circle(r = 4.5);
        translate([reach - 31, 0]) circle(r = 3.5);
      }
}

difference() {
  body();
  cuts();
}
