// 90-degree pipe elbow with a socket at each end.
// One ring of points is swept along leg, bend and leg: outside first, then back along the bore, so that
// the body is one closed polyhedron without any boolean operation.
// The bend's corner lies at the origin; the openings look along +x and +y.

outer_radius = 15;   // pipe [mm]
bore_radius = 12;    // pipe [mm]
socket_radius = 19;  // outside of a socket [mm]
seat_radius = 15.2;  // inside of a socket: takes the next pipe [mm]
socket_length = 19;  // [mm]
seat_depth = 16;     // [mm]
bend_radius = 28;    // of the pipe's axis [mm]
leg = 35;            // from the bend to the socket's face [mm]
bevel = 1.2;         // [mm]
ring_steps = 60;     // points of a ring
bend_steps = 18;     // rings of the bend

arc = bend_radius * PI / 2;
length = 2 * leg + arc;

// Profile of one half, [distance from the face along the axis, radius].
outside = [[0, socket_radius - bevel], [bevel, socket_radius], [socket_length / 2, socket_radius],
           [socket_length - 2 * bevel, socket_radius], [socket_length, outer_radius + 0.6],
           [socket_length + 1.5, outer_radius], [leg - 6, outer_radius]];
inside = [[0, seat_radius + bevel], [bevel, seat_radius], [seat_depth / 2, seat_radius],
          [seat_depth, seat_radius], [seat_depth, bore_radius], [leg - 9, bore_radius]];

function mirrored(profile) = [for (i = [len(profile) - 1:-1:0]) [length - profile[i][0], profile[i][1]]];
function bend(radius) = [for (i = [0:bend_steps]) [leg + arc * i / bend_steps, radius]];
function backwards(list) = [for (i = [len(list) - 1:-1:0]) list[i]];

stations = concat(outside, bend(outer_radius), mirrored(outside),
                  backwards(concat(inside, bend(bore_radius), mirrored(inside))));

// Corner of the two legs at [bend_radius, bend_radius] from the bend's centre; it becomes the origin.
function axis(s) =
    s < leg ? [leg - s + bend_radius, 0, 90]
  : s > length - leg ? [0, s - (length - leg) + bend_radius, 0]
  : let (a = 90 * (s - leg) / arc) [bend_radius * (1 - sin(a)), bend_radius * (1 - cos(a)), 90 - a];

function ring(station) =
  let (c = axis(station[0]))
  [for (i = [0:ring_steps - 1])
    let (a = 360 * i / ring_steps, side = station[1] * cos(a))
    [c[0] + side * cos(c[2]), c[1] + side * sin(c[2]), station[1] * sin(a)]];

rings = len(stations);
points = [for (s = stations) each ring(s)];
faces = [for (r = [0:rings - 1], i = [0:ring_steps - 1])
  let (j = (i + 1) % ring_steps, q = (r + 1) % rings)
  [r * ring_steps + i, r * ring_steps + j, q * ring_steps + j, q * ring_steps + i]];

polyhedron(points, faces);
