#!/usr/bin/env python3
"""Writes the grids of densities that scenes in this folder name, cloud.vol and smoke.vol, beside itself: make_grids.py

Sums of smooth noise of five octaves, from 0 to 1 at 96 x 96 x 96 voxels. Needs the package numpy.
"""

import pathlib
import struct

import numpy as np

SIZE = 96


def lattice(i, j, k, salt):
    """Numbers in [0, 1) that look random, one for each point with whole coordinates."""
    x = i * 73856093 ^ j * 19349663 ^ k * 83492791 ^ salt * 2654435761
    for factor in (0x9E3779B1, 0x85EBCA6B):
        x = (x ^ x >> 15) * factor & 0xFFFFFFFF
    return (x ^ x >> 16) / 2.0**32


def noise(x, y, z, salt):
    """Value noise, smoothly interpolated, in [0, 1)."""
    cell = [np.floor(a).astype(np.int64) for a in (x, y, z)]
    t = [a - c for a, c in zip((x, y, z), cell)]
    t = [a * a * (3 - 2 * a) for a in t]
    total = 0.0
    for corner in np.ndindex(2, 2, 2):
        weight = np.prod([a if c else 1 - a for a, c in zip(t, corner)], axis=0)
        total = total + weight * lattice(*[a + c for a, c in zip(cell, corner)], salt)
    return total


def octaves(x, y, z, frequency, salt):
    return sum(noise(x * frequency * 2**o, y * frequency * 2**o, z * frequency * 2**o, salt + o) / 2**o
               for o in range(5)) / (2 - 2.0**-4)


def cloud(x, y, z):
    """Five balls that grow together on a flat base, with noise at their surface."""
    depth = np.full_like(x, -1.0)
    for cx, cy, cz, radius in ((.5, .42, .5, .26), (.28, .36, .52, .17), (.73, .37, .46, .18), (.42, .57, .6, .18),
                               (.6, .5, .3, .16)):
        distance = np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2)
        depth = np.maximum(depth, 1 - distance / radius)
    base = np.clip((y - 0.22) / 0.05, 0, 1)
    return np.clip(3 * (depth + 1.3 * (octaves(x, y, z, 6, 11) - 0.5)), 0, 1) * base


def smoke(x, y, z):
    """A plume that widens and sways on its way up."""
    turn = 0.06 * y * np.sin(9 * y) / 0.5
    radius = 0.07 + 0.27 * y
    distance = np.hypot(x - 0.5 - turn, z - 0.5 - 0.05 * y * np.cos(7 * y)) / radius
    swirl = octaves(x, 0.7 * y, z, 5, 29)
    density = np.clip(1.2 - distance + 2.2 * (swirl - 0.5), 0, 1) * (1 - 0.75 * y)
    return density * np.clip((1 - y) / 0.15, 0, 1) * np.clip(y / 0.02, 0, 1)


def write(path, values):
    """Writes values of the shape [z, y, x] as docs/media.md has it."""
    header = b"VOL\x03" + struct.pack("<5i6f", 1, *values.shape[::-1], 1, 0, 0, 0, 1, 1, 1)
    path.write_bytes(header + values.astype("<f4").tobytes())


def main():
    at = (np.arange(SIZE) + 0.5) / SIZE
    z, y, x = np.meshgrid(at, at, at, indexing="ij")
    folder = pathlib.Path(__file__).resolve().parent
    for density in (cloud, smoke):
        write(folder / f"{density.__name__}.vol", density(x, y, z))


if __name__ == "__main__":
    main()
