#!/usr/bin/env python3
"""Speed of `odis render --integrator path` as a ratio to Mitsuba 3's `path`, both measured in this run.

    bench/beside_mitsuba.py ODIS SCENE.xml... [--variant llvm_ad_rgb] [--pixels 57600] [--spp 64] [--rounds 3]

Needs `pip install ".[mitsuba]"` (and a libLLVM for the llvm variants). Both trace paths of at most 13 vertices with
Russian roulette from the fifth, independent samples and a box filter or the scene's own; they take turns, and time is
the processes' time on all cores, which a busy machine disturbs least. Mitsuba's compilation is left out. Scenes that
odis.mitsuba.scene_files does not load get `-`.
"""
import argparse
import json
import os
import subprocess
import sys
import time

import mitsuba as mi
import numpy as np
from odis.mitsuba.scene_files import load_file


def mitsuba_rate(scene, spp, seed):
    """Samples a second of processor time."""
    integrator = mi.load_dict({"type": "path", "max_depth": 13, "rr_depth": 5})
    start = sum(os.times()[:2])
    image = np.array(mi.render(scene, integrator=integrator, spp=spp, seed=seed))
    return image.shape[0] * image.shape[1] * spp / (sum(os.times()[:2]) - start)


def measure_odis(odis, scene, pixels, spp):
    """What `odis bench` measures of one scene in one round."""
    command = [odis, "bench", scene, "--json", "--quiet", "--rounds", "1", "--pixels", str(pixels), "--spp", str(spp)]
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("odis")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--pixels", type=int, default=57600)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    mi.set_variant(args.variant)
    mi.set_log_level(mi.LogLevel.Error)

    print(f"| scene | odis, M samples / CPU s | {args.variant} | ratio | load, s: odis, Mitsuba |\n|---|---|---|---|---|")
    ratios = []
    for path in args.scenes:
        name = os.path.basename(os.path.dirname(os.path.abspath(path)))
        ours, theirs, loaded, seconds = [], [], None, float("nan")
        try:
            start = time.time()
            loaded = load_file(path, pixels=args.pixels)
            seconds = time.time() - start
            mitsuba_rate(loaded, args.spp, 0)  # compiles
        except (RuntimeError, ValueError) as error:
            print(f"{name}: {str(error).strip().splitlines()[-1]}", file=sys.stderr)
            loaded = None
        for seed in range(args.rounds):
            measured = measure_odis(args.odis, path, args.pixels, args.spp)
            ours.append(measured["samplesPerCpuSecond"])
            if loaded is not None:
                theirs.append(mitsuba_rate(loaded, args.spp, seed + 1))
        rate = f"{np.median(theirs) / 1e6:.3f}" if theirs else "-"
        ratio = np.median(ours) / np.median(theirs) if theirs else float("nan")
        if theirs:
            ratios.append(ratio)
        print(f"| {name} | {np.median(ours) / 1e6:.3f} | {rate} | {ratio:.2f} | "
              f"{measured['secondsLoad']:.2f}, {seconds:.2f} |", flush=True)
    if ratios:
        print(f"| geometric mean of {len(ratios)} | | | {np.exp(np.mean(np.log(ratios))):.2f} | |")


if __name__ == "__main__":
    main()
