#!/usr/bin/env python3
"""Errors of methods before and after Open Image Denoise: noise that neighbours share looks little and denoises badly.

    bench/denoised.py ODIS SCENE.xml... [--methods "path=--integrator path,odis=--integrator odis"] [--spp 4]
                      [--seeds 4] [--pixels 57600] [--reference-spp 1024] [-o out/denoised]

Needs `pip install pyoidn OpenEXR numpy`. Methods are as in `odis compare`, which renders; the denoiser is given each
method's image of seed 0, 1, ... with the albedo and the normals of plain path tracing with as many samples and the
same seed, the same for every method. Prints medians over seeds of the relMSE without the worst 0.1 % of the pixels and
of FLIP, before and after, and ratios to the first method; means over scenes are geometric.
"""
import argparse
import json
import math
import os
import statistics
import subprocess

import numpy as np
import OpenEXR
import pyoidn


def read(path):
    with OpenEXR.File(path) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}


def write(path, pixels):
    with OpenEXR.File({"type": OpenEXR.scanlineimage}, {"RGB": pixels.astype(np.float32)}) as file:
        file.write(path)


def denoise(image, features, path):
    normal = np.stack([features["N." + axis] for axis in "XYZ"], axis=-1)
    write(path, pyoidn.denoise(
        np.maximum(read(image)["RGB"], 0).astype(np.float32), features["albedo"].astype(np.float32),
        normal.astype(np.float32), hdr=True))


def errors(odis, image, reference):
    text = subprocess.run([odis, "metrics", "--json", image, reference], check=True, capture_output=True).stdout
    metrics = json.loads(text)
    return metrics["trimmedRelMse"], metrics["flip"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("odis")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--methods", default="path=--integrator path,odis=--integrator odis")
    parser.add_argument("--spp", type=int, default=4)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--pixels", type=int, default=57600)
    parser.add_argument("--reference-spp", type=int, default=1024)
    parser.add_argument("-o", "--output", default="out/denoised")
    a = parser.parse_args()
    methods = dict(method.split("=", 1) for method in a.methods.split(","))
    os.makedirs(a.output, exist_ok=True)

    table = {}  # of (scene, method): relMSE and FLIP before, then after
    for scene in a.scenes:
        name = os.path.basename(scene).removesuffix(".xml")
        name = os.path.basename(os.path.dirname(os.path.abspath(scene))) if name == "scene" else name
        # The comparison makes the reference and says where it lies; its images of other seeds are made here.
        subprocess.run([a.odis, "compare", scene, "--methods", "path=--integrator path", "--spp", str(a.spp),
                        "--seeds", "1", "--pixels", str(a.pixels), "--max-depth", "13", "--reference-spp",
                        str(a.reference_spp), "-o", a.output, "-q"], check=True, stdout=subprocess.DEVNULL)
        references = [f for f in os.listdir(a.output + "/references") if f.startswith(name + "-")]
        reference = a.output + "/references/" + max(
            references, key=lambda f: os.path.getmtime(a.output + "/references/" + f))
        height, width = read(reference)["RGB"].shape[:2]
        figures = {method: [] for method in methods}
        for seed in range(a.seeds):
            def render(options, path):
                subprocess.run([a.odis, "render", scene, "--resolution", f"{width}x{height}", "--max-depth", "13",
                                "--spp", str(a.spp), "--seed", str(seed), "-q", "-o", path, *options.split()], check=True)
            render("--integrator path --aov albedo,normal", a.output + "/features.exr")
            features = read(a.output + "/features.exr")
            for method, options in methods.items():
                noisy, clean = a.output + "/noisy.exr", a.output + f"/{name}-{method}-{seed}.exr"
                render(options, noisy)
                denoise(noisy, features, clean)
                figures[method].append(errors(a.odis, noisy, reference) + errors(a.odis, clean, reference))
        for method in methods:
            table[name, method] = [statistics.median(f[i] for f in figures[method]) for i in range(4)]

    first = next(iter(methods))
    print("| scene | method | relMSE | denoised | ratio | ratio, denoised | FLIP | denoised |")
    print("|:--|:--|--:|--:|--:|--:|--:|--:|")
    names = list(dict.fromkeys(name for name, _ in table))
    for name in names:
        for method in methods:
            e, base = table[name, method], table[name, first]
            print(f"| {name} | {method} | {e[0]:.3g} | {e[2]:.3g} | {e[0] / base[0]:.3f} | {e[2] / base[2]:.3f} "
                  f"| {e[1]:.3f} | {e[3]:.3f} |")
    for method in methods:
        mean = [math.exp(statistics.fmean(math.log(table[n, method][i] / table[n, first][i]) for n in names))
                for i in (0, 2)]
        print(f"| geometric mean | {method} |  |  | {mean[0]:.3f} | {mean[1]:.3f} |  |  |")


main()
