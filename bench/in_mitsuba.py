#!/usr/bin/env python3
"""What `odis` gains and costs in Mitsuba 3: error and time beside Mitsuba's `path`, as the table of docs/mitsuba.md.

    bench/in_mitsuba.py SCENE.xml... [--variant llvm_ad_rgb] [--pixels 230400] [--spp 4,16] [--seeds 4] [--cache DIR]
    bench/in_mitsuba.py SCENE.xml... --methods "odis=,cached=--cached,paper=--preset paper-fast --set map-cosine=on"
    bench/in_mitsuba.py SCENE.xml... --rfilter file --methods "splat=,pixels=--film pixels"
    bench/in_mitsuba.py bench/media/*.xml --pixels 14400 --references DIR --methods "odis=,cached=--cached"

Needs `pip install ".[mitsuba]"`. All methods run in one process and take turns, with max_depth 13, rr_depth 5,
independent samples and the filter that the scene's file names, or another (--rfilter). Scenes with media are compared
with `volpath` in place of `path`, with the max_depth and rr_depth of their files. Times are wall clock, without
Dr.Jit's code generation and compilation, and processor time: each kind renders once to warm up, and an image for which
kernels were compiled is rendered again. Errors are 0.1 %-trimmed relMSE as src/eval/metrics.h has it, to
references of `path` with other seeds and the same filter, or to images of a folder (--references). Times are the least
over seeds, as other work on the machine only adds to them, errors and rays are medians; ratios are to `path`, and error
× time is that of the processor. The mean is that of all seeds' images, over the reference's, with its standard error
without the reference's own. Scenes that do not load get `-`, and the reason on stderr.
"""
import argparse
import hashlib
import os
import resource
import shlex
import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np
from odis.mitsuba.from_scene import is_volumetric, path_tracer_of, settings_of
from odis.mitsuba.kernel_history import compile_seconds
from odis.mitsuba.scene_files import load_file
from relative_error import trimmed_relative_error

SETTINGS = {"max_depth": 13, "rr_depth": 5}
REFERENCE_SEED, REFERENCE_PART = 1 << 20, 32
COLUMNS = ("scene", "samples", "method", "time, s", "time ratio", "processor time ratio", "error ratio",
           "rays a sample", "error × time", "mean")


def processor_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def render(scene, integrator, spp, seed):
    """The image, and seconds of wall clock and of processor time. Where kernels were compiled, which takes time of
    another kind, the same is rendered again: they are there then."""
    for _ in range(4):
        compile_seconds()
        begin, begin_processor = time.perf_counter(), processor_seconds()
        image = np.array(mi.render(scene, integrator=integrator, spp=spp, seed=seed))[..., :3].astype(np.float64)
        seconds, processor = time.perf_counter() - begin, processor_seconds() - begin_processor
        compiling = compile_seconds()
        if compiling < 0.02 * seconds:
            break
    return image, seconds - compiling, processor


def path_tracer_beside(scene):
    """The integrator of Mitsuba that `odis` is compared with, and the settings of both."""
    if is_volumetric(scene):
        return "volpath", settings_of(path_tracer_of(scene)[0])
    return "path", SETTINGS


