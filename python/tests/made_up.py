"""Path vertices that no renderer traced: a floor of [0, 1]^2 under a small bright patch, and what else a guide learns
from."""

import pathlib
import subprocess

import numpy as np

BRIGHT = np.array([0.6, 0, 0.8], np.float32)
LIGHT_GROUPS = 3


def cosine_directions(random, count):
    """Directions around +z with the density cos / pi."""
    radius, phi = np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
    z = np.sqrt(1 - radius * radius)
    return np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1).astype(np.float32)


def vertices(count, seed=1):
    """The fields of `count` vertices, by name."""
    random = np.random.default_rng(seed)
    up = np.tile(np.array([0, 0, 1], np.float32), (count, 1))
    wi = cosine_directions(random, count)
    position = np.concatenate([random.random((count, 2)), np.zeros((count, 1))], axis=1).astype(np.float32)
    radiance = np.where(wi @ BRIGHT > 0.97, 100, 0.1).astype(np.float32)
    gray = np.repeat(radiance[:, None], 3, axis=1)
    group = random.integers(0, LIGHT_GROUPS, count, np.uint32)
    return {
        "position": position,
        "normal": up,
        "wo": up,
        "wi": wi,
        "radiance": gray,
        "weight": np.full((count, 3), 0.5, np.float32),
        "direct": np.repeat(group.astype(np.float32)[:, None], 3, axis=1),
        "pdf": wi[:, 2] / np.float32(np.pi),
        "guidable_pdf": wi[:, 2] / np.float32(np.pi),
        "guidable_probability": np.ones(count, np.float32),
        "roughness": random.random(count, np.float32),
        "indirect": radiance / 4,
        "emission": np.zeros(count, np.float32),
        "light": np.zeros(count, np.float32),
        "rays_after": np.full(count, 3, np.float32),
        "light_group": group,
        "light_group_probability": np.full(count, 1 / LIGHT_GROUPS, np.float32),
        "pixel": np.arange(count, dtype=np.uint32),
        "depth": np.ones(count, np.uint16),
        "discrete": np.zeros(count, bool),
    }


def guide_bytes(guide):
    """All that a guide holds, as python/tests/guide_of_files.cpp writes it."""
    decisions = [guide.bsdf_fractions, guide.survival_factors[:, None], guide.outgoing_radiance,
                 guide.learned_light_fractions[:, None]]
    arrays = [guide.cell_keys, guide.maps, np.concatenate(decisions, axis=1)]
    if guide.light_groups > 0:
        arrays.append(guide.light_tables)
    return b"".join(array.tobytes() for array in arrays)


class InCpp:
    """The program guide_of_files on the vertices `fields`, which it finds in the empty `folder`."""

    def __init__(self, program, folder, fields, threads):
        self._folder = pathlib.Path(folder)
        for name, array in fields.items():
            first, *others = name.split("_")
            array.tofile(self._folder / (first + "".join(word.capitalize() for word in others) + ".bin"))
        command = [program, folder, str(threads), str(LIGHT_GROUPS)]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def build(self):
        """Builds a guide; returns the seconds that it took, by the clock and of all threads' work."""
        self._process.stdin.write("\n")
        self._process.stdin.flush()
        return tuple(float(seconds) for seconds in self._process.stdout.readline().split())

    def guide_bytes(self):
        """Ends the program and returns the bytes of its last guide."""
        self._process.communicate()
        return (self._folder / "guide").read_bytes()
