"""The error of images, for the comparisons of this folder."""

import numpy as np

# Of the linear primaries of sRGB.
LUMINANCE = np.array([0.212671, 0.715160, 0.072169])


def trimmed_relative_error(image, reference):
    """0.1 %-trimmed relMSE, as src/eval/metrics.h defines it."""
    luminance = (reference @ LUMINANCE).mean()
    scale = 1 / luminance if luminance > 0 else 1.0
    errors = ((scale * (image - reference)) ** 2 / ((scale * reference) ** 2 + 0.01)).mean(axis=2).ravel()
    errors[~np.isfinite(errors)] = np.inf
    kept = errors.size - int(0.001 * errors.size)
    return np.partition(errors, kept - 1)[:kept].mean()
