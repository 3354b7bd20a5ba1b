"""Tests of odis/dataset.py, run by ctest: `check_dataset.py ODIS` makes a small shard with that command and looks at
it; `check_dataset.py --golden FILE` reads the shard that tests/learn/test_python_reader.cpp writes. The reader is one
file that stands by itself, so it is tested in a clone, where the rest of the package is not built."""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "odis"))
from dataset import Shard, prefix, square_to_direction, texel_directions


def expect(condition, what):
    """As `assert`, which -O leaves out."""
    if not condition:
        raise SystemExit(f"failed: {what}")


def expect_unit(directions, what):
    expect(np.abs(np.linalg.norm(directions, axis=-1) - 1).max(initial=0) < 1e-12, f"{what} are of unit length")


def expect_refused(path, data, what):
    """That nothing is read of a file of these bytes."""
    path.write_bytes(data)
    try:
        shard = Shard(path)
        for name in shard.names():
            shard[name]
    except ValueError:
        return
    raise SystemExit(f"failed: {what} is found")


def test_map():
    """Equal areas of the square are equal solid angles: the mean of x x^T over all directions is 1/3."""
    directions = texel_directions(256).reshape(-1, 3)
    expect_unit(directions, "directions of texels")
    expect(np.abs(directions.mean(axis=0)).max() < 1e-12, "the mean direction is zero")
    moments = directions.T @ directions / len(directions)
    expect(np.abs(moments - np.eye(3) / 3).max() < 1e-4, "second moments are those of a sphere")
    # The middle is +z, the corners are -z; +x is on the right and +y in the last row.
    for square, direction in (((0.5, 0.5), (0, 0, 1)), ((0, 0), (0, 0, -1)), ((1, 0.5), (1, 0, 0)),
                              ((0.5, 1), (0, 1, 0)), ((0.75, 0.75), (0.5**0.5, 0.5**0.5, 0))):
        expect(np.allclose(square_to_direction(*square), direction, atol=1e-12), f"{square} is {direction}")


def test_pilot(shard, view, pilot, pixels):
    at = prefix(view, pilot)
    lengths = shard[at + "lengths"].astype(np.int64)
    expect(lengths.shape == (pixels,), "there is a path for every pixel")
    count = int(lengths.sum())
    for name in shard.names():
        if name.startswith(at) and name[len(at) :] not in ("lengths", "sampleWeight", "image", "wo"):
            expect(shard[name].shape[-1] == count, f"{name} has an element for every vertex")
    normal, wi, wo = (shard.directions(view, pilot, name) for name in ("normal", "wi", "wo"))
    for directions in (normal, wi, wo, shard.directions(view, pilot, "lightDirection")):
        expect_unit(directions, f"directions of {at}")
    # Walking from a vertex along wi for its distance leads to the next one of the path.
    position, distance = shard.positions(view, pilot), shard[at + "distance"].astype(np.float64)
    last = np.zeros(count, bool)
    last[(np.cumsum(lengths) - 1)[lengths > 0]] = True
    edge = shard.header["views"][view]["edge"]
    inner = np.flatnonzero(~last)
    expect(np.isfinite(distance[inner]).all(), "a path's distances are finite but for the last")
    arrived = position[inner] + wi[inner] * (distance[inner] * edge)[:, None]
    wrong = np.linalg.norm(arrived - position[inner + 1], axis=1) / edge
    # Half a step of the positions along each axis at either end, 2^-11 of the distance, 7e-5 of it sidewards, and
    # what rays start off a ground of 10^4 units by.
    bound = 2 * 3**0.5 / 2048 + distance[inner] * (2**-11 + 1e-4) + 64 * 2**-24 * 1e4 / edge
    expect((wrong <= bound).all(), f"paths of {at} are connected")
    # Shading normals are on wo's side.
    expect((np.einsum("ij,ij->i", normal, wo) > -1e-3).all(), "normals are on the side of wo")


def test_shard(odis, folder):
    subprocess.run([odis, "dataset", "generate", "--seeds", "3", "--quick", "-q", "-o", folder], check=True)
    path = next(folder.glob("*.shard"))
    shard = Shard(path)
    info = subprocess.run([odis, "dataset", "info", "--json", path], check=True, capture_output=True, text=True)
    expect(json.loads(info.stdout) == shard.header, "the header is what `odis dataset info --json` says")
    for name in shard.names():
        entry = shard.header["arrays"][name]
        expect(list(shard[name].shape) == entry["shape"] and shard[name].dtype.str == entry["type"], name)
    for view, about in enumerate(shard.header["views"]):
        pixels = about["width"] * about["height"]
        brightness = []
        for pilot in range(about["pilots"]):
            test_pilot(shard, view, pilot, pixels)
            image = shard[prefix(view, pilot) + "image"].astype(np.float64)
            brightness.append((np.array([0.212671, 0.715160, 0.072169]) @ image).mean())
        expect(abs(np.mean(brightness) - 1) < 1e-3, f"the mean luminance of view {view} is 1, found {brightness}")
        samples = shard[prefix(view) + "samples"]
        expect(samples.shape == (about["targets"], 32, 32), "there is a map for every target")
        expect((shard[prefix(view) + "indirect"][samples == 0] == 0).all(), "nothing is said without samples")
        expect_unit(shard.directions(view), "normals of targets")
    data = path.read_bytes()
    expect_refused(folder / "short", data[:-1], "a shard cut off")
    expect_refused(folder / "long", data + b"\0", "a byte too many")
    for at in (3, 8, 30, len(data) // 2, len(data) - 1):
        expect_refused(folder / "flipped", data[:at] + bytes([data[at] ^ 16]) + data[at + 1 :], f"a bit of byte {at}")


def test_golden(path):
    """Against the numbers that the writer in C++ began with."""
    shard = Shard(path)
    expected = shard.header["expected"]
    for name, values in expected["arrays"].items():
        array = shard[name]
        expect(array.shape == tuple(shard.header["arrays"][name]["shape"]), f"shape of {name}")
        expect(array.astype(np.float64).ravel().tolist() == values, f"{name}: found {array}, expected {values}")
    for name in ("normal", "wi", "wo"):
        found, wanted = shard.directions(0, 0, name), np.array(expected[name])
        expect(np.linalg.norm(found - wanted, axis=1).max() < 7e-5, f"{name}: found {found}, expected {wanted}")
    wrong = np.abs(shard.positions(0, 0) - np.array(expected["position"])).max()
    expect(wrong <= shard.header["views"][0]["edge"] / 2048 * 1.001, f"positions, off by {wrong}")


if __name__ == "__main__":
    if sys.argv[1] == "--golden":
        test_golden(sys.argv[2])
    else:
        test_map()
        with tempfile.TemporaryDirectory() as scratch:
            test_shard(sys.argv[1], pathlib.Path(scratch))
