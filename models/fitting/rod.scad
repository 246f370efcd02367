// Plain rod along z, a solid of revolution whose ends are alike. One closed polyhedron of rings of points, at most
// 10 mm from each other: a boolean operation would leave none between the ends.

module plain_rod(radius, length, chamfer, steps = 96) {
  rings = ceil((length - 2 * chamfer[0]) / 10);
  profile = concat([[radius - chamfer[1], 0]],
                   [for (i = [0:rings]) [radius, chamfer[0] + (length - 2 * chamfer[0]) * i / rings]],
                   [[radius - chamfer[1], length]]);
  last = len(profile) - 1;
  points = concat([for (p = profile, i = [0:steps - 1]) let (a = 360 * i / steps) [p[0] * cos(a), p[0] * sin(a), p[1]]],
                  [[0, 0, 0], [0, 0, length]]);
  first_end = len(points) - 2;
  faces = [for (r = [-1:last], i = [0:steps - 1])
    let (j = (i + 1) % steps)
    r < 0 ? [first_end, i, j]
    : r == last ? [last * steps + i, first_end + 1, last * steps + j]
    : [r * steps + i, (r + 1) * steps + i, (r + 1) * steps + j, r * steps + j]];
  polyhedron(points, faces);
}

// Radius, length, and the chamfer of both ends along z and along the radius [mm].
plain_rod(radius = 6, length = 160, chamfer = [0.8, 0.8]);
