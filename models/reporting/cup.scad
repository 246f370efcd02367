// Drinking cup, hollow, upright along z on a foot ring, with a rounded lip and a handle towards +x. No rotation
// leaves it the same; the plane y = 0 is its mirror.

radius = 40;         // outside, at half height [mm]
height = 95;         // [mm]
wall = 3.6;          // thickness [mm]
bulge = 2;           // by which the body is slimmer at the lip, and so below [mm]
bottom = 6;          // z of the inside's floor [mm]
foot = [28, 2];      // radius of the hollow below, its height [mm]
round = 8;           // radius of the body's lower edge [mm]
handle = [27, 30];   // half width along x, half height along z, both to the middle of its section [mm]
handle_at = [36, 50];  // x, z of its middle [mm]
grip = [4.5, 7];     // half axes of its section, across the bow and along y [mm]
arc_steps = 5;       // of lip and lower edge
side_steps = 9;      // of the side
bow_steps = 24;      // of the handle's bow
grip_steps = 20;     // of its section
$fn = 60;

lip = wall / 2;      // radius [mm]
lip_at = [radius - bulge - lip, height - lip];

function arc(x, z, r, from, to) =
  [for (i = [0:arc_steps]) let (a = from + (to - from) * i / arc_steps) [x + r * cos(a), z + r * sin(a)]];

// The side between lower edge and lip, `inwards` of the outside.
function side(inwards) =
  [for (i = [1:side_steps - 1])
    let (u = 2 * i / side_steps - 1)
    [radius - inwards - bulge * u * u, height / 2 + u * (height / 2 - round)]];

module outside() {
  rotate_extrude()
    polygon(concat([[0, foot[1]], [foot[0] - 1, foot[1]], [foot[0], 0]],
                   arc(radius - bulge - round, round, round, -90, 0), side(0), arc(lip_at[0], lip_at[1], lip, 0, 90),
                   [[0, height]]));
}

// Its upper end is the lip's inner half.
module inside() {
  corner = round - 1;
  rotate_extrude()
    polygon(concat([[0, bottom]],
                   arc(radius - bulge - wall - corner, bottom + corner, corner, -90, 0), side(wall),
                   arc(lip_at[0], lip_at[1], lip, 180, 90), [[lip_at[0], height + 1], [0, height + 1]]));
}

// Half an ellipse bent from the wall and back; its ends lie in the wall or inside, where they are cut off.
module handle_solid() {
  points = [for (s = [0:bow_steps])
    let (a = -100 + 200 * s / bow_steps, c = [handle[0] * cos(a), handle[1] * sin(a)],
         n = [handle[1] * cos(a), handle[0] * sin(a)], u = n / norm(n))
    for (i = [0:grip_steps - 1])
      let (b = 360 * i / grip_steps, d = grip[0] * cos(b))
      [handle_at[0] + c[0] + d * u[0], grip[1] * sin(b), handle_at[1] + c[1] + d * u[1]]];
  sides = [for (s = [0:bow_steps - 1], i = [0:grip_steps - 1])
    let (j = (i + 1) % grip_steps)
    [s * grip_steps + i, s * grip_steps + j, (s + 1) * grip_steps + j, (s + 1) * grip_steps + i]];
  ends = [[for (i = [grip_steps - 1:-1:0]) i], [for (i = [0:grip_steps - 1]) bow_steps * grip_steps + i]];
  polyhedron(points, concat(sides, ends));
}

difference() {
  union() {
    outside();
    handle_solid();
  }
  inside();
}
