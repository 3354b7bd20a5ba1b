#!/usr/bin/env python3
"""Tests the programs of examples/film: what they render is the same image, and has the expectation of unguided paths.

    examples/film/test_film.py BUILD FOLDER

BUILD holds the programs, images are written to FOLDER. The z-test of means over many seeds has a significance of 1 %
over all of them together (Šidák); seeds are fixed. Needs numpy.
"""
import concurrent.futures
import math
import os
import pathlib
import subprocess
import sys

import numpy as np

LAYERS = ["color", "albedo", "normal", "light0", "light1"]
WIDTH, HEIGHT, SEEDS = 80, 48, 32
BUILD, FOLDER = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()


def render(program, name, **options):
    """[layer] an image of HEIGHT x WIDTH pixels."""
    command = [BUILD / f"film_{program}", "--width", WIDTH, "--height", HEIGHT, "--spp", 8, "-o", FOLDER / name]
    for option, value in options.items():
        command += [f"--{option}", value]
    subprocess.run([str(part) for part in command], check=True)
    files = {layer: FOLDER / f"{name}-{layer}.pfm" for layer in LAYERS}
    return {layer: np.frombuffer(file.read_bytes().split(b"\n", 3)[3], "<f4").reshape(-1, WIDTH, 3).astype(float)
            for layer, file in files.items()}


def require(holds, what):
    print(("ok: " if holds else "FAILED: ") + what)
    return holds


def near(a, b):
    return all(np.allclose(a[layer], b[layer], rtol=1e-3, atol=1e-4) for layer in LAYERS)


def same(a, b):
    return all(np.array_equal(a[layer], b[layer]) for layer in LAYERS)


def z_scores():
    """Of the means of blocks of 16 x 16 pixels of three layers, guided against unguided."""
    def blocks(seed, guided):
        image = render("splat", f"{guided}-{seed}", seed=seed, guided=guided, threads=1, spp=8 if guided else 32)
        stack = np.stack([image[layer] for layer in ("color", "light0", "light1")])
        return stack.reshape(3, HEIGHT // 16, 16, WIDTH // 16, 16, 3).mean(axis=(2, 4, 5)).ravel()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        sides = [np.array(list(pool.map(lambda seed, g=guided: blocks(seed + SEEDS * g, g), range(SEEDS))))
                 for guided in (0, 1)]
    means, variances = zip(*((s.mean(axis=0), s.var(axis=0, ddof=1) / SEEDS) for s in sides))
    return (means[1] - means[0]) / np.sqrt(variances[0] + variances[1])


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    saved = FOLDER / "saved"
    saved.unlink(missing_ok=True)
    splat = render("splat", "splat", threads=2)
    whole = render("progressive", "whole")
    for _ in range(20):
        parts = render("progressive", "parts", save=saved, passes=1)
    results = [
        require(same(splat, render("splat", "splat-1", threads=1)), "the bits do not depend on the threads"),
        require(near(splat, render("buckets", "buckets", threads=2)), "buckets render the same image"),
        require(np.allclose(splat["light0"] + splat["light1"], splat["color"], rtol=1e-3, atol=1e-4),
                "groups of lights add up"),
        require(same(whole, parts), "a rendering that ended goes on with the same bits"),
        require(same(render("progressive", "more", spp=16), render("progressive", "parts", save=saved, spp=16)),
                "it goes on to more samples than it was begun for"),
    ]
    scores = z_scores()
    significance = 1 - 0.99 ** (1 / len(scores))
    results.append(require(math.erfc(abs(scores).max() / math.sqrt(2)) > significance,
                           f"guided images have the expectation of unguided ones: greatest |z| {abs(scores).max():.2f}"))
    sys.exit(not all(results))


if __name__ == "__main__":
    main()
