#!/usr/bin/env python3
"""`odis render` beside Mitsuba 3's `path` at the same number of samples, on scene files as they are.

    bench/beside_mitsuba.py ODIS SCENE.xml... [--pixels 57600] [--spp 4,16] [--seeds 2] [--json FILE]
    bench/beside_mitsuba.py ODIS SCENE.xml... --speed [SPP] [--pixels 57600] [--rounds 3]

Needs `pip install ".[mitsuba]"` (and a libLLVM for the llvm variants). Both renderers use the reconstruction filter
of the file, trace paths of at most 13 vertices with Russian roulette from the fifth, and take turns. Every figure of
the tables is a ratio to Mitsuba's `path` with independent samples, of means over seeds; below 1 is better.

time        processor time of the process on all cores: pilot, guide, tracing and film; without loading the scene,
            building its trees, compiling kernels and writing the image
error       relMSE without the worst 0.1 % of the pixels; untrimmed: of all pixels
FLIP        as docs/comparing.md has it
blurred     error after image and reference were both blurred by a gaussian with a standard deviation of two pixels:
            what is left of the noise for an eye that stands back
Sobol'      the same with `--sampler sobol` on our side; all other columns are with independent samples
reference   the reference's own error, which is in every error and draws ratios towards 1 where it is large

Errors are those of `odis metrics`, to references by Mitsuba's `path` with the same filter and other seeds. They are
made where DIR (--references) has none that fits. Scenes that odis.mitsuba.scene_files does not load get `-`, and the
reason on stderr. Untrimmed errors, and blurred ones where single samples are very bright, need many seeds.

--speed compares samples a second of `path` alone, as medians over rounds, and needs no references.
"""
import argparse
import json
import os
import shlex
import subprocess
import sys
import tempfile
import time

import drjit as dr
import mitsuba as mi
import numpy as np
from in_mitsuba import SETTINGS, name_of
from in_mitsuba import render as render_timed
from mitsuba_references import how_made, reference_of
from odis.mitsuba.scene_files import load_file

METHODS = {"path": ["--integrator", "path"], "odis": [], "cached": ["--cached"]}
SAMPLERS = ("independent", "sobol")
BLUR = 2  # pixels, the standard deviation
# Columns of the tables: which ratio, with which sampler on our side.
COLUMNS = {"time": ("time", "independent"), "error": ("error", "independent"),
           "error × time": ("error × time", "independent"), "untrimmed": ("untrimmed", "independent"),
           "FLIP": ("FLIP", "independent"), "blurred": ("blurred", "independent"),
           "Sobol': error": ("error", "sobol"), "Sobol': error × time": ("error × time", "sobol"),
           "Sobol': FLIP": ("FLIP", "sobol"), "Sobol': blurred": ("blurred", "sobol"),
           "reference": ("reference", "")}


class Reference:
    """An EXR file, and the same blurred."""

    def __init__(self, file, folder):
        self.file, self.blurred = file, os.path.join(folder, "reference-blurred.exr")
        self.width, self.height = mi.Bitmap(file).size()
        write_blurred(file, self.blurred)


def write_blurred(source, target):
    image = np.array(mi.Bitmap(source).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32), np.float64)
    mi.Bitmap(blur(image).astype(np.float32)).write(target)


def blur(image):
    """Convolves with a gaussian that is cut off and normalized at the image's borders."""
    def weights(count):
        distance = np.subtract.outer(np.arange(count), np.arange(count)) / BLUR
        kernel = np.exp(-distance ** 2 / 2)
        return kernel / kernel.sum(axis=1, keepdims=True)
    rows, columns = (weights(count) for count in image.shape[:2])
    return np.einsum("yj,jic,xi->yxc", rows, image, columns, optimize=True)


def run_odis(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, words[:2]))}: {done.stderr.strip()}")
    return done.stdout


def errors_of(odis, file, reference):
    """Errors of an EXR file; `mean` is its luminance over the reference's."""
    metrics = json.loads(run_odis(odis, "metrics", "--json", file, reference.file))
    write_blurred(file, f"{file}.blurred.exr")
    blurred = json.loads(run_odis(odis, "metrics", "--json", f"{file}.blurred.exr", reference.blurred))
    return {"error": metrics["trimmedRelMse"], "untrimmed": metrics["relMse"], "FLIP": metrics["flip"],
            "blurred": blurred["trimmedRelMse"], "blurred untrimmed": blurred["relMse"], "mean": metrics["mean"]}


def measure_mitsuba(scene, spp, seed, reference, args):
    """Processor time and errors of an image by Mitsuba's `path`."""
    image, _, seconds = render_timed(scene, mi.load_dict({"type": "path", **SETTINGS}), spp, seed)
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "mitsuba.exr")
        mi.Bitmap(image.astype(np.float32)).write(file)
        return {"time": seconds, **errors_of(args.odis, file, reference)}


