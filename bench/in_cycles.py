#!/usr/bin/env python3
"""What a libopenpgl gains and costs in Cycles' own program: error and processor time beside unguided paths.

    bench/in_cycles.py CYCLES SCENE... --guide NAME=FOLDER... [--stub] [--denoise ODIS] [--mixture] [--spp 4,16]
                       [--seeds 4] [--reference-spp 4096 | --pairs] [--cache DIR]

CYCLES is a program that links libopenpgl as a shared library, SCENE a folder that
integrations/openpgl/convert_scene.py wrote, FOLDER one that holds a libopenpgl.so.0. `--stub` adds a library that knows
nothing, openpgl_stub.cpp: what Cycles' calls cost, and what its mixture does to its numbers. `--denoise` gives the
program `odis`, and images are compared after Open Image Denoise as well, by their colours alone. With `--mixture`
Cycles 4 and later mix guide and BSDF as 3.4 does, in place of resampled importance sampling (RIS), their default.

Errors are 0.1 %-trimmed relMSE as src/eval/metrics.h has it, to an unguided image of another seed; times are of all
threads, without what an image of 8 x 8 pixels takes (loading). Medians over seeds; ratios are to unguided paths. With
`--pairs` no reference is rendered: errors are half of the squared differences of two seeds, means over pairs. *Mean* is
that of the images of all seeds over that of unguided ones, with its standard error by pairs of one seed. Needs
`pip install mitsuba` to read OpenEXR.
"""
import argparse
import itertools
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

import mitsuba as mi
import numpy as np
from relative_error import trimmed_relative_error

mi.set_variant("scalar_rgb")
REFERENCE_SEED = 1 << 20


def read(file):
    colors = dict(mi.Bitmap(str(file)).split())["<root>"]
    return np.array(colors.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32), np.float64)


def size_of(text):
    """Width and height, as text, of a scene that convert_scene.py wrote."""
    return re.search(r'<camera width="(\d+)" height="(\d+)"', text).groups()


class Program:
    def __init__(self, cycles, threads, any_library, mixture=False):
        """any_library: the folder of a libopenpgl, which the program does not start without."""
        self.cycles, self.threads, self.any_library, self.mixture = cycles, threads, any_library, mixture

    def render(self, scene, spp, seed, library=None, output=None, size=None):
        """Renders with the guide of a folder, None for unguided paths; returns processor seconds."""
        guiding = f'use_guiding="{"true" if library else "false"}" seed="{seed}"'
        if self.mixture:
            guiding += ' guiding_directional_sampling_type="MIS"'
        file = scene / f".scene-{os.getpid()}.xml"
        text = (scene / "scene.xml").read_text()
        file.write_text(re.sub(r'use_guiding="\w+" seed="\d+"', guiding, text))
        environment = {**os.environ, "LD_LIBRARY_PATH": str(library or self.any_library)}
        command = [self.cycles, "--background", "--quiet", "--samples", str(spp), "--threads", str(self.threads)]
        # The program has a size of its own unless it is told one.
        width, height = size or size_of(text)
        command += ["--width", str(width), "--height", str(height)]
        with tempfile.TemporaryDirectory() as folder:
            target = output or pathlib.Path(folder) / "image.exr"
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run([*command, "--output", str(target), str(file)], env=environment, capture_output=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        file.unlink()
        if done.returncode:
            raise RuntimeError(f"{scene}: {self.cycles} failed: {done.stderr.decode()[-500:]}")
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def build_stub(folder):
    here = pathlib.Path(__file__).resolve().parent
    subprocess.run([os.environ.get("CXX", "c++"), "-std=c++17", "-O2", "-shared", "-fPIC",
                    f"-I{here.parent}/integrations/openpgl/include", "-Wl,-soname,libopenpgl.so.0",
                    str(here / "openpgl_stub.cpp"), "-o", f"{folder}/libopenpgl.so.0"], check=True)
    return folder


def reference_of(program, scene, args):
    args.cache.mkdir(parents=True, exist_ok=True)
    file = args.cache / f"{scene.name}-{args.reference_spp}.exr"
    if not file.exists():
        part = file.with_name(f"part-{file.name}")
        program.render(scene, args.reference_spp, REFERENCE_SEED, output=part)
        part.rename(file)
    return read(file)


def denoised(image, odis):
    target = image.with_name(f"denoised-{image.name}")
    subprocess.run([odis, "denoise", str(image), "-o", str(target), "--quiet"], check=True)
    return read(target)


def error_of_pairs(images, around):
    """The error that differences of images tell, where `around` stands in for what they are relative to."""
    pairs = itertools.combinations(images, 2)
    return np.mean([trimmed_relative_error(around + (a - b) / np.sqrt(2), around) for a, b in pairs])


def median_of_neighbours(image):
    """Of 3 x 3 pixels: single bright samples leave no trace."""
    padded = np.pad(image, ((1, 1), (1, 1), (0, 0)), "edge")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, (3, 3), axis=(0, 1)), axis=(-2, -1))


