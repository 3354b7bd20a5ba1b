"""Writes golden.txt: values and densities of the models in models.json as Mitsuba 3 computes them.

Usage: python golden.py [pairs of directions a model] > golden.txt
A line: model, wo (Mitsuba's wi), wi, f cos (rgb), density, all in the shading frame. Models that Mitsuba 3 does not
know and those of which nothing can be evaluated are left out.
"""
import json
import os
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")


def dictionary(node):
    if isinstance(node, dict):
        return {key: dictionary(value) for key, value in node.items()}
    return {"type": "rgb", "value": node} if isinstance(node, list) else node


def directions(rng, transmissive):
    # Uniform on the hemisphere, or on the sphere, away from grazing angles; half of the pairs are near reflection.
    def uniform():
        z, phi = rng.uniform(0.1, 0.98), rng.uniform(0, 2 * np.pi)
        w = np.array([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z])
        return w * [1, 1, -1] if transmissive and rng.uniform() < 0.5 else w

    wo, wi = uniform(), uniform()
    if rng.uniform() < 0.5:
        wi = np.array([-wo[0], -wo[1], wo[2]]) + 0.3 * wi
        wi /= np.linalg.norm(wi)
    return np.round(wo, 5), np.round(wi, 5)


rng = np.random.default_rng(1)
count = int(sys.argv[1]) if len(sys.argv) > 1 else 6
print("# Mitsuba", mi.__version__, "scalar_rgb; written by golden.py")
with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "models.json")) as file:
    models = json.load(file)
mi.file_resolver().append(os.path.dirname(os.path.abspath(__file__)))
for name, node in models.items():
    try:
        bsdf = mi.load_dict(dictionary(node))
    except Exception as error:
        print(name, error, file=sys.stderr)
        continue
    if not mi.has_flag(bsdf.flags(), mi.BSDFFlags.Smooth):
        continue
    transmissive = "glass" in name or "dielectric" in name or "twosided" in name
    written = 0
    for _ in range(100 * count):
        wo, wi = directions(rng, transmissive)
        si = mi.SurfaceInteraction3f()
        si.sh_frame = mi.Frame3f([0, 0, 1])
        si.n = [0, 0, 1]
        si.dp_du, si.dp_dv = [1, 0, 0], [0, 1, 0]
        wo /= np.linalg.norm(wo)
        wi /= np.linalg.norm(wi)
        si.wi = wo
        value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, mi.Vector3f(*wi))
        if pdf == 0:
            continue
        print(name, *("%.8g" % x for x in [*wo, *wi, *value, pdf]))
        written += 1
        if written == count:
            break