def measure_odis_image(path, options, spp, seed, reference, args):
    """Processor time and errors of an image by `odis render`."""
    with tempfile.TemporaryDirectory() as folder:
        file, stats = os.path.join(folder, "odis.exr"), os.path.join(folder, "stats.json")
        run_odis(args.odis, "render", path, "-q", *options, *args.options, "--spp", spp, "--seed", seed,
                 "--max-depth", SETTINGS["max_depth"], "--rr-depth", SETTINGS["rr_depth"],
                 "--resolution", f"{reference.width}x{reference.height}", "-o", file, "--stats-json", stats)
        with open(stats, encoding="utf-8") as text:
            seconds = json.load(text)["processorSeconds"]
        return {"time": seconds, **errors_of(args.odis, file, reference)}


def measure_scene(path, args):
    """For each number of samples and each method, `mitsuba` among them, a list with what was measured of each seed;
    and how the reference was made."""
    scene = load_file(path, pixels=args.pixels, sampler="independent")
    file = reference_of(scene, path, args)
    if args.only_references:
        return None
    methods = {f"{method} {sampler}": [*options, "--sampler", sampler]
               for method, options in METHODS.items() for sampler in SAMPLERS}
    measured = {str(spp): {name: [] for name in ("mitsuba", *methods)} for spp in args.spp}
    measured["reference"] = how_made(file)
    with tempfile.TemporaryDirectory() as folder:
        reference = Reference(file, folder)
        for spp in args.spp:
            for seed in range(args.seeds):
                measured[str(spp)]["mitsuba"].append(measure_mitsuba(scene, spp, seed, reference, args))
                for name, options in methods.items():
                    measured[str(spp)][name].append(measure_odis_image(path, options, spp, seed, reference, args))
    return measured


def ratios_of(measured, own_error, method):
    """A scene's row of a table: for each column the ratio to Mitsuba of the means over seeds; own_error is that of
    the reference."""
    def ratio(sampler, key):
        if key == "reference":
            return own_error / np.mean([seed["error"] for seed in measured["mitsuba"]])
        if key == "error × time":
            return ratio(sampler, "error") * ratio(sampler, "time")
        ours, theirs = (np.mean([seed[key] for seed in measured[name]]) for name in (f"{method} {sampler}", "mitsuba"))
        return ours / theirs
    return [ratio(sampler, key) for key, sampler in COLUMNS.values()]


def print_row(name, cells):
    print(f"| {name} | {' | '.join(cells)} |")


def rows_of(results, spp, method):
    """Scenes that were measured, with their rows."""
    return {name: ratios_of(measured[str(spp)], measured["reference"]["own error"], method)
            for name, measured in results.items() if measured}


def geometric_mean(rows):
    return [f"{mean:.3f}" for mean in np.exp(np.mean(np.log(list(rows.values())), axis=0))]


def worst_of(rows):
    """For each column the scene with the largest ratio."""
    names = list(rows)
    return [names[index] for index in np.argmax(list(rows.values()), axis=0)]


def print_table(results, spp, method):
    """Rows of the scenes, their geometric mean, and which scene is the worst in each column."""
    print(f"\n{spp} samples a pixel, `{method}` over Mitsuba's `path`:\n")
    print_row("scene", COLUMNS)
    print(f"|---|{'--:|' * len(COLUMNS)}")
    rows = rows_of(results, spp, method)
    for name in results:
        print_row(name, [f"{value:.2f}" for value in rows[name]] if name in rows else "-" * len(COLUMNS))
    print_row(f"geometric mean of {len(rows)}", geometric_mean(rows))
    print_row("worst", worst_of(rows))


def print_summary(results, args):
    """Geometric means over the scenes, and the worst scene in error times time."""
    print("\nGeometric means over the scenes:\n")
    print_row("samples, method", [*COLUMNS, "worst in error × time"])
    print(f"|---|{'--:|' * (len(COLUMNS) + 1)}")
    for spp in args.spp:
        for method in METHODS:
            rows = rows_of(results, spp, method)
            column = list(COLUMNS).index("error × time")
            worst = worst_of(rows)[column]
            print_row(f"{spp}, `{method}`", [*geometric_mean(rows), f"{worst} {rows[worst][column]:.2f}"])


def print_tables(results, args):
    if not any(results.values()):
        sys.exit("no scene was measured")
    for spp in args.spp:
        for method in METHODS:
            print_table(results, spp, method)
    print_summary(results, args)