def image_of_file(path, size):
    """The colours of an EXR file, averaged down to a width and height."""
    bitmap = mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
    image = np.array(bitmap, np.float64)
    width, height = size
    if image.shape[0] % height or image.shape[1] % width:
        raise ValueError(f"{path}: expected a multiple of {width}x{height}, found {image.shape[1]}x{image.shape[0]}")
    return image.reshape(height, image.shape[0] // height, width, image.shape[1] // width, 3).mean(axis=(1, 3))


def reference_of(scene, path, args):
    """An image by `path`, or `volpath`, with many samples, kept in a file between runs; or that of a folder."""
    if args.references:
        file = os.path.join(args.references, f"{name_of(path)}.exr")
        return image_of_file(file, scene.sensors()[0].film().crop_size())
    if args.reference_spp % REFERENCE_PART:
        raise SystemExit(f"--reference-spp: expected a multiple of {REFERENCE_PART}")
    size = list(scene.sensors()[0].film().crop_size())
    rfilter = "" if args.rfilter == "box" else f" {scene.sensors()[0].film().rfilter()}"
    kind, settings = path_tracer_beside(scene)
    key = (f"{os.path.abspath(path)} {os.stat(path).st_mtime} {size} {args.variant} {args.reference_spp} "
           f"{settings}{rfilter}")
    file = os.path.join(args.cache, f"{name_of(path)}-{hashlib.sha256(key.encode()).hexdigest()[:16]}.npz")
    if os.path.exists(file):
        return np.load(file)["image"]
    integrator, begin = mi.load_dict({"type": kind, **settings}), time.perf_counter()
    parts = args.reference_spp // REFERENCE_PART
    image = sum(np.array(mi.render(scene, integrator=integrator, spp=REFERENCE_PART, seed=REFERENCE_SEED + part),
                         np.float64)[..., :3] for part in range(parts)) / parts
    print(f"{name_of(path)}: reference of {args.reference_spp} samples in {time.perf_counter() - begin:.0f} s",
          file=sys.stderr)
    os.makedirs(args.cache, exist_ok=True)
    np.savez_compressed(f"{file}.part.npz", image=image.astype(np.float32))
    os.replace(f"{file}.part.npz", file)
    return image


def name_of(path):
    stem = os.path.splitext(os.path.basename(path))[0]
    return os.path.basename(os.path.dirname(os.path.abspath(path))) if stem.startswith("scene") else stem


def parse_methods(text):
    """Names and parameters of `odis`, from NAME=OPTIONS with commas between; options as of `odis-mitsuba render`."""
    options = argparse.ArgumentParser(prog="--methods", usage=argparse.SUPPRESS, add_help=False)
    options.add_argument("--preset", default="default")
    options.add_argument("--set", action="append", default=[], dest="settings")
    options.add_argument("--cached", action="store_true")
    options.add_argument("--film", default="splat")
    methods = {}
    for method in text.split(","):
        name, equals, words = method.partition("=")
        if not (name and equals):
            raise argparse.ArgumentTypeError(f"expected NAME=OPTIONS, found {method}")
        given = options.parse_args(shlex.split(words))
        methods[name] = {"preset": given.preset, "settings": " ".join(given.settings), "cached": given.cached,
                         "film": given.film}
    return methods


def measure(scene, reference, spp, seeds, methods):
    """For each method a row: seconds, ratios to `path` of time, processor time and error, rays a sample; then the mean of
    the images over the reference's, with its standard error."""
    kind, settings = path_tracer_beside(scene)
    integrators = {"path": mi.load_dict({"type": kind, **settings})}
    integrators |= {name: mi.load_dict({"type": "odis", **parameters, **settings})
                    for name, parameters in methods.items()}
    for integrator in integrators.values():
        render(scene, integrator, spp, REFERENCE_SEED - 1)
    measured = {name: [] for name in integrators}
    for seed in range(seeds):
        for name, integrator in integrators.items():
            image, seconds, processor = render(scene, integrator, spp, seed)
            rays = getattr(integrator, "rays", float("nan")) / (image.shape[0] * image.shape[1] * spp)
            measured[name].append((seconds, processor, trimmed_relative_error(image, reference), rays,
                                   image.mean() / reference.mean()))
    found = {name: np.append(np.min(np.array(rows)[:, :2], axis=0), np.median(np.array(rows)[:, 2:], axis=0))
             for name, rows in measured.items()}
    result = {}
    for name, values in found.items():
        means = np.array(measured[name])[:, -1]
        error = means.std(ddof=1) / np.sqrt(seeds) if seeds > 1 else float("nan")
        result[name] = (values[0], *(values[:3] / found["path"][:3]), values[3], means.mean(), error)
    return result


def print_row(scene, spp, method, values):
    seconds, time_ratio, processor_ratio, error_ratio, rays, mean, standard_error = values
    rays = "" if np.isnan(rays) else f"{rays:.2f}"  # `path` does not count them
    print(f"| {scene} | {spp} | {method} | {seconds:.2f} | {time_ratio:.2f} | {processor_ratio:.2f} | "
          f"{error_ratio:.2f} | {rays} | {processor_ratio * error_ratio:.2f} | {mean:.3f} ± {standard_error:.3f} |",
          flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", metavar="SCENE.xml")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--pixels", type=int, default=230400)
    parser.add_argument("--spp", default="4,16", help="samples per pixel, with commas (4,16)")
    parser.add_argument("--methods", type=parse_methods, default="odis=", metavar="NAME=OPTIONS,...",
                        help="what to compare with path: names and the options --preset, --set, --cached and "
                        "--film of odis-mitsuba render (odis=)")
    parser.add_argument("--rfilter", default="file", help="reconstruction filter of all images, such as box; file: the "
                        "one that each file names (file)")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--reference-spp", type=int, default=256)
    parser.add_argument("--references", metavar="DIR", help="takes DIR/SCENE.exr for references, such as larger images by "
                        "odis render --integrator path")
    parser.add_argument("--cache", default="out/mitsuba-references", metavar="DIR", help="keeps references there")
    args = parser.parse_args()
    mi.set_variant(args.variant)
    mi.set_log_level(mi.LogLevel.Error)

    print(f"| {' | '.join(COLUMNS)} |\n|---|{'--:|' * (len(COLUMNS) - 1)}")
    counts = [int(count) for count in args.spp.split(",")]
    ratios = {}
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        for path in args.scenes:
            try:
                rfilter = None if args.rfilter == "file" else args.rfilter
                scene = load_file(path, pixels=args.pixels, rfilter=rfilter, sampler="independent", warn=lambda _: None)
                reference = reference_of(scene, path, args)
            except (OSError, RuntimeError, ValueError) as error:
                print(f"{name_of(path)}: {error}", file=sys.stderr)
                print(f"| {name_of(path)} {'| - ' * (len(COLUMNS) - 1)}|", flush=True)
                continue
            for spp in counts:
                for method, values in measure(scene, reference, spp, args.seeds, args.methods).items():
                    print_row(name_of(path), spp, method, values)
                    ratios.setdefault((spp, method), []).append(values[1:4])
    for (spp, method), values in ratios.items():
        time_ratio, processor_ratio, error_ratio = np.exp(np.log(values).mean(axis=0))
        print(f"| geometric mean of {len(values)} | {spp} | {method} | | {time_ratio:.2f} | {processor_ratio:.2f} | "
              f"{error_ratio:.2f} | | {processor_ratio * error_ratio:.2f} | |")


if __name__ == "__main__":
    main()
