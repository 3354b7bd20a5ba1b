"""Meshes that emit and have vertex normals, for which `path` itself has two answers.

Mitsuba's `sample_direction` turns areas into solid angles by the shading normal (as `pdf_direction` does), though the
places that it draws are spread by the geometric one. What is sampled toward such a light is off by the ratio of the two
cosines, what paths meet by chance is not, and the image depends on how the two are weighed against each other
(https://github.com/mitsuba-renderer/mitsuba3/issues/1952). So that the image is that of `path`, they are weighed as
`path` weighs them, whatever the guide does: each of the two is unbiased by itself for what it is weighed with.
"""

import mitsuba as mi
import numpy as np

# 1 - cosine of the angle between normals that are taken for the same.
FLAT = 1e-4


def is_uneven(emitter):
    """Whether an emitter's shape is a mesh whose vertex normals differ from those of its faces."""
    shape = emitter.get_shape()
    if shape is None or not shape.is_mesh():
        return False
    parameters = dict(mi.traverse(shape))
    arrays = [np.array(parameters.get(name, [])) for name in ("faces", "vertex_positions", "vertex_normals")]
    if not all(array.size for array in arrays):
        return False
    faces, positions, normals = (array.reshape(-1, 3) for array in arrays)
    corners = positions[faces].astype(np.float64)
    of_face = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    of_corner = normals[faces].astype(np.float64)
    lengths = np.linalg.norm(of_face, axis=1)[:, None] * np.linalg.norm(of_corner, axis=2)
    cosine = np.abs((of_face[:, None] * of_corner).sum(2))
    return bool((cosine < (1 - FLAT) * lengths).any())
