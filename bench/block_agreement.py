"""Whether two renderers, or two ways to render, agree: z-tests of the means of blocks of 8 x 8 pixels.

Each seed is one image of either, with independent random numbers. The means of a block over seeds are compared by
Welch's t, turned into the z of a normal distribution (Wallace 1959); the limit is Sidak's for all blocks at a
significance of 1 %. Where light is rare, means of a few seeds are far from normal and |z| exceeds this limit by chance.
So a scene fails only if its largest |z| also exceeds what 99 % of 2000 random exchanges of the two kinds of images
reach; `heavy tails` marks scenes that exceed the first limit alone.
"""
import statistics

import numpy as np
from relative_error import LUMINANCE

BLOCK = 8
EXCHANGES = 2000
SIGNIFICANCE = 0.01


def pixels_of_blocks(image):
    """The image, [row][column], as [row of blocks][column][pixel], without what is left over at the right and at the
    bottom."""
    height, width = (size // BLOCK for size in image.shape)
    cut = image[:height * BLOCK, :width * BLOCK].reshape(height, BLOCK, width, BLOCK)
    return cut.transpose(0, 2, 1, 3).reshape(height, width, BLOCK * BLOCK)


def blocks(image):
    """The luminance of blocks of pixels."""
    return pixels_of_blocks(np.asarray(image, np.float64)[..., :3] @ LUMINANCE).mean(axis=2).ravel()


def z_scores(a, b):
    """Of the difference between the means of a and b over seeds, [seed][block]."""
    parts = [x.var(0, ddof=1) / len(x) for x in (a, b)]
    error = np.sqrt(sum(parts))
    t = np.divide(a.mean(0) - b.mean(0), error, out=np.zeros_like(error), where=error > 0)
    freedom = error ** 4 / np.maximum(sum(p ** 2 / (len(x) - 1) for p, x in zip(parts, (a, b))), 1e-300)
    freedom = np.maximum(freedom, 1)
    return np.sign(t) * (8 * freedom + 1) / (8 * freedom + 3) * np.sqrt(freedom * np.log1p(t * t / freedom))


def limits(a, b):
    """Of the largest |z|: Sidak's, and that of exchanged images."""
    each = 1 - (1 - SIGNIFICANCE) ** (1 / a.shape[1])
    sidak = statistics.NormalDist().inv_cdf(1 - each / 2)
    random, both = np.random.default_rng(1), np.concatenate([a, b])
    largest = []
    for _ in range(EXCHANGES):
        order = random.permutation(len(both))
        largest.append(np.abs(z_scores(both[order[:len(a)]], both[order[len(a):]])).max())
    return sidak, np.quantile(largest, 1 - SIGNIFICANCE)


def print_head():
    print("| scene | largest \\|z\\| | limit | exchanged | beyond | mean | median block's error | |")
    print("|---|--:|--:|--:|--:|--:|--:|---|", flush=True)


def report(name, a, b):
    """Prints the largest |z|, both limits, the share of blocks beyond the first, the ratio of the means of the images
    with its 95 % interval, and the standard error of the median block; a and b as blocks() has them, [seed][block]."""
    z, (sidak, exchanged) = np.abs(z_scores(a, b)), limits(a, b)
    means = [x.mean(1) for x in (a, b)]
    ratio = means[0].mean() / means[1].mean()
    spread = 1.96 * np.sqrt(sum(m.var(ddof=1) / len(m) / m.mean() ** 2 for m in means))
    lit = b.mean(0) > 0
    error = np.median(np.sqrt(sum(x.var(0, ddof=1) / len(x) for x in (a, b)))[lit] / b.mean(0)[lit])
    verdict = "" if z.max() <= sidak else "heavy tails" if z.max() <= exchanged else "FAILS"
    print(f"| {name} | {z.max():.2f} | {sidak:.2f} | {exchanged:.2f} | {(z > sidak).mean():.3f} | "
          f"{100 * (ratio - 1):+.2f} ± {100 * spread:.2f} % | {100 * error:.2f} % | {verdict} |", flush=True)