def means_of(images):
    """For each guide the mean of its images over that of unguided ones, and the standard error by pairs of a seed."""
    means = {name: np.mean(of_guide, axis=(1, 2, 3)) for name, of_guide in images.items()}
    off = means["off"]
    spread = lambda x: x.std(ddof=1) / np.sqrt(len(x)) if len(x) > 1 else np.nan
    return {name: (m.mean() / off.mean(), spread(m - off) / off.mean()) for name, m in means.items()}


def measure_pairs(program, scene, guides, spp, args):
    """For each guide, unguided first: error and seconds; and means_of()."""
    loading = np.median([program.render(scene, 1, 0, size=(8, 8)) for _ in range(3)])
    images, seconds = {name: [] for name in guides}, {name: [] for name in guides}
    with tempfile.TemporaryDirectory() as folder:
        image = pathlib.Path(folder) / "image.exr"
        for seed in range(args.seeds):
            for name, library in guides.items():
                seconds[name].append(max(program.render(scene, spp, seed, library, image) - loading, 1e-3))
                images[name].append(read(image))
    around = median_of_neighbours(np.mean([np.mean(of_guide, axis=0) for of_guide in images.values()], axis=0))
    found = {name: np.array([error_of_pairs(images[name], around), np.median(seconds[name])]) for name in guides}
    return found, means_of(images)


def measure(program, scene, guides, spp, args):
    """For each guide, unguided first: error, seconds, and the error after denoising, if any; and means_of()."""
    reference = reference_of(program, scene, args)
    loading = np.median([program.render(scene, 1, 0, size=(8, 8)) for _ in range(3)])
    found, images = {name: [] for name in guides}, {name: [] for name in guides}
    for seed in range(args.seeds):
        for name, library in guides.items():
            with tempfile.TemporaryDirectory() as folder:
                image = pathlib.Path(folder) / "image.exr"
                seconds = program.render(scene, spp, seed, library, image) - loading
                images[name].append(read(image))
                row = [trimmed_relative_error(images[name][-1], reference), max(seconds, 1e-3)]
                if args.denoise:
                    row.append(trimmed_relative_error(denoised(image, args.denoise), reference))
                found[name].append(row)
    return {name: np.median(rows, axis=0) for name, rows in found.items()}, means_of(images)


def print_row(cells):
    print(f"| {' | '.join(cells)} |", flush=True)


def compare(program, guides, args):
    ratios = {}
    columns = ["error", "seconds", *(["denoised"] if args.denoise else [])]
    print_row(["scene", "samples", "guide", *columns, *(f"{c} ratio" for c in columns), "error × time",
               "mean"])
    print_row(["---", "--:", "---", *["--:"] * (2 * len(columns) + 2)])
    for scene in args.scenes:
        for spp in map(int, args.spp.split(",")):
            found, means = (measure_pairs if args.pairs else measure)(program, scene, guides, spp, args)
            for name, values in found.items():
                ratio = values / found["off"]
                ratios.setdefault((spp, name), []).append(ratio)
                print_row([scene.name, str(spp), name, *(f"{v:.4g}" for v in values), *(f"{r:.2f}" for r in ratio),
                           f"{ratio[0] * ratio[1]:.2f}", "{:.4f} ± {:.4f}".format(*means[name])])
    for (spp, name), values in ratios.items():
        mean = np.exp(np.log(values).mean(axis=0))
        print_row([f"mean of {len(values)}", str(spp), name, *[""] * len(columns), *(f"{r:.2f}" for r in mean),
                   f"{mean[0] * mean[1]:.2f}", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cycles", metavar="CYCLES")
    parser.add_argument("scenes", nargs="+", type=pathlib.Path, metavar="SCENE")
    parser.add_argument("--guide", action="append", required=True, metavar="NAME=FOLDER")
    parser.add_argument("--stub", action="store_true")
    parser.add_argument("--denoise", metavar="ODIS")
    parser.add_argument("--mixture", action="store_true")
    parser.add_argument("--spp", default="4,16", help="samples per pixel, with commas (4,16)")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--reference-spp", type=int, default=4096)
    parser.add_argument("--pairs", action="store_true", help="errors by two seeds or more, without a reference")
    parser.add_argument("--cache", type=pathlib.Path, default=pathlib.Path("cycles-references"),
                        help="keeps references there")
    args = parser.parse_args()
    if args.pairs and (args.seeds < 2 or args.denoise):
        parser.error("--pairs is for two seeds or more, without --denoise")
    guides = dict(guide.split("=", 1) for guide in args.guide)
    program = Program(args.cycles, args.threads, next(iter(guides.values())), args.mixture)
    with tempfile.TemporaryDirectory() as folder:
        if args.stub:
            guides["stub"] = build_stub(folder)
        compare(program, {"off": None, **guides}, args)
    return 0


if __name__ == "__main__":
    sys.exit(main())
