#!/usr/bin/env python3
"""Turns an OFF mesh into a binary PLY, or fails: the mesh must be closed, with its faces outwards.

usage: off_to_ply.py in.off out.ply [--max-edge MM]

Edges longer than --max-edge are halved until none is left, so that vertices spread over the whole part.
"""

import argparse
import collections
import math
import os
import struct
import sys


def read_off(path):
    with open(path, encoding="ascii") as file:
        words = iter(file.read().split())
    if next(words) != "OFF":
        sys.exit(f"{path}: not an OFF file")
    vertex_count, face_count, _ = (int(next(words)) for _ in range(3))
    vertices = [tuple(float(next(words)) for _ in range(3)) for _ in range(vertex_count)]
    triangles = []
    for _ in range(face_count):
        corners = [int(next(words)) for _ in range(int(next(words)))]
        triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
    return vertices, triangles


def welded(vertices, triangles):
    """One vertex for each place, as written; triangles that lose a corner by that are dropped."""
    index = {}
    new = [index.setdefault(vertex, len(index)) for vertex in vertices]
    triangles = [tuple(new[i] for i in triangle) for triangle in triangles]
    return list(index), [t for t in triangles if len(set(t)) == 3]


def check(vertices, triangles, path):
    """Closed: each directed edge once, and its reverse once. Outwards: positive volume."""
    edges = collections.Counter(e for a, b, c in triangles for e in ((a, b), (b, c), (c, a)))
    bad = [e for e, n in edges.items() if n != 1 or edges.get((e[1], e[0])) != 1]
    if bad:
        sys.exit(f"{path}: not closed: {len(bad)} edges without exactly one neighbour, e.g. at {vertices[bad[0][0]]}")
    volume = sum(
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        for a, b, c in ((vertices[i], vertices[j], vertices[k]) for i, j, k in triangles)
    ) / 6
    if volume <= 0:
        sys.exit(f"{path}: faces point inwards (volume {volume:.1f} mm^3)")
    return volume


def split_long_edges(vertices, triangles, max_edge):
    """Halves the longest too long edge of each triangle, on both of its sides, until none is left."""
    vertices = list(vertices)
    middles = {}

    def length(edge):
        return math.dist(vertices[edge[0]], vertices[edge[1]])

    def middle(edge):
        key = (min(edge), max(edge))
        if key not in middles:
            middles[key] = len(vertices)
            vertices.append(tuple((p + q) / 2 for p, q in zip(vertices[edge[0]], vertices[edge[1]])))
        return middles[key]

    while True:
        marked = set()
        for a, b, c in triangles:
            longest = max(((a, b), (b, c), (c, a)), key=lambda e: (length(e), min(e), max(e)))
            if length(longest) > max_edge:
                marked.add((min(longest), max(longest)))
        if not marked:
            return vertices, triangles
        queue, done = list(triangles), []
        while queue:
            triangle = queue.pop()
            for k in range(3):
                a, b, c = triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]
                if (min(a, b), max(a, b)) in marked:
                    m = middle((a, b))
                    queue += [(a, m, c), (m, b, c)]
                    break
            else:
                done.append(triangle)
        triangles = done


def write_ply(path, vertices, triangles):
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment millimetres\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    beside = f"{path}.{os.getpid()}.part"
    with open(beside, "wb") as file:
        file.write(header.encode("ascii"))
        for vertex in vertices:
            file.write(struct.pack("<3f", *vertex))
        for triangle in triangles:
            file.write(struct.pack("<B3i", 3, *triangle))
    os.replace(beside, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("--max-edge", type=float, default=0.0, help="[mm], 0 keeps all edges")
    options = parser.parse_args()
    vertices, triangles = welded(*read_off(options.source))
    check(vertices, triangles, options.source)
    if options.max_edge > 0:
        vertices, triangles = split_long_edges(vertices, triangles, options.max_edge)
    volume = check(vertices, triangles, options.target)
    write_ply(options.target, vertices, triangles)
    size = [max(v[k] for v in vertices) - min(v[k] for v in vertices) for k in range(3)]
    print(
        f"{os.path.basename(options.target)}: {len(triangles)} triangles, {len(vertices)} vertices, closed, "
        f"{size[0]:.1f} x {size[1]:.1f} x {size[2]:.1f} mm, {volume / 1000:.1f} cm^3"
    )


main()
