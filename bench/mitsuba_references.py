"""References for bench/beside_mitsuba.py: images by Mitsuba's `path` with many samples, each with the reconstruction
filter that its file names. An EXR file's attribute `reference` says how it was made, as JSON; it is used again where
that fits.
"""
import hashlib
import json
import os
import sys
import time

import mitsuba as mi
import numpy as np
from in_mitsuba import REFERENCE_SEED, SETTINGS, name_of
from relative_error import trimmed_relative_error

ATTRIBUTE = "reference"
PATHS_AT_ONCE = 1 << 22  # in a batch of samples of all pixels; some 1 GB of memory


def reference_of(scene, path, args):
    """The name of the EXR file with the reference of a scene in args.references, which is made where none fits."""
    file = os.path.join(args.references, f"{name_of(path)}.exr")
    wanted = _conditions(scene, path)
    made = how_made(file)
    if made is None or made["spp"] < args.reference_spp or any(made.get(key) != wanted[key] for key in wanted):
        begin = time.perf_counter()
        image, made = _render(scene, args.reference_spp)
        os.makedirs(args.references, exist_ok=True)
        _write(file, image, wanted | made | {"mitsuba": mi.__version__, "variant": mi.variant()})
        print(f"{file}: {made['spp']} samples in {time.perf_counter() - begin:.0f} s, its own error is "
              f"{made['own error']:.2g}", file=sys.stderr, flush=True)
    return file


def _conditions(scene, path):
    """Says which image it is, apart from its noise."""
    film = scene.sensors()[0].film()
    with open(path, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()
    return {"scene file": digest, "size": [int(size) for size in film.crop_size()], "filter": str(film.rfilter()),
            **SETTINGS}


def how_made(file):
    """What the attribute says; None where there is no such file or attribute."""
    if not os.path.exists(file):
        return None
    metadata = mi.Bitmap(file).metadata()
    return json.loads(metadata[ATTRIBUTE]) if ATTRIBUTE in metadata else None


def _render(scene, spp):
    """The image; and its samples, seeds and the trimmed relMSE that it has itself, from the difference of its halves.

    Filtered radiance and filter weights are summed over all batches before one is divided by the other: quotients of
    few samples would be biased."""
    size = scene.sensors()[0].film().crop_size()
    batch = max(1, min(spp // 2, PATHS_AT_ONCE // (size[0] * size[1])))
    batches = -(-spp // batch)
    halves = [0.0, 0.0]
    for i in range(batches):
        halves[i % 2] += _sums(scene, batch, REFERENCE_SEED + i)
    image, first, second = (sums[..., :3] / sums[..., -1:] for sums in (sum(halves), *halves))
    return image, {"spp": batch * batches, "spp of a batch": batch, "first seed": REFERENCE_SEED,
                   "own error": trimmed_relative_error(first, second) / 4}


def _sums(scene, spp, seed):
    """The sums of filtered radiance of each pixel, and, as the last channel, those of filter weights."""
    sensor = scene.sensors()[0]
    mi.load_dict({"type": "path", **SETTINGS}).render(scene, sensor, seed=seed, spp=spp, develop=False)
    return np.array(sensor.film().develop(raw=True), np.float64)


def _write(file, image, made):
    bitmap = mi.Bitmap(image.astype(np.float32))
    bitmap.metadata()[ATTRIBUTE] = json.dumps(made)
    bitmap.write(f"{file}.part.exr")
    os.replace(f"{file}.part.exr", file)
