// V-belt pulley: a solid of revolution about z, hub longer on one side, so that only turning about z leaves it
// the same. A web between hub and rim, two belt grooves.

radius = 34;         // of the rim [mm]
bore = 7;            // radius of the shaft's hole [mm]
hub = 14;            // radius [mm]
hub_length = 34;     // from z = 0 [mm]
width = 24;          // of the rim, from z = 0 [mm]
web = [9, 15];       // from and to along z [mm]
rim = 5;             // thickness below a groove [mm]
groove = 7;          // depth [mm]
$fn = 84;

inner = radius - groove - rim;

rotate_extrude()
  polygon([
    [bore, 1], [bore + 1, 0], [hub, 0], [hub, web[0] - 1.5], [hub + 1.5, web[0]],
    [inner, web[0]], [inner, 0], [radius - 1, 0], [radius, 1],
    [radius, 2.5], [radius - groove, 5.5], [radius - groove, 8.5], [radius, 11.2],
    [radius, 12.8], [radius - groove, 15.5], [radius - groove, 18.5], [radius, 21.5],
    [radius, width - 1], [radius - 1, width], [inner, width], [inner, web[1]], [hub + 1.5, web[1]],
    [hub, web[1] + 1.5], [hub, hub_length - 1], [hub - 1, hub_length], [bore + 1, hub_length], [bore, hub_length - 1]]);
