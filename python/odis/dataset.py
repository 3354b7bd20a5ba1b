"""Reads shards of ODIS' data sets. What the arrays mean: docs/dataset-format.md. Needs numpy and zstandard.

    shard = Shard("000003-adversarial.shard")
    shard.header["views"][0]["unit"]      # what else there is to know, as parsed JSON
    shard["view0/pilot0/radiance"]        # an array of shape (3, vertices), in the view's unit of radiance
    shard.directions(0, 0, "wi")          # unit vectors, (vertices, 3)

`python3 -m odis.dataset FILE.shard` prints what is in it. This file stands by itself: without the rest of the package,
`python3 python/odis/dataset.py FILE.shard` does the same in a clone.
"""

import json
import struct
import sys
import zlib

try:
    import numpy as np
    import zstandard
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError(f'{missing.name} is missing, which odis.dataset needs: `pip install numpy zstandard` '
                              "installs it", name=missing.name) from None


class Shard:
    """One file: named arrays and a header. Raises ValueError for what is no shard, or a damaged one."""

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        if len(data) < 20 or data[:8] != b"ODISDATA":
            raise ValueError(f"{path}: is no shard, expected it to begin with ODISDATA")
        version, length, crc = struct.unpack_from("<III", data, 8)
        if version != 1:
            raise ValueError(f"{path}: found format {version}, expected 1")
        text = data[20 : 20 + length]
        if len(text) != length or zlib.crc32(text) != crc:
            raise ValueError(f"{path}: the header is damaged or cut off")
        self.header = json.loads(text)
        self._path, self._frames = path, data[20 + length :]
        ends = [array["offset"] + array["bytes"] for array in self.header["arrays"].values()]
        if max(ends, default=0) != len(self._frames):
            raise ValueError(f"{path}: found {len(self._frames)} bytes of arrays, expected {max(ends, default=0)}")

    def names(self):
        """The names of all arrays, in the order of the file."""
        return list(self.header["arrays"])

    def __getitem__(self, name):
        """The array of that name, in its shape. The file has the lowest bytes of all elements first, then the next."""
        entry = self.header["arrays"][name]
        dtype, shape = np.dtype(entry["type"]), tuple(entry["shape"])
        frame = self._frames[entry["offset"] : entry["offset"] + entry["bytes"]]
        size = int(np.prod(shape, dtype=object)) * dtype.itemsize
        try:
            if zstandard.frame_content_size(frame) != size:
                raise ValueError(f"{self._path}: {name}: is damaged: not of the size that its shape says")
            planes = zstandard.ZstdDecompressor().decompress(frame)
        except zstandard.ZstdError as error:
            raise ValueError(f"{self._path}: {name}: is damaged: {error}") from error
        elements = np.frombuffer(planes, np.uint8).reshape(dtype.itemsize, -1).T if size else np.empty(0)
        return np.frombuffer(elements.tobytes(), dtype).reshape(shape) if size else np.empty(shape, dtype)

    def positions(self, view, pilot=None):
        """World-space positions of a pilot's vertices, or of the view's targets: (count, 3), float64."""
        frame = self.header["views"][view]
        steps = self[prefix(view, pilot) + "position"].T
        return frame["origin"] + (steps + 0.5) * (frame["edge"] / 1024)

    def directions(self, view, pilot=None, name="normal"):
        """Unit vectors of an array of directions ("wi", "normal", "lightDirection"): (count, 3), float64. "wo" is of
        all vertices too: that of a path's first vertex is stored, later ones are minus the direction before."""
        if name != "wo":
            x, y = (self[prefix(view, pilot) + name] + 0.5) / 65536
            return square_to_direction(x, y)
        lengths = self[prefix(view, pilot) + "lengths"].astype(np.int64)
        first = (np.cumsum(lengths) - lengths)[lengths > 0]
        x, y = (self[prefix(view, pilot) + "wo"][:, lengths > 0] + 0.5) / 65536
        wo = -np.roll(self.directions(view, pilot, "wi"), 1, axis=0)
        wo[first] = square_to_direction(x, y)
        return wo


def prefix(view, pilot=None):
    """What the names of a pilot's arrays begin with, or those of the view's targets."""
    return f"view{view}/target/" if pilot is None else f"view{view}/pilot{pilot}/"


def square_to_direction(x, y):
    """Unit vectors of points of [0, 1]^2 in the equal-area octahedral map (Clarberg 2008): (..., 3), float64."""
    u, v = 2 * np.asarray(x, np.float64) - 1, 2 * np.asarray(y, np.float64) - 1
    d = 1 - (np.abs(u) + np.abs(v))  # signed distance to the diagonal that is the equator
    r = 1 - np.abs(d)
    phi = np.pi / 4 * ((np.abs(v) - np.abs(u)) / np.where(r == 0, 1, r) + 1)
    sine = r * np.sqrt(np.maximum(0, 2 - r * r))  # of the angle to the z axis
    z = np.copysign(1 - r * r, d)
    return np.stack([np.copysign(np.cos(phi), u) * sine, np.copysign(np.sin(phi), v) * sine, z], axis=-1)


def texel_directions(size=32):
    """Unit vectors of the middles of a map's texels, row by row: (size, size, 3), float64."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size
    return square_to_direction(x, y)


def main(path):
    shard = Shard(path)
    print(json.dumps({key: value for key, value in shard.header.items() if key not in ("arrays", "views")}, indent=1))
    for name in shard.names():
        array = shard[name].astype(np.float64)
        span = f"{np.min(array):12.5g} to {np.max(array):12.5g}" if array.size else ""
        print(f"{name:36} {shard.header['arrays'][name]['type']} {str(array.shape):20} {span}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python3 -m odis.dataset FILE.shard")
    try:
        main(sys.argv[1])
    except FileNotFoundError as error:
        sys.exit(f"error: {error.filename}: there is no such file")
    except (ValueError, OSError) as error:
        sys.exit(f"error: {error}")
