#!/usr/bin/env python3
"""Samples a second in scenes with participating media: `odis render --integrator path` beside Mitsuba's `volpath`.

    bench/media_speed.py ODIS SCENE.xml... [--resolution 192] [--spp 32] [--rounds 3] [-D name=value]...

Both renderers take turns, with the film's filter a box and as many samples. Times are of the process on all cores, without
loading the scene and compiling kernels: medians over rounds. Ratios above 1 say that `odis` takes more samples a second
than Mitsuba. Needs the packages mitsuba and numpy; scalar_rgb takes an eighth of the samples.
"""
import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

VARIANTS = {"llvm_ad_rgb": 1, "scalar_rgb": 8}  # and by what their numbers of samples are divided


def square_scene(path, resolution):
    """Writes the scene beside itself, with a square film and `volpath`; returns the file."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for name in ("width", "height"):
        text = re.sub(rf'(<integer name="{name}" value=")\d+', rf"\g<1>{resolution}", text)
    text = re.sub(r'<integrator type="\w+"', '<integrator type="volpath"', text)
    target = os.path.join(os.path.dirname(os.path.abspath(path)), f".media-speed-{os.getpid()}.xml")
    with open(target, "w", encoding="utf-8") as file:
        file.write(text)
    return target


def seconds_of_mitsuba(scene, spp, seed):
    begin = time.process_time()
    np.array(mi.render(scene, spp=spp, seed=seed))
    return (time.process_time() - begin) / spp


def seconds_of_odis(odis, file, spp, defines):
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        words = [word for define in defines for word in ("-D", define)]
        subprocess.run([odis, "render", file, "-q", "--integrator", "path", "--spp", str(spp), "--stats-json", stats,
                        "-o", os.path.join(folder, "image.exr"), *words], check=True, capture_output=True)
        with open(stats, encoding="utf-8") as text:
            return json.load(text)["processorSeconds"] / spp


def measure(path, args):
    """Ratios of samples a second, `odis` over each variant."""
    file = square_scene(path, args.resolution)
    try:
        defines = dict(define.split("=", 1) for define in args.define)
        scenes = {}
        for variant, divisor in VARIANTS.items():
            mi.set_variant(variant)
            scenes[variant] = mi.load_file(file, **defines)
            seconds_of_mitsuba(scenes[variant], max(args.spp // divisor, 1), 0)  # compiles
        seconds = {name: [] for name in ("odis", *VARIANTS)}
        for round_ in range(args.rounds):
            seconds["odis"].append(seconds_of_odis(args.odis, file, args.spp, args.define))
            for variant, divisor in VARIANTS.items():
                mi.set_variant(variant)
                spp = max(args.spp // divisor, 1)
                seconds[variant].append(seconds_of_mitsuba(scenes[variant], spp, 1 + round_))
        medians = {name: statistics.median(times) for name, times in seconds.items()}
        return {variant: medians[variant] / medians["odis"] for variant in VARIANTS}
    finally:
        os.remove(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("odis", help="the program")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--resolution", type=int, default=192, help="width and height in pixels (%(default)s)")
    parser.add_argument("--spp", type=int, default=32, help="samples per pixel (%(default)s)")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("-D", dest="define", action="append", default=[], metavar="NAME=VALUE")
    args = parser.parse_args()
    all_ratios = []
    print("| scene | " + " | ".join(VARIANTS) + " |\n|:--|" + "--:|" * len(VARIANTS))
    for path in args.scenes:
        ratios = measure(path, args)
        all_ratios.append(list(ratios.values()))
        name = os.path.splitext(os.path.basename(path))[0]
        print(f"| {name} | " + " | ".join(f"{ratio:.2f}" for ratio in ratios.values()) + " |", flush=True)
    means = np.exp(np.log(np.array(all_ratios)).mean(axis=0))
    print("| geometric mean | " + " | ".join(f"{mean:.2f}" for mean in means) + " |")


if __name__ == "__main__":
    sys.exit(main())
