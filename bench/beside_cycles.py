#!/usr/bin/env python3
"""Speed of `odis render --integrator path` as a ratio to that of unguided paths in Cycles, both measured in this run.

    bench/beside_cycles.py ODIS CYCLES SCENE.xml... --openpgl FOLDER [--pixels 57600] [--spp 64] [--rounds 3]

CYCLES is its own program, as scripts/cycles builds it, FOLDER one that holds a libopenpgl.so.0, which the program does
not start without. Scenes are converted by integrations/openpgl/convert_scene.py: pictures are alike, not equal. Both
trace paths of at most 13 vertices, and take turns; time is that of the processes on all cores, of Cycles without what
an image of 8 x 8 pixels takes (loading). Needs `pip install ".[mitsuba]"`.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from beside_mitsuba import measure_odis
from in_cycles import Program, size_of

CONVERT = pathlib.Path(__file__).resolve().parent.parent / "integrations/openpgl/convert_scene.py"


def cycles_rate(program, folder, spp, seed):
    """Samples a second of processor time."""
    width, height = size_of((folder / "scene.xml").read_text())
    loading = program.render(folder, 1, seed, size=(8, 8))
    return int(width) * int(height) * spp / (program.render(folder, spp, seed) - loading)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("odis", metavar="ODIS")
    parser.add_argument("cycles", metavar="CYCLES")
    parser.add_argument("scenes", nargs="+", metavar="SCENE.xml")
    parser.add_argument("--openpgl", required=True, metavar="FOLDER")
    parser.add_argument("--pixels", type=int, default=57600)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=3)
    args = parser.parse_args()
    program = Program(args.cycles, os.cpu_count(), args.openpgl)

    print("| scene | odis, M samples / CPU s | Cycles | ratio |\n|---|--:|--:|--:|")
    ratios = []
    for scene in args.scenes:
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, str(CONVERT), scene, folder, "--pixels", str(args.pixels)],
                                  capture_output=True, text=True)
            if done.returncode:
                sys.exit(f"{scene}: {CONVERT.name} failed: {done.stderr[-500:]}")
            ours, theirs = [], []
            for seed in range(args.rounds):
                ours.append(measure_odis(args.odis, scene, args.pixels, args.spp)["samplesPerCpuSecond"])
                theirs.append(cycles_rate(program, pathlib.Path(folder), args.spp, seed))
        ratios.append(np.median(ours) / np.median(theirs))
        name = os.path.basename(os.path.dirname(os.path.abspath(scene)))
        print(f"| {name} | {np.median(ours) / 1e6:.3f} | {np.median(theirs) / 1e6:.3f} | {ratios[-1]:.2f} |", flush=True)
    print(f"| geometric mean of {len(ratios)} | | | {np.exp(np.mean(np.log(ratios))):.2f} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