def compare(args):
    results = {}
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        for path in args.scenes:
            begin, name = time.perf_counter(), name_of(path)
            try:
                results[name] = measure_scene(path, args)
            except (OSError, RuntimeError, ValueError) as error:
                print(f"{name}: {error}", file=sys.stderr)
                results[name] = None
            print(f"{name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr, flush=True)
            if args.json and not args.only_references:
                write_json(results, args)
    if not args.only_references:
        print_tables(results, args)


def write_json(results, args):
    """Writes what was measured, seed by seed."""
    settings = {"odis": run_odis(args.odis, "--version").strip(), "mitsuba": mi.__version__, "variant": args.variant,
                "pixels": args.pixels, "seeds": args.seeds, "options": args.options, **SETTINGS}
    with open(args.json, "w", encoding="utf-8") as file:
        json.dump({"settings": settings, "scenes": results}, file, indent=1)


def mitsuba_rate(scene, spp, seed):
    """Samples a second of processor time."""
    image, _, seconds = render_timed(scene, mi.load_dict({"type": "path", **SETTINGS}), spp, seed)
    return image.shape[0] * image.shape[1] * spp / seconds


def measure_odis(odis, scene, pixels, spp):
    """What `odis bench` measures of one scene in one round."""
    command = [odis, "bench", scene, "--json", "--quiet", "--rounds", "1", "--pixels", str(pixels), "--spp", str(spp)]
    return json.loads(subprocess.run(command, capture_output=True, check=True).stdout)[0]


def compare_speed(args):
    print(f"| scene | odis, M samples / CPU s | {args.variant} | ratio | load, s: odis, Mitsuba |\n|---|---|---|---|---|")
    ratios = []
    for path in args.scenes:
        ours, theirs, loaded, seconds = [], [], None, float("nan")
        try:
            start = time.time()
            loaded = load_file(path, pixels=args.pixels)
            seconds = time.time() - start
        except (RuntimeError, ValueError) as error:
            print(f"{name_of(path)}: {str(error).strip().splitlines()[-1]}", file=sys.stderr)
        for seed in range(args.rounds):
            measured = measure_odis(args.odis, path, args.pixels, args.speed)
            ours.append(measured["samplesPerCpuSecond"])
            if loaded is not None:
                theirs.append(mitsuba_rate(loaded, args.speed, seed + 1))
        rate = f"{np.median(theirs) / 1e6:.3f}" if theirs else "-"
        ratio = np.median(ours) / np.median(theirs) if theirs else float("nan")
        if theirs:
            ratios.append(ratio)
        print(f"| {name_of(path)} | {np.median(ours) / 1e6:.3f} | {rate} | {ratio:.2f} | "
              f"{measured['secondsLoad']:.2f}, {seconds:.2f} |", flush=True)
    if ratios:
        print(f"| geometric mean of {len(ratios)} | | | {np.exp(np.mean(np.log(ratios))):.2f} | |")


def parse_arguments():
    def counts(text):
        return [int(count) for count in text.split(",")]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("odis", metavar="ODIS", help="the program")
    parser.add_argument("scenes", nargs="+", metavar="SCENE.xml")
    parser.add_argument("--variant", default="llvm_ad_rgb", help="of Mitsuba (llvm_ad_rgb)")
    parser.add_argument("--pixels", type=int, default=57600, help="about so many, in the file's proportions (57600)")
    parser.add_argument("--spp", type=counts, default="4,16", help="samples a pixel, with commas (4,16)")
    parser.add_argument("--seeds", type=int, default=2, help="images of each kind (2)")
    parser.add_argument("--options", type=shlex.split, default="", metavar="WORDS",
                        help="further options for odis render, in one argument: --options=\"--film pixels\"")
    parser.add_argument("--references", default="out/mitsuba-references", metavar="DIR",
                        help="keeps DIR/SCENE.exr (out/mitsuba-references)")
    parser.add_argument("--reference-spp", type=int, default=1024, help="samples of a reference that is made (1024)")
    parser.add_argument("--only-references", action="store_true", help="make those that lack, and end")
    parser.add_argument("--json", metavar="FILE", help="writes what was measured, seed by seed")
    parser.add_argument("--speed", type=int, nargs="?", const=64, metavar="SPP",
                        help="only the speed of path, with so many samples (64)")
    parser.add_argument("--rounds", type=int, default=3, help="of --speed (3)")
    return parser.parse_args()


def main():
    args = parse_arguments()
    mi.set_variant(args.variant)
    mi.set_log_level(mi.LogLevel.Error)
    dr.set_thread_count(max(dr.thread_count(), 2))  # Mitsuba waits forever in writing an EXR file with one
    if args.speed is None:
        compare(args)
    else:
        with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
            compare_speed(args)


if __name__ == "__main__":
    main()
