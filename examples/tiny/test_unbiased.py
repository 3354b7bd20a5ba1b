#!/usr/bin/env python3
"""Tests that tiny_odis has the expectation of tiny, by a z-test of the means over many seeds.

    examples/tiny/test_unbiased.py BUILD FOLDER

Means are taken of the image and of each of 4 x 3 blocks of it, in each scene. The significance is 1 % over all of them
together (Šidák); seeds are fixed. BUILD holds both programs, images are written to FOLDER. Needs numpy.
"""
import concurrent.futures
import math
import os
import pathlib
import subprocess
import sys

import numpy as np

SCENES = ["door", "lamp", "sun"]
WIDTH, HEIGHT, COLUMNS, ROWS, SEEDS = 32, 18, 4, 3, 48
# tiny has more samples, which are cheap, so that tiny_odis decides how small a bias is seen.
SAMPLES = {"tiny": 32, "tiny_odis": 8}
SIGNIFICANCE = 1 - 0.99 ** (1 / (len(SCENES) * (COLUMNS * ROWS + 1)))


def render(build, folder, program, scene, seed):
    """The means of the image's blocks, and of all of it."""
    output = folder / f"{program}-{scene}-{seed}.pfm"
    subprocess.run([build / program, "--scene", scene, "--spp", str(SAMPLES[program]), "--seed", str(seed), "--threads",
                    "1", "--width", str(WIDTH), "--height", str(HEIGHT), "-o", output], check=True,
                   stdout=subprocess.DEVNULL)
    image = np.frombuffer(output.read_bytes().split(b"\n", 3)[3], "<f4").reshape(HEIGHT, WIDTH, 3).astype(float)
    output.unlink()
    blocks = image.reshape(ROWS, HEIGHT // ROWS, COLUMNS, WIDTH // COLUMNS, 3).mean(axis=(1, 3, 4))
    return np.append(blocks.ravel(), image.mean())


def main():
    build, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for scene in SCENES:
            means, variances = {}, {}
            for number, program in enumerate(SAMPLES):
                seeds = range(number * SEEDS, (number + 1) * SEEDS)
                values = np.array(list(pool.map(lambda seed: render(build, folder, program, scene, seed), seeds)))
                means[program], variances[program] = values.mean(axis=0), values.var(axis=0, ddof=1) / SEEDS
            z = (means["tiny_odis"] - means["tiny"]) / np.sqrt(variances["tiny_odis"] + variances["tiny"])
            for i, value in enumerate(z):
                if math.erfc(abs(value) / math.sqrt(2)) < SIGNIFICANCE:
                    failed += 1
                    part = "the image" if i == COLUMNS * ROWS else f"block {i % COLUMNS}, {i // COLUMNS}"
                    print(f"{scene}, {part}: {means['tiny'][i]:.5g} by tiny, {means['tiny_odis'][i]:.5g} by tiny_odis, "
                          f"z = {value:.2f}")
            error = math.sqrt(variances["tiny_odis"][-1] + variances["tiny"][-1]) / means["tiny"][-1]
            print(f"{scene}: the image's means differ by {means['tiny_odis'][-1] / means['tiny'][-1] - 1:+.2%} "
                  f"± {error:.2%}; greatest |z| {abs(z).max():.2f}")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
