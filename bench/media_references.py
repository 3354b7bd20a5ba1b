#!/usr/bin/env python3
"""Makes tests/integrator/data/media/references.json: what Mitsuba's volpathmis shows of the scenes beside it.

For each scene the means of 4 x 4 blocks of an image of 32 x 32 pixels, row by row, red, green and blue one after another,
and their standard errors, from several seeds. Needs the packages mitsuba and numpy.
"""

import argparse
import json
import pathlib
import re
import struct
import tempfile

import numpy as np

SCENES = pathlib.Path(__file__).resolve().parent.parent / "tests/integrator/data/media"
BLOCKS = 4


def block_density(salt, size):
    """The density of tests/integrator/media_scenes.h at every voxel: [size, size, size], by z, y, x."""
    step = 64 // size
    z, y, x = np.meshgrid(*[np.arange(0, 64, step)] * 3, indexing="ij")
    squared = sum((2 * i - 63.0) ** 2 for i in (x, y, z)) / (63.0 * 63.0)
    block = ((x // 8) * 73 ^ (y // 8) * 151 ^ (z // 8) * 283 ^ salt) & 15
    return np.maximum(1 - squared, 0) * (block / 15.0)


def flakes(size):
    """Parameters of microflakes (Sxx, Syy, Szz, Sxy, Sxz, Syz) of fibres along x."""
    return np.broadcast_to([0.0625, 1, 1, 0, 0, 0], (size, size, size, 6))


def write_volume(path, values):
    """Writes a volume of the shape [z, y, x, channel]."""
    sizes = values.shape[2], values.shape[1], values.shape[0], values.shape[3]
    header = b"VOL\x03" + struct.pack("<5i6f", 1, *sizes, 0, 0, 0, 1, 1, 1)
    path.write_bytes(header + values.astype("<f4").tobytes())


def block_means(image):
    height, width = image.shape[:2]
    cut = image.reshape(BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS, 3)
    return cut.mean(axis=(1, 3)).ravel()


def reference(mi, path, grids, spp, seeds):
    text = re.sub(r'integrator type="\w+"', 'integrator type="volpathmis"', path.read_text())
    scene = mi.load_string(text, **{name: str(file) for name, file in grids.items() if f"${name}" in text})
    images = [np.array(mi.render(scene, spp=spp, seed=seed))[:, :, :3] for seed in range(seeds)]
    blocks = np.array([block_means(np.asarray(image, dtype=np.float64)) for image in images])
    error = blocks.std(axis=0, ddof=1) / np.sqrt(seeds)
    return {"mean": [float(f"{x:.6g}") for x in blocks.mean(axis=0)], "error": [float(f"{x:.3g}") for x in error]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path, help="scene files; all beside the references")
    parser.add_argument("--spp", type=int, default=2048, help="samples per pixel of each image (%(default)s)")
    parser.add_argument("--seeds", type=int, default=8, help="number of images (%(default)s)")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba (%(default)s)")
    args = parser.parse_args()
    import mitsuba as mi

    mi.set_variant(args.variant)
    target = SCENES / "references.json"
    known = json.loads(target.read_text()) if target.exists() else {}
    with tempfile.TemporaryDirectory() as folder:
        grids = {name: pathlib.Path(folder) / f"{name}.vol" for name in ("grid", "color_grid", "flake_grid")}
        write_volume(grids["grid"], block_density(5, 64)[..., None])
        write_volume(grids["color_grid"], np.stack([block_density(salt, 16) for salt in (5, 9, 14)], axis=-1))
        write_volume(grids["flake_grid"], flakes(4))
        for path in args.scenes or sorted(SCENES.glob("*.xml")):
            known[path.stem] = reference(mi, path, grids, args.spp, args.seeds)
            lines = [f"{json.dumps(name)}: {json.dumps(entry)}" for name, entry in sorted(known.items())]
            target.write_text("{\n" + ",\n".join(lines) + "\n}\n")  # a line a scene
            print(path.stem, flush=True)


if __name__ == "__main__":
    main()
