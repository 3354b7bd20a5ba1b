#!/usr/bin/env python3
"""Writes knot.ply, the sculpture of this scene: a tube about a (2, 3) torus knot, one unit high."""
import math
import struct

ALONG, AROUND, TUBE = 240, 16, 0.24


def add(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def knot(t):
    radius = 1.0 + 0.42 * math.cos(3 * t)
    return (radius * math.cos(2 * t), radius * math.sin(2 * t), 0.42 * math.sin(3 * t))


vertices, faces = [], []
for i in range(ALONG):
    t = 2 * math.pi * i / ALONG
    centre = knot(t)
    tangent = unit(add(knot(t + 1e-4), knot(t - 1e-4), -1))
    side = unit(cross(tangent, (math.cos(2 * t), math.sin(2 * t), 0)))
    up = cross(side, tangent)
    for j in range(AROUND):
        angle = 2 * math.pi * j / AROUND
        normal = tuple(math.cos(angle) * s + math.sin(angle) * u for s, u in zip(side, up))
        vertices.append((add(centre, normal, TUBE), normal))
        a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
        c, d = (a + AROUND) % (ALONG * AROUND), (b + AROUND) % (ALONG * AROUND)
        faces += [(a, b, d), (a, d, c)]

bottom = min(p[1] for p, _ in vertices)
height = max(p[1] for p, _ in vertices) - bottom
header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
header += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header\n"]
with open("knot.ply", "wb") as file:
    file.write("\n".join(header).encode())
    for p, n in vertices:
        file.write(struct.pack("<6f", p[0] / height, (p[1] - bottom) / height, p[2] / height, *n))
    for face in faces:
        file.write(struct.pack("<B3i", 3, *face))
